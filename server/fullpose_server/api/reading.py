"""How an upload is to be read, as the fields of its form say."""

from collections.abc import Mapping
from typing import Any

from fullpose_server.api.problems import ApiError
from fullpose_server.formats.profile import shipped
from fullpose_server.formats.saved_profiles import SavedProfiles
from fullpose_server.formats.trajectory import Convention

_FLAGS = {
    "strict": "Refuse a flight that there is a warning about",
    "bridge_gaps": "Fly through gaps by interpolation; they are refused otherwise",
    "drop_duplicates": "Of samples with one stamp, keep the first",
}
READING_FIELDS: dict[str, Any] = {
    "convention": {
        "type": "string",
        "enum": [each.value for each in Convention],
        "description": "The axes it is written in. Default: those of its profile",
    },
    "profile": {"type": "string", "description": "Which column is what, by the name of a profile. Default: guessed"},
    "columns": {"type": "string", "description": "A column map as JSON (`ColumnMap`), in the place of a profile"},
    "source": {
        "type": "string",
        "description": "Of a file with several attitudes: the topic, message, group or sheet. Default: the only one",
    },
    **{name: {"type": "boolean", "default": False, "description": about} for name, about in _FLAGS.items()},
}


def reading_options(fields: Mapping[str, str], saved: SavedProfiles) -> dict[str, Any]:
    """The fields of `formats.read_options.ReadOptions`, for `json`. Raises `ApiError` 422."""
    told = {name: text.strip() for name, text in fields.items()}
    how: dict[str, Any] = {
        name: told[name] for name in ("convention", "profile", "columns", "source") if told.get(name)
    }
    _check("convention", how.get("convention"), [each.value for each in Convention])
    if (profile := how.get("profile")) is not None and profile not in shipped():  # a name: no path of a client's
        path = saved.path(profile)
        if path is None:
            _check("profile", profile, [*shipped(), *saved.all()])
        how["profile"] = str(path)
    for name in _FLAGS:
        if told.get(name):
            _check(name, told[name], ["true", "false"])
            how[name] = told[name] == "true"
    return how


def _check(name: str, value: str | None, known: list[str]) -> None:
    if value is not None and value not in known:
        raise ApiError(422, "validation", f"{name}: {value[:40]!r}: expected one of {', '.join(known)}")

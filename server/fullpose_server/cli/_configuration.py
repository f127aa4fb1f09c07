"""A server's settings, from the command line, the environment and a file, in that order; and where each comes from.

What is misspelt is no setting, and an error: a bound that somebody believes to be set would not be there.
"""

import difflib
import importlib.util
import os
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails
from pydantic_settings import SettingsError

from fullpose_server.errors import FileError, ServerError
from fullpose_server.location import NO_DRIVER
from fullpose_server.settings import Settings
from fullpose_server.store.people_known import has_people

PREFIX = "FULLPOSE_"
FILE_VARIABLE = f"{PREFIX}CONFIG"
SECRETS = ("database_url", "oidc_client_secret")  # never repeated
NOBODY = (
    "no users are configured, so this server listens on this machine only: make one with `fullpose user add NAME --role"
    " admin` for this data folder, or use --host 127.0.0.1"
)


class ConfigurationError(ServerError):
    """Settings that cannot be."""


@dataclass(frozen=True)
class Configuration:
    """The settings, and for each its name where it was set: `--port`, `FULLPOSE_PORT`, `port in FILE`."""

    settings: Settings
    origins: dict[str, str]  # of those that are not as they are by default


def configured(
    host: str | None = None, port: int | None = None, data_dir: Path | None = None, config: Path | None = None
) -> Configuration:
    """The settings as given here, in the environment and in the file `config` (TOML), by default FULLPOSE_CONFIG's.

    Raises `ConfigurationError` and `FileError`, which name what is wrong where it was set.
    """
    given: dict[str, Any] = {"host": host, "port": port, "data_dir": data_dir}
    given = {key: value for key, value in given.items() if value is not None}
    variables = {name.upper(): name for name in os.environ if name.upper().startswith(PREFIX)}
    named = variables.pop(FILE_VARIABLE, None)
    file = config or (Path(os.environ[named]) if named and os.environ[named] else None)
    in_file = {} if file is None else _read(file)
    known = list(Settings.model_fields)
    in_environment = {variable.removeprefix(PREFIX).lower(): name for variable, name in variables.items()}
    origins = {
        **{key: f"{key} in {file}" for key in in_file},
        **in_environment,
        **{key: f"--{key.replace('_', '-')}" for key in given},
    }
    wrong = [_unknown(origins[key], key, known) for key in origins if key not in known]
    if wrong:
        raise ConfigurationError("; ".join(wrong))
    fallen_back = {key: value for key, value in in_file.items() if key not in in_environment}
    try:
        settings = Settings(**(fallen_back | given))
    except ValidationError as error:
        raise ConfigurationError("; ".join(_told(detail, origins) for detail in error.errors())) from None
    except SettingsError as error:  # a variable that should be JSON and is none
        raise ConfigurationError(f"settings: {error}") from None
    return Configuration(settings, origins)


def to_serve(found: Configuration) -> Configuration:
    """The same, where a server may start with it. Raises `ConfigurationError`: the network is for those who sign in."""
    settings = found.settings
    if settings.database_url is not None and importlib.util.find_spec("psycopg") is None:
        raise ConfigurationError(f"{found.origins['database_url']}: {NO_DRIVER}")
    if not (settings.loopback or settings.oidc_issuer or has_people(settings.database)):
        raise ConfigurationError(f"{found.origins['host']} = {settings.host}: {NOBODY}")
    return found


def _read(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(file.read_text("utf-8"))
    except OSError as error:
        raise FileError(str(file), f"a file of settings ({error.strerror})") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise FileError(str(file), f"TOML ({error})") from None


def _unknown(origin: str, key: str, known: Iterable[str]) -> str:
    like = difflib.get_close_matches(key, known, 1)
    if not like:
        return f"{origin}: there is no such setting"
    meant = f"{PREFIX}{like[0].upper()}" if origin.upper().startswith(PREFIX) else like[0]
    return f"{origin}: there is no such setting, did you mean {meant}?"


def _told(wrong: ErrorDetails, origins: dict[str, str]) -> str:
    key, *inside = (str(part) for part in wrong["loc"])
    word = wrong["msg"].replace("Input should be", "expected").replace("Value error, ", "")
    given = "" if key in SECRETS else f" = {wrong['input']!r}"
    return f"{'.'.join([origins.get(key, key), *inside])}{given}: {word}"

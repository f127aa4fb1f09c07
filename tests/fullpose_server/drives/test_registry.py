"""A drive of another package that cannot be made: a clear refusal, whatever its factory does."""

from typing import Any

import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.drives import registry
from fullpose_server.drives.base import DriveError

RIG = builtin_rigs()["vertical-4"]


class Half:
    name = "half"

    def connect(self, now: float) -> None: ...


def made_by(monkeypatch: pytest.MonkeyPatch, result: Any) -> Any:
    """What `registry.make` makes of a factory that returns, or raises, `result`."""

    def factory(*_: object) -> Any:
        if isinstance(result, BaseException):
            raise result
        return result

    monkeypatch.setitem(registry.BUILTIN, "other", f"{__name__}:factory")
    monkeypatch.setitem(globals(), "factory", factory)
    return registry.make("other", RIG, 1000.0, {})


@pytest.mark.parametrize(
    ("result", "told"),
    [
        (ValueError("no card"), "drive 'other' cannot be made: ValueError: no card"),
        (SystemExit(0), "drive 'other' cannot be made: SystemExit: 0"),
        (DriveError("options: address is missing"), "options: address is missing"),
        (None, "drive 'other' made NoneType, which has no name, connect, enable, read, write, brake"),
        (Half(), "drive 'other' made Half, which has no enable, read, write, brake"),
    ],
)
def test_a_factory_that_makes_no_drive_is_refused_by_name(
    monkeypatch: pytest.MonkeyPatch, result: Any, told: str
) -> None:
    with pytest.raises(DriveError) as refusal:
        made_by(monkeypatch, result)
    assert str(refusal.value).startswith(told)


def test_the_drives_of_our_own_are_made() -> None:
    assert registry.make("simulated", RIG, 1000.0, {}).name == "simulated"

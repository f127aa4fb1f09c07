"""Arguments that several commands have, and commands whose arguments are one record.

Typer reads a command's arguments from a function's parameters; `command` gives it those of a dataclass, so that a
command that takes many is a function of one.
"""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_type_hints

import typer

Record = TypeVar("Record")

FlightFile = Annotated[
    Path, typer.Argument(metavar="IN", help="A log with one attitude (docs/guide/formats.md), or a scenario (TOML).")
]
RigName = Annotated[str, typer.Option(help="Name of a built-in rig, or a TOML file.")]
StartPose = Annotated[
    str | None, typer.Option(help="Start pose base,outer,middle,inner in degrees; without it the pose is free.")
]
ToleranceDeg = Annotated[
    float | None,
    typer.Option(
        metavar="DEG",
        help="The attitude may differ from the input by at most that [deg]: noise, rounding, holds and jitter go.",
    ),
]

Config = Annotated[
    Path | None, typer.Option(help="Settings, as TOML: port = 8642; by default the file FULLPOSE_CONFIG names.")
]


@dataclass(frozen=True, kw_only=True)
class ReadingArguments:
    """How a flight is read: the same for every command that reads one."""

    convention: Annotated[
        str | None,
        typer.Option(help="The axes it is written in, nue, ned or enu; without it, its profile's."),
    ] = None
    profile: Annotated[
        str | None, typer.Option(help="Which column is what: a named profile or a TOML file; without it, guessed.")
    ] = None
    source: Annotated[
        str | None,
        typer.Option(help="Of a file with several attitudes: the topic, message, group or sheet; they are listed."),
    ] = None
    strict: Annotated[bool, typer.Option("--strict", help="Refuse a flight that there is a warning about.")] = False
    bridge_gaps: Annotated[
        bool, typer.Option("--bridge-gaps", help="Fly through gaps by interpolation; refused without it.")
    ] = False
    drop_duplicates: Annotated[
        bool, typer.Option("--drop-duplicates", help="Of samples with one stamp, keep the first.")
    ] = False


def command(record: type[Record], run: Callable[[Record], None]) -> Callable[..., None]:
    """`run` with the fields of the dataclass `record` as its parameters, in their order, what must be given first."""

    def called(**arguments: Any) -> None:
        run(record(**arguments))

    hints = get_type_hints(record, include_extras=True)
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    called.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(
                each.name,
                kind,
                default=inspect.Parameter.empty if each.default is MISSING else each.default,
                annotation=hints[each.name],
            )
            for each in sorted(fields(record), key=lambda each: each.default is not MISSING)  # type: ignore[arg-type]
        ]
    )
    called.__annotations__ = hints
    return called

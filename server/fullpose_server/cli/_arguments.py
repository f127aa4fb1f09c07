"""Arguments that several commands have, and commands whose arguments are one record.

Typer reads a command's arguments from a function's parameters; `command` gives it those of a dataclass, so that a
command that takes many is a function of one.
"""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_type_hints

import typer

Record = TypeVar("Record")

FlightFile = Annotated[
    Path, typer.Argument(metavar="IN", help="CSV or Parquet: time_s and one attitude; or a scenario (TOML).")
]
RigName = Annotated[str, typer.Option(help="Name of a built-in rig, or a TOML file.")]
StartPose = Annotated[
    str | None, typer.Option(help="Start pose base,outer,middle,inner in degrees; without it the pose is free.")
]
ConventionName = Annotated[
    str, typer.Option(help="nue (yaw_deg,pitch_deg,roll_deg) or ned (heading_deg,pitch_deg,bank_deg).")
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


def command(record: type[Record], run: Callable[[Record], None]) -> Callable[..., None]:
    """`run` with the fields of the dataclass `record` as its parameters, in their order."""

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
            for each in fields(record)  # type: ignore[arg-type]
        ]
    )
    called.__annotations__ = hints
    return called

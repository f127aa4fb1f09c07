"""`fullpose inspect`: what a recorded flight is made of and what is wrong with it."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import typer

from fullpose_server.cli._arguments import ReadingArguments, command
from fullpose_server.cli._exit import say

File = Annotated[Path, typer.Argument(metavar="FILE", help="A log with one attitude.")]


def register(app: typer.Typer) -> None:
    """Add the command."""
    about = "Say what a recorded flight is made of: noise, rounding, holds, stamps, gaps, outliers."
    app.command("inspect", help=about)(command(InspectArguments, inspect))


@dataclass(frozen=True, kw_only=True)
class InspectArguments(ReadingArguments):
    """What `fullpose inspect` is told."""

    flight: File
    rig: Annotated[str | None, typer.Option(help="Say it of this rig's frames, too: a built-in name or a file.")] = None
    as_json: Annotated[bool, typer.Option("--json", help="The figures and the sentences as JSON.")] = False


def inspect(asked: InspectArguments) -> None:
    """Print the findings, one a line, the warnings first. Exit 2: bad input."""
    from fullpose_server.cli._flight import input_report, read_options, statements
    from fullpose_server.formats.diagnosis import diagnosis_report
    from fullpose_server.formats.rig_file import find_rig
    from fullpose_server.formats.trajectory_file import read_trajectory

    rig = None if asked.rig is None else find_rig(asked.rig).rig
    # A gap is what is looked for here: it is no reason to say nothing.
    flight = read_trajectory(asked.flight, options=replace(read_options(asked), bridge_gaps=True))
    report = diagnosis_report(flight.time, flight.q, rig)
    for statement in statements(asked.flight, flight):
        say(statement)
    if asked.as_json:
        convention, taken = flight.convention.value, input_report(asked.flight, flight)
        head = {"file": str(asked.flight), "convention": convention, "input": taken}
        typer.echo(json.dumps(head | report, indent=2))
        return
    typer.echo(f"{asked.flight}: {report['samples']} samples in {report['duration_s']:.6g} s")
    for finding in report["findings"]:
        typer.echo(f"  {finding['level']}: {finding['sentence']}")

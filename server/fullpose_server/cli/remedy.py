"""`fullpose remedy`: what would make a flight fit a rig."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fullpose.vocabulary import RemedyKind
from fullpose_server.cli._arguments import FlightFile, ReadingArguments, RigName, StartPose, ToleranceDeg, command
from fullpose_server.cli._exit import DONE, NOT_FEASIBLE, fail
from fullpose_server.cli._flight import read_flight
from fullpose_server.cli._outputs import OUT_KINDS, check_outputs
from fullpose_server.cli._progress import progress_bar


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("remedy", help="Search what would make a flight fit a rig, and plan it so.")(
        command(RemedyArguments, remedy)
    )


@dataclass(frozen=True, kw_only=True)
class RemedyArguments(ReadingArguments):
    """What `fullpose remedy` is told."""

    flight: FlightFile
    rig: RigName
    kind: Annotated[str, typer.Option(help=f"{', '.join(RemedyKind)}.")]
    out: Annotated[Path, typer.Option(help=f"Angles of the changed flight; {OUT_KINDS}.")]
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON, with what was changed.")] = None
    frame: Annotated[str | None, typer.Option(help="relax: of this frame alone.")] = None
    limit: Annotated[str | None, typer.Option(help="relax: of position, rate, acceleration or jerk alone.")] = None
    start: StartPose = None
    tolerance: ToleranceDeg = None


def remedy(asked: RemedyArguments) -> None:
    """Say what was changed, write OUT. Exit 2: bad input, OUT untouched. Exit 3: this remedy is not enough."""
    from fullpose.verify import verify
    from fullpose_server.errors import NoRemedyError
    from fullpose_server.formats.output_file import write_text
    from fullpose_server.formats.report import make_report, margins_report, verdict_report
    from fullpose_server.formats.rig_file import find_rig
    from fullpose_server.formats.solution_file import write_solution
    from fullpose_server.planning.flown_within import flown_within
    from fullpose_server.planning.remedy import find_remedy, refuse_noise, tolerated
    from fullpose_server.planning.remedy_request import RemedyRequest

    flight, kind = asked.flight, asked.kind
    chosen = find_rig(asked.rig).rig
    request = RemedyRequest(kind, asked.frame, asked.limit)
    request.check(chosen)
    check_outputs({"--out": asked.out, "--report": asked.report}, flight, asked.rig)
    read = read_flight(flight, asked, chosen, asked.start)
    with progress_bar("tolerance"):
        told = flown_within(read.time, read.q, asked.tolerance, "--tolerance")
    with progress_bar(kind) as progress:
        try:
            refuse_noise(request, told.time, told.attitude, chosen)
            found = find_remedy(
                request, told.time, told.attitude, chosen, start=read.start, progress=progress,
                smoothed=told.smoothed,
            )  # fmt: skip
        except NoRemedyError as error:
            read.tell()
            fail(f"{flight}: {error}", NOT_FEASIBLE)
    done = found.remedy
    made = make_report(done.plan.solution, verify(done.time, done.plan.solution.angles, done.rig, done.attitude))
    made["rig"] = chosen.name
    made.update(verdict_report(done.plan))
    made["margins"] = margins_report(done.plan.margins, done.rig)
    made["remedy"] = found.described
    if kind == RemedyKind.TOLERANCE and found.described["value"]:
        made.update(tolerated(found.described))
    made["input"] = read.input
    with progress_bar("write") as progress:
        write_solution(asked.out, done.plan.solution, progress)
    if asked.report is not None:
        write_text(asked.report, json.dumps(made, indent=2) + "\n")
    read.tell()
    if not made["feasible"]:
        fail(
            f"{flight} does not fit {chosen.name} by {kind}; the best found: {found.described['statement']}",
            NOT_FEASIBLE,
        )
    for change in (found.described, *found.described["alternatives"]):
        typer.echo(change["statement"])
    raise typer.Exit(DONE)

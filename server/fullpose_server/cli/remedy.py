"""`fullpose remedy`: what would make a flight fit a rig."""

import json
from pathlib import Path
from typing import Annotated

import typer

from fullpose.vocabulary import RemedyKind
from fullpose_server.cli._exit import DONE, NOT_FEASIBLE, fail
from fullpose_server.cli._flight import read_flight
from fullpose_server.cli._outputs import check_outputs
from fullpose_server.cli._progress import progress_bar


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("remedy", help="Search what would make a flight fit a rig, and plan it so.")(remedy)


def remedy(
    flight: Annotated[
        Path, typer.Argument(metavar="IN", help="CSV or Parquet: time_s and one attitude; or a scenario (TOML).")
    ],
    rig: Annotated[str, typer.Option(help="Name of a built-in rig, or a TOML file.")],
    kind: Annotated[str, typer.Option(help=f"{', '.join(RemedyKind)}.")],
    out: Annotated[Path, typer.Option(help="Angles of the changed flight; Parquet where it ends in .parquet.")],
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON, with what was changed.")] = None,
    frame: Annotated[str | None, typer.Option(help="relax: of this frame alone.")] = None,
    limit: Annotated[str | None, typer.Option(help="relax: of position, rate or acceleration alone.")] = None,
    start: Annotated[
        str | None, typer.Option(help="Start pose base,outer,middle,inner in degrees; without it the pose is free.")
    ] = None,
    convention: Annotated[
        str, typer.Option(help="nue (yaw_deg,pitch_deg,roll_deg) or ned (heading_deg,pitch_deg,bank_deg).")
    ] = "nue",
) -> None:
    """Say what was changed, write OUT. Exit 2: bad input, OUT untouched. Exit 3: this remedy is not enough."""
    from fullpose.attitude import dcm_from_quaternion
    from fullpose.verify import verify
    from fullpose_server.errors import NoRemedyError
    from fullpose_server.formats.output_file import write_solution, write_text
    from fullpose_server.formats.report import make_report, margins_report, verdict_report
    from fullpose_server.formats.rig_file import find_rig
    from fullpose_server.planning.remedy import find_remedy
    from fullpose_server.planning.remedy_request import RemedyRequest

    chosen = find_rig(rig).rig
    asked = RemedyRequest(kind, frame, limit)
    asked.check(chosen)
    check_outputs({"--out": out, "--report": report}, flight, rig)
    read = read_flight(flight, convention, chosen, start)
    attitude = dcm_from_quaternion(read.q)
    with progress_bar(kind) as progress:
        try:
            found = find_remedy(asked, read.time, attitude, chosen, start=read.start, progress=progress)
        except NoRemedyError as error:
            fail(f"{flight}: {error}", NOT_FEASIBLE)
    done = found.remedy
    made = make_report(done.plan.solution, verify(done.time, done.plan.solution.angles, done.rig, done.attitude))
    made["rig"] = chosen.name
    made.update(verdict_report(done.plan))
    made["margins"] = margins_report(done.plan.margins, done.rig)
    made["remedy"] = found.described
    with progress_bar("write") as progress:
        write_solution(out, done.plan.solution, progress)
    if report is not None:
        write_text(report, json.dumps(made, indent=2) + "\n")
    if not made["feasible"]:
        fail(
            f"{flight} does not fit {chosen.name} by {kind}; the best found: {found.described['statement']}",
            NOT_FEASIBLE,
        )
    for change in (found.described, *found.described["alternatives"]):
        typer.echo(change["statement"])
    raise typer.Exit(DONE)

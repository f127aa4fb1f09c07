"""`fullpose solve`: the frame angles of a flight."""

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fullpose_server.cli._arguments import FlightFile, ReadingArguments, RigName, StartPose, ToleranceDeg, command
from fullpose_server.cli._exit import DONE, NOT_FEASIBLE, fail, say
from fullpose_server.cli._flight import read_flight
from fullpose_server.cli._outputs import OUT_KINDS, check_outputs
from fullpose_server.cli._progress import progress_bar

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fullpose.plan import Plan
    from fullpose.rig import Rig
    from fullpose.solution import Solution
    from fullpose_server.planning.flown_within import Within

METHODS = (
    "plan, preview, exact, alm, dwln, lagrange, weighted, gradient_projection, fixed_joint, clamped, follow_up, "
    "three_axis"
)


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("solve", help="Solve the frame angles of a flight.")(command(SolveArguments, solve))


@dataclass(frozen=True, kw_only=True)
class SolveArguments(ReadingArguments):
    """What `fullpose solve` is told."""

    flight: FlightFile
    rig: RigName
    out: Annotated[Path, typer.Option(help=f"Angles, one row an input row; {OUT_KINDS}.")]
    method: Annotated[str, typer.Option(help=f"{METHODS}.")] = "plan"
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON.")] = None
    start: StartPose = None
    plot: Annotated[Path | None, typer.Option(help="Write the plots as one HTML page.")] = None
    option: Annotated[
        list[str] | None, typer.Option("--option", "-o", metavar="NAME=VALUE", help="Option of the method.")
    ] = None
    tolerance: ToleranceDeg = None


def solve(asked: SolveArguments) -> None:
    """Solve, write OUT and what else was asked for. Exit 2: bad input, OUT untouched. Exit 3: not feasible."""
    from fullpose.attitude import dcm_from_quaternion
    from fullpose.verify import verify
    from fullpose_server.formats.output_file import write_text
    from fullpose_server.formats.report import make_report, verdict_report, why_infeasible, why_not_exact
    from fullpose_server.formats.rig_file import find_rig
    from fullpose_server.formats.solution_file import write_solution
    from fullpose_server.formats.tolerance_report import advice
    from fullpose_server.planning.flown_within import flown_within

    flight, method = asked.flight, asked.method
    chosen = find_rig(asked.rig).rig
    check_outputs({"--out": asked.out, "--report": asked.report, "--plot": asked.plot}, flight, asked.rig)
    options = _options(method, asked.option or [])  # first: a file may take long to read
    read = read_flight(flight, asked, chosen, asked.start)
    with progress_bar("tolerance"):
        told = flown_within(read.time, read.q, asked.tolerance, "--tolerance")
    solution, planned = _solve(told, read.start, chosen, method, options)
    given = dcm_from_quaternion(read.q)
    made = told.reported(make_report(solution, verify(solution.time, solution.angles, chosen, given)))
    solution = told.measured(solution)
    made["warnings"] = [{"code": c.code, "message": c.message} for c in read.warnings]
    made["input"] = read.input
    if planned is not None:
        made.update(verdict_report(planned))
    with progress_bar("write") as progress:
        write_solution(asked.out, solution, progress)
    if asked.report is not None:
        from fullpose.plan.verdict import margins
        from fullpose_server.formats.report import margins_report

        made["margins"] = margins_report(margins(solution.time, solution.angles, chosen), chosen)
        write_text(asked.report, json.dumps(made, indent=2) + "\n")
    if asked.plot is not None:
        from fullpose_server.pages.plot_page import plot_page

        write_text(asked.plot, plot_page(solution, told.attitude, made, flight.name))
    read.tell()
    typer.echo(_summary(made))
    why, advised = why_infeasible(made), advice(made)
    statement = made["verdict"]["statement"] if planned is not None else ""
    if why is not None:
        rests = f". {statement}" if statement else ""
        if advised:
            rests = f"{rests.rstrip('.')}. {advised[0].upper()}{advised[1:]} (--tolerance)"
        fail(f"{flight} is not feasible on {chosen.name} with {method}: {why}{rests}", NOT_FEASIBLE)
    if "smoothing" in made:
        say(f"{flight}: {made['smoothing']}")
    if planned is not None:
        say(f"{flight}: {statement}")
        if planned.lead_refusal:
            say(f"{flight}: a rig cannot fly it from rest to rest: {planned.lead_refusal}")
    if (missed := why_not_exact(made)) is not None:
        say(f"{flight}: warning: {missed}")
    raise typer.Exit(DONE)


def _options(method: str, texts: list[str]) -> Any:
    """The options of a method, of `name=value` each. Raises `InputError`."""
    from fullpose.registry import method_options, parse_option

    return method_options(method, dict(parse_option(text, method) for text in texts))


def _solve(
    told: "Within", start: "NDArray[Any] | None", rig: "Rig", method: str, options: Any
) -> tuple["Solution", "Plan | None"]:
    """The solution; of method plan the whole plan, too, which says what the verdict rests on."""
    from fullpose.solve import solve_flight
    from fullpose_server.planning.remaining_tolerance import with_remaining

    with progress_bar(method) as progress:
        solved = solve_flight(
            told.time,
            told.attitude,
            rig,
            method=method,
            options=with_remaining(method, options, told.smoothed),
            start=start,
            clock=time.perf_counter,
            progress=progress,
        )
    return solved.solution, solved.plan


def _summary(report: dict[str, Any]) -> str:
    from fullpose_server.formats.report import exact_text

    peaks = ", ".join(f"{frame} {peak['rate_deg_s']:.1f}" for frame, peak in report["peak"].items())
    error = report["max_error_deg"]
    exact = "exact" if report["exact_samples"] == report["samples"] else f"{exact_text(report)} of the samples exact"
    return (
        f"{report['samples']} samples on {report['rig']} with {report['method']}: "
        f"{'feasible' if report['feasible'] else 'not feasible'}, {exact}, largest error {error:.3g} deg, "
        f"peak rates {peaks} deg/s, solved in {report['solve_s']:.3g} s"
    )

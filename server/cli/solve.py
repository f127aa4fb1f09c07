"""`fullpose solve`: the frame angles of a flight."""

import json
import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from server.cli._exit import DONE, NOT_FEASIBLE, fail, say
from server.cli._progress import progress_bar

if TYPE_CHECKING:
    from server.store.trajectory import Trajectory
    from solver.rig import Rig
    from solver.solution import Solution

METHODS = (
    "plan, preview, exact, alm, dwln, lagrange, weighted, gradient_projection, fixed_joint, clamped, follow_up, "
    "three_axis"
)


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("solve", help="Solve the frame angles of a flight (CSV or Parquet).")(solve)


def solve(
    flight: Annotated[Path, typer.Argument(metavar="IN", help="CSV or Parquet: time_s and one attitude.")],
    rig: Annotated[str, typer.Option(help="Name of a built-in rig, or a TOML file.")],
    out: Annotated[Path, typer.Option(help="Angles, one row an input row; Parquet where it ends in .parquet.")],
    method: Annotated[str, typer.Option(help=f"{METHODS}.")] = "plan",
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON.")] = None,
    start: Annotated[
        str | None, typer.Option(help="Start pose base,outer,middle,inner in degrees; without it the pose is free.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(help="Write the plots as one HTML page.")] = None,
    convention: Annotated[
        str, typer.Option(help="nue (yaw_deg,pitch_deg,roll_deg) or ned (heading_deg,pitch_deg,bank_deg).")
    ] = "nue",
    option: Annotated[
        list[str] | None, typer.Option("--option", "-o", metavar="NAME=VALUE", help="Option of the method.")
    ] = None,
) -> None:
    """Solve, write OUT and what else was asked for. Exit 2: bad input, OUT untouched. Exit 3: not feasible."""
    from server.store.output_file import check_writable, write_solution, write_text
    from server.store.report import make_report, why_infeasible
    from server.store.rig_file import find_rig
    from server.store.trajectory_file import read_trajectory
    from solver.verify import verify

    chosen = find_rig(rig).rig
    pose = _pose(start)
    for path in filter(None, (out, report, plot)):
        check_writable(path)
    trajectory = read_trajectory(flight, _convention(convention))
    for caution in trajectory.warnings:
        say(f"{flight}: warning: {caution.message}")
    solution, attitude = _solve(trajectory, chosen, method, option or [], pose)
    made = make_report(solution, verify(solution.time, solution.angles, chosen, attitude))
    made["warnings"] = [{"code": c.code, "message": c.message} for c in trajectory.warnings]
    with progress_bar("write") as progress:
        write_solution(out, solution, progress)
    if report is not None:
        from server.store.report import margins_report
        from solver.planner.verdict import margins

        made["margins"] = margins_report(margins(solution.time, solution.angles, chosen), chosen)
        write_text(report, json.dumps(made, indent=2) + "\n")
    if plot is not None:
        from server.store.plot_page import plot_page

        write_text(plot, plot_page(solution, made, flight.name))
    typer.echo(_summary(made))
    why = why_infeasible(made)
    if why is not None:
        fail(f"{flight} is not feasible on {chosen.name} with {method}: {why}", NOT_FEASIBLE)
    raise typer.Exit(DONE)


def _solve(trajectory: "Trajectory", rig: "Rig", method: str, texts: list[str], start: Any) -> tuple["Solution", Any]:
    from solver.attitude import dcm_from_quaternion
    from solver.method_options import method_options, parse_option
    from solver.solve import solve as solve_flight

    options = method_options(method, dict(parse_option(text, method) for text in texts))
    attitude = dcm_from_quaternion(trajectory.q)
    with progress_bar(method) as progress:
        solution = solve_flight(
            trajectory.time,
            attitude,
            rig,
            method=method,
            options=options,
            start=start,
            clock=time.perf_counter,
            progress=progress,
        )
    return solution, attitude


def _pose(text: str | None) -> Any:
    if text is None:
        return None
    import numpy as np

    parts = text.split(",")
    try:
        angles = [float(part) for part in parts]
    except ValueError:
        angles = []
    if len(angles) != 4 or not all(map(math.isfinite, angles)):
        fail(f"--start {text}: expected four angles in degrees, base,outer,middle,inner, such as 0,0,0,0")
    return np.deg2rad(np.array(angles))


def _convention(text: str) -> Any:
    from server.store.trajectory import Convention

    try:
        return Convention(text)
    except ValueError:
        fail(f"--convention {text}: expected one of {', '.join(Convention)}")


def _summary(report: dict[str, Any]) -> str:
    peaks = ", ".join(f"{frame} {peak['rate_deg_s']:.1f}" for frame, peak in report["peak"].items())
    error = report["max_error_deg"]
    return (
        f"{report['samples']} samples on {report['rig']} with {report['method']}: "
        f"{'feasible' if report['feasible'] else 'not feasible'}, largest error {error:.3g} deg, "
        f"peak rates {peaks} deg/s, solved in {report['solve_s']:.3g} s"
    )

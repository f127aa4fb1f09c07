"""`fullpose compare`: methods side by side on one flight and rig."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from server.cli._exit import DONE, fail, say
from server.cli._progress import progress_bar
from server.cli.solve import METHODS, _convention, _pose

if TYPE_CHECKING:
    from numpy.typing import NDArray

COLUMNS = ("method", "exact", "largest error", "beyond limits", "limited", "peak rate", "peak accel.", "step")


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("compare", help="Put methods side by side on one flight and rig.")(compare)


def compare(
    flight: Annotated[
        Path, typer.Argument(metavar="IN", help="CSV or Parquet: time_s and one attitude; or a scenario (TOML).")
    ],
    rig: Annotated[str, typer.Option(help="Name of a built-in rig, or a TOML file.")],
    methods: Annotated[str, typer.Option(help=f"Names with commas between, of {METHODS}.")] = METHODS.replace(" ", ""),
    report: Annotated[Path | None, typer.Option(help="Write the figures as JSON.")] = None,
    page: Annotated[Path | None, typer.Option(help="Write table and plots as one self-contained HTML page.")] = None,
    start: Annotated[
        str | None, typer.Option(help="Start pose base,outer,middle,inner in degrees; without it the pose is free.")
    ] = None,
    convention: Annotated[
        str, typer.Option(help="nue (yaw_deg,pitch_deg,roll_deg) or ned (heading_deg,pitch_deg,bank_deg).")
    ] = "nue",
    rate: Annotated[
        float | None, typer.Option(help="Bring the flight to this rate [Hz] first; without it its samples are solved.")
    ] = None,
) -> None:
    """Solve with each method, print the figures, write what was asked for. Exit 2: bad input, nothing written."""
    from server.store.comparison import make_comparison
    from server.store.output_file import check_writable, write_text
    from server.store.rig_file import find_rig

    names = [name.strip() for name in methods.split(",") if name.strip()]
    if not names:
        fail(f"--methods {methods!r}: expected names with commas between, of {METHODS}")
    chosen = find_rig(rig).rig
    pose = _pose(start)
    for path in filter(None, (report, page)):
        check_writable(path)
    at, q, own_start = _read(flight, convention)
    with progress_bar("compare") as bar:
        done_before: dict[str, int] = {}

        def progress(method: str, done: int, total: int) -> None:
            done_before.setdefault(method, len(done_before))
            if bar is not None:
                bar(done_before[method] * total + done, len(names) * total)

        made = make_comparison(flight.name, at, q, chosen, names, own_start if pose is None else pose, rate, progress)
    if report is not None:
        write_text(report, json.dumps(made.report, indent=2) + "\n")
    if page is not None:
        write_text(page, made.page)
    typer.echo(_table(made.report))
    raise typer.Exit(DONE)


def _read(flight: Path, convention: str) -> tuple["NDArray[Any]", "NDArray[Any]", "NDArray[Any] | None"]:
    """(time, quaternion, start pose or None) of a flight or scenario file."""
    import numpy as np

    if flight.suffix == ".toml":
        from server.store.scenario_file import read_scenario

        scenario = read_scenario(flight)
        return scenario.time, scenario.quaternion, None if scenario.start is None else np.array(scenario.start)
    from server.store.trajectory_file import read_trajectory

    trajectory = read_trajectory(flight, _convention(convention))
    for caution in trajectory.warnings:
        say(f"{flight}: warning: {caution.message}")
    return trajectory.time, trajectory.q, None


def _table(report: dict[str, Any]) -> str:
    rows = [COLUMNS]
    refusals = []
    for method in report["methods"]:
        if method["refusal"] is not None:
            refusals.append(method["refusal"])
            continue
        peaks = method["peak"].values()
        rows.append(
            (
                method["method"],
                f"{100 * method['exact_share']:.2f} %",
                f"{method['max_error_deg']:.2g} deg",
                str(method["limit_violation_samples"]),
                str(method["limited_samples"]),
                f"{max(peak['rate_deg_s'] for peak in peaks):.4g} deg/s",
                f"{max(peak['acceleration_deg_s2'] for peak in peaks):.4g} deg/s2",
                f"{method['step_us']['median']:.2f} us",
            )
        )
    widths = [max(len(row[k]) for row in rows) for k in range(len(COLUMNS))]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]
    heading = f"{report['flight']} on {report['rig']}: {report['samples']} samples over {report['duration_s']:.6g} s"
    if report["resampling"]:
        heading += f" ({report['resampling']})"
    return "\n".join([heading, *lines, *refusals])

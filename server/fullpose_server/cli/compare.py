"""`fullpose compare`: methods side by side on one flight and rig."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from fullpose_server.cli._arguments import FlightFile, ReadingArguments, RigName, StartPose, ToleranceDeg, command
from fullpose_server.cli._exit import DONE
from fullpose_server.cli._flight import read_flight
from fullpose_server.cli._outputs import check_outputs
from fullpose_server.cli._progress import progress_bar
from fullpose_server.cli.solve import METHODS

COLUMNS = ("method", "exact", "largest error", "beyond limits", "limited", "peak rate", "peak accel.", "step")


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("compare", help="Put methods side by side on one flight and rig.")(command(CompareArguments, compare))


@dataclass(frozen=True, kw_only=True)
class CompareArguments(ReadingArguments):
    """What `fullpose compare` is told."""

    flight: FlightFile
    rig: RigName
    methods: Annotated[
        str, typer.Option(help=f"With commas between, options after colons (alm:mode=open_loop), of {METHODS}.")
    ] = METHODS.replace(" ", "")
    report: Annotated[Path | None, typer.Option(help="Write the figures as JSON.")] = None
    page: Annotated[Path | None, typer.Option(help="Write table and plots as one self-contained HTML page.")] = None
    start: StartPose = None
    rate: Annotated[
        float | None, typer.Option(help="Bring the flight to this rate [Hz] first; without it its samples are solved.")
    ] = None
    tolerance: ToleranceDeg = None


def compare(given: CompareArguments) -> None:
    """Solve with each method, print the figures, write what was asked for.

    Exit 2: bad input, or no method applies to the rig; nothing written.
    """
    from fullpose.compare import variants
    from fullpose_server.formats.output_file import write_text
    from fullpose_server.formats.rig_file import find_rig
    from fullpose_server.planning.flown_within import flown_within
    from fullpose_server.planning.make_comparison import make_comparison

    asked = variants([text for text in given.methods.split(",") if text.strip()])
    chosen = find_rig(given.rig).rig
    check_outputs({"--report": given.report, "--page": given.page}, given.flight, given.rig)
    read = read_flight(given.flight, given, chosen, given.start)
    told = flown_within(read.time, read.q, given.tolerance, "--tolerance")
    with progress_bar("compare") as bar:
        order = {one.label: k for k, one in enumerate(asked)}

        def progress(label: str, done: int, total: int) -> None:
            if bar is not None:
                bar(order[label] * total + done, len(order) * total)

        made = make_comparison(given.flight.name, told, chosen, asked, read.start, given.rate, progress)
    report = made.report | {"input": read.input}
    if given.report is not None:
        write_text(given.report, json.dumps(report, indent=2) + "\n")
    if given.page is not None:
        write_text(given.page, made.page)
    read.tell()
    typer.echo(_table(report))
    raise typer.Exit(DONE)


def _table(report: dict[str, Any]) -> str:
    from fullpose_server.formats.report import exact_text
    from fullpose_server.formats.tolerance_report import advice

    rows = [COLUMNS]
    refusals, reasons = [], []
    for method in report["methods"]:
        if method["refusal"] is not None:
            refusals.append(f"{method['label']}: {method['refusal']}")
            continue
        peaks = method["peak"].values()
        rows.append(
            (
                method["label"],
                exact_text(method),
                f"{method['max_error_deg']:.2g} deg",
                str(method["limit_violation_samples"]),
                str(method["limited_samples"]),
                f"{max(peak['rate_deg_s'] for peak in peaks):.4g} deg/s",
                f"{max(peak['acceleration_deg_s2'] for peak in peaks):.4g} deg/s2",
                f"{method['step_us']['median']:.2f} us",
            )
        )
        if method["why"] is not None:
            sure = f". {method['how_sure']}" if method["how_sure"] and not method["feasible"] else ""
            reasons.append(f"  {method['label']}: {method['why']}{sure}")
    widths = [max(len(row[k]) for row in rows) for k in range(len(COLUMNS))]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]
    heading = f"{report['flight']} on {report['rig']}: {report['samples']} samples over {report['duration_s']:.6g} s"
    if report["resampling"]:
        heading += f" ({report['resampling']})"
    if "smoothing" in report:
        heading += f", within {report['tolerance_deg']:g} deg: {report['smoothing']}"
    advised = advice(report)
    closing = [] if advised is None else [f"{advised[0].upper()}{advised[1:]} (--tolerance)"]
    return "\n".join([heading, *lines, *reasons, *refusals, *closing])

"""`fullpose export`: a recorded run, or a plan, as a file of another program."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fullpose_server.cli._exit import fail

if TYPE_CHECKING:
    from collections.abc import Callable

    from fullpose_server.formats.exporters.registry import ExportKind

KINDS = "CSV, Parquet, MCAP, MATLAB (.mat), TDMS, MDF4 (.mf4) or playback (.f64)"


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("export", help=f"Write a recorded run, or a plan, as {KINDS}.")(export)


def export(
    what: Annotated[
        str,
        typer.Argument(
            metavar="RUN|PLAN",
            help="Id of a run or of a plan, `latest` (run), or the path of an MCAP file or of a plan.",
        ),
    ],
    out: Annotated[
        Path | None, typer.Option(help="File to write; its ending is the format. Default: its id.csv.")
    ] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where the server keeps its data.")] = None,
) -> None:
    """Write every sample of the record, or of the plan."""
    from fullpose_server.formats.exporters.registry import ENDINGS, check_installed, exporter_of
    from fullpose_server.formats.output_file import check_apart, check_writable, replacing

    source = _source(what, data_dir)
    target = out or Path(f"{source.stem}.csv")
    row = exporter_of(target)
    if row is None:
        fail(f"--out {target}: expected a name ending in one of {ENDINGS}")
    check_writable(target)
    check_installed(row.kind, str(target))
    check_apart({"--out": target}, {"RUN": source})
    write = _writer(source)
    with replacing(target) as draft:
        write(draft, row.kind)
    typer.echo(str(target))


def _writer(source: Path) -> "Callable[[Path, ExportKind], None]":
    """What writes a record's file, or a plan's folder."""
    if not source.is_dir():
        from fullpose_server.runtime.recording.export import write_export

        return partial(write_export, source)
    from fullpose_server.formats.exporters.registry import write_table
    from fullpose_server.formats.plan_export import plan_table
    from fullpose_server.formats.plan_folder import PlanFolderError, read_plan

    try:
        made = plan_table(read_plan(source))
    except PlanFolderError as error:
        fail(str(error))
    return lambda draft, kind: write_table(made, draft, kind, source.name)


def _source(what: str, data_dir: Path | None) -> Path:
    """The record's file, or the plan's folder."""
    from fullpose_server.settings import default_data_dir

    if what.endswith(".mcap"):
        if not Path(what).is_file():
            fail(f"{what}: no such file")
        return Path(what)
    if (Path(what) / "plan.json").is_file():
        return Path(what)
    data = data_dir or default_data_dir()
    plan = data / "plans" / what
    if "/" not in what and (plan / "plan.json").is_file():
        return plan
    found = sorted((data / "runs").glob("*.mcap"))
    if what == "latest":
        if not found:
            fail(f"no runs are recorded in {data / 'runs'}: name another --data-dir")
        return found[-1]
    record = next((path for path in found if path.stem == what), None)
    if record is None:
        newest = f"the newest run is {found[-1].stem}" if found else "it has no runs"
        fail(f"no run and no plan {what!r} in {data}; {newest}")
    return record

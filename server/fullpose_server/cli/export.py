"""`fullpose export`: a recorded run as CSV, Parquet or MCAP."""

from pathlib import Path
from typing import Annotated

import typer

from fullpose_server.cli._exit import fail

FORMATS = ("csv", "parquet", "mcap")


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("export", help="Write a recorded run as CSV, Parquet or MCAP.")(export)


def export(
    run: Annotated[str, typer.Argument(metavar="RUN", help="Id of a run, `latest`, or the path of an MCAP file.")],
    out: Annotated[Path | None, typer.Option(help="File to write; its ending is the format. Default: RUN.csv.")] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where the server keeps its data.")] = None,
) -> None:
    """Write every sample of the record."""
    from fullpose_server.formats.output_file import check_apart, check_writable, replacing
    from fullpose_server.runtime.recording.export import write_export

    record = _record(run, data_dir)
    target = out or Path(f"{record.stem}.csv")
    kind = target.suffix.removeprefix(".")
    if kind not in FORMATS:
        fail(f"--out {target}: expected a name ending in .csv, .parquet or .mcap")
    check_writable(target)
    check_apart({"--out": target}, {"RUN": record})
    with replacing(target) as draft:
        write_export(record, draft, kind)
    typer.echo(str(target))


def _record(run: str, data_dir: Path | None) -> Path:
    from fullpose_server.settings import default_data_dir

    if run.endswith(".mcap"):
        if not Path(run).is_file():
            fail(f"{run}: no such file")
        return Path(run)
    folder = (data_dir or default_data_dir()) / "runs"
    found = sorted(folder.glob("*.mcap"))
    if not found:
        fail(f"no runs are recorded in {folder}: name another --data-dir")
    if run == "latest":
        return found[-1]
    record = next((path for path in found if path.stem == run), None)
    if record is None:
        fail(f"no run {run!r} in {folder}; the newest is {found[-1].stem}")
    return record

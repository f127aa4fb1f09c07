"""The files that a command is told to write, checked before its work."""

from collections.abc import Mapping
from pathlib import Path

OUT_KINDS = "CSV, or by its ending .parquet, .mcap, .mat, .tdms, .mf4 or .f64 (playback)"


def check_outputs(outputs: Mapping[str, Path | None], flight: Path, rig: str) -> None:
    """Raise `FileError` where an output (by its option) cannot be written, or is IN, the rig or another output."""
    from fullpose.rig import builtin_rigs
    from fullpose_server.formats.exporters.registry import check_installed, exporter_of
    from fullpose_server.formats.output_file import check_apart, check_writable

    for path in filter(None, outputs.values()):
        check_writable(path)
    out = outputs.get("--out")
    if out is not None and (row := exporter_of(out)) is not None:
        check_installed(row.kind, str(out))
    inputs = {"IN": flight}
    if rig not in builtin_rigs():
        inputs["the file of --rig"] = Path(rig)
    check_apart(outputs, inputs)

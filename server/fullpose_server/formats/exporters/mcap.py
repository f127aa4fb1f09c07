"""As MCAP: a JSON message a row on the topic `/plan` or `/solution`, with its schema. A run is an MCAP file already."""

import math
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from mcap.writer import Writer

from fullpose_server.formats.exporters.table import ExportTable, Values

_BATCH = 4096


def write(table: ExportTable, target: Path) -> None:
    """Write it; a message is logged at its time after the first one."""
    start = float(table.columns["time_s"][0]) if table.rows else 0.0
    with target.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="", library="fullpose")
        writer.add_metadata(table.name, dict(table.facts))
        title = f"fullpose.{table.name.capitalize()}"
        schema = {
            "title": title,
            "type": "object",
            "properties": {name: {"type": _kind(values)} for name, values in table.columns.items()},
        }
        number = writer.register_schema(title, "jsonschema", msgspec.json.encode(schema))
        channel = writer.register_channel(f"/{table.name}", "json", number)
        for sequence, row in enumerate(_rows(table), start=1):
            at = round((row["time_s"] - start) * 1e9)
            writer.add_message(channel, at, msgspec.json.encode(row), at, sequence)
        writer.finish()  # type: ignore[no-untyped-call]


def _kind(values: Values) -> str:
    return "number" if values.dtype.kind == "f" else "integer" if values.dtype.kind in "iu" else "string"


def _rows(table: ExportTable) -> Any:
    """Each row as a mapping, without what is not a number."""
    names = tuple(table.columns)
    for begin in range(0, table.rows, _BATCH):
        part = [np.asarray(values[begin : begin + _BATCH]).tolist() for values in table.columns.values()]
        for cells in zip(*part, strict=True):
            yield {
                name: cell
                for name, cell in zip(names, cells, strict=True)
                if not (isinstance(cell, float) and math.isnan(cell))
            }

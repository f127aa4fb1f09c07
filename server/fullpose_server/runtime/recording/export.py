"""Records as others take them: a table as CSV or Parquet, and a whole MCAP file of what is left of a damaged one."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv
import pyarrow.parquet as pq
from mcap.writer import Writer

from fullpose_server.errors import FileError
from fullpose_server.runtime.contract.telemetry import FIELDS, Samples
from fullpose_server.runtime.recording import channels
from fullpose_server.runtime.recording.mcap_reader import (
    RecordError,
    is_complete,
    read_samples,
    recover_messages,
    run_of,
)
from fullpose_server.session.states import STATES


def table(rows: Samples) -> pa.Table:
    """One column a number, named with its frame and unit; what is not a number is null."""
    columns: dict[str, Any] = {}
    start = rows["time_ns"][0] if rows.size else 0
    columns["time_s"] = (rows["time_ns"] - start) / 1e9
    for field in FIELDS:
        values = rows[field.name]
        if field.name == "state":
            columns[field.name] = [STATES[code].value for code in values.tolist()]
        elif field.parts:
            columns |= {name: values[:, k] for k, name in enumerate(field.part_names)}
        else:
            columns[field.name] = values
    return pa.table({name: pa.array(_plain(values), from_pandas=True) for name, values in columns.items()})


def write_export(record: Path, target: Path, kind: str) -> None:
    """Write a record as `csv`, `parquet` or `mcap`. Raises `FileError`.

    As MCAP a record that is cut off, damaged or still being written is repaired: what can be read of it, with an index.
    """
    try:
        if kind == "mcap":
            if is_complete(record):
                shutil.copyfile(record, target)
            else:
                repair(record, target)
            return
        made = table(read_samples(record))
    except RecordError as error:
        raise FileError(record.name, f"a record ({error.why})") from None
    if kind == "parquet":
        pq.write_table(made, target)
    else:
        pacsv.write_csv(made, target)


def repair(path: Path, to: Path) -> int:
    """Write a whole file `to` from what can be read of `path`; returns the messages kept. Raises `RecordError`."""
    kept = 0
    numbers: dict[str, int] = {}  # of the channels
    run = run_of(path)
    with to.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="", library="fullpose recovery")
        writer.add_metadata("run", run)
        for topic, message in recover_messages(path):
            if topic not in numbers:
                if topic not in channels.SCHEMAS:
                    raise RecordError(path, f"topic {topic} is not a rig's")
                numbers[topic] = channels.register(writer, topic)
            writer.add_message(numbers[topic], message.log_time, message.data, message.publish_time, message.sequence)
            kept += 1
        writer.finish()  # type: ignore[no-untyped-call]
    return kept


def _plain(values: Any) -> Any:
    return np.ascontiguousarray(values) if isinstance(values, np.ndarray) else values

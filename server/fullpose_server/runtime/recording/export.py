"""Records as others take them: a table of every sample, and a whole MCAP file of what is left of a damaged one."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
from mcap.writer import Writer

from fullpose_server.errors import FileError
from fullpose_server.formats.exporters.registry import ExportKind, check_installed, write_table
from fullpose_server.formats.exporters.table import ExportTable, Motion, Values
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

_STATES = np.array([state.value for state in STATES])  # by code


def run_table(rows: Samples) -> ExportTable:
    """One column a number, named with its frame and unit; what is not a number is nan.

    What a table plays of it is what was commanded, with the rates and accelerations that the guard compared with the
    limits before each command was written.
    """
    start = rows["time_ns"][0] if rows.size else 0
    columns: dict[str, Values] = {"time_s": (rows["time_ns"] - start) / 1e9}
    for field in FIELDS:
        values = rows[field.name]
        if field.name == "state":
            columns[field.name] = _STATES[values]
        elif field.parts:
            columns |= {name: np.ascontiguousarray(values[:, k]) for k, name in enumerate(field.part_names)}
        else:
            columns[field.name] = np.ascontiguousarray(values)
    return ExportTable("run", columns, {}, lambda: _commanded(rows, columns["time_s"]))


def _commanded(rows: Samples, time: Values) -> Motion:
    """Raises `FileError` where samples are missing: the frames would jump."""
    lost = np.flatnonzero(np.diff(rows["seq"].astype(np.int64)) != 1)
    if lost.size:
        raise FileError("run", "a record without lost samples: a table would jump", line=int(lost[0]) + 2, unit="row")
    return Motion(np.asarray(time, float), *(rows[name] for name in ("demand", "demand_rate", "demand_acceleration")))


def write_export(record: Path, target: Path, kind: ExportKind) -> None:
    """Write a record as any kind of `formats.exporters`. Raises `FileError`.

    As MCAP a record that is cut off, damaged or still being written is repaired: what can be read of it, with an index.
    """
    try:
        if kind is ExportKind.MCAP:
            if is_complete(record):
                shutil.copyfile(record, target)
            else:
                repair(record, target)
            return
        check_installed(kind, record.name)
        made = replace(run_table(read_samples(record)), facts=_facts(record))
    except RecordError as error:
        raise FileError(record.name, f"a record ({error.why})") from None
    write_table(made, target, kind, record.name)


def _facts(record: Path) -> dict[str, str]:
    """What the record says of itself, as text."""
    return {name: str(value) for name, value in run_of(record).items()}


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

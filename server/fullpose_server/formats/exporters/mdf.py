"""As MDF 4.10 (ASAM; CANape, MDA, MATLAB): one group whose master channel is the time in seconds."""

import io
from pathlib import Path

import numpy as np
from asammdf import MDF, Signal

from fullpose_server.formats.exporters.table import ExportTable, Values, unit_of

MASTER = ("time_s", 1)  # the master channel's name; 1: it is a time


def write(table: ExportTable, target: Path) -> None:
    """Write it; what is known of the table is the group's comment."""
    time = np.ascontiguousarray(table.columns["time_s"], dtype=np.float64)
    signals = [
        Signal(
            samples=_samples(values),
            timestamps=time,
            name=name,
            unit=unit_of(name),
            encoding="utf-8",
            master_metadata=MASTER,
        )
        for name, values in table.columns.items()
        if name != "time_s"
    ]
    comment = "; ".join([table.name, *(f"{key}: {value}" for key, value in table.facts.items())])
    with MDF(version="4.10") as made:
        made.append(signals, acq_name=table.name, comment=comment, common_timebase=True)
        written = io.BytesIO()  # by a name it would be called .mf4, and nothing else
        made.save(written)
    target.write_bytes(written.getbuffer())


def _samples(values: Values) -> Values:
    """Text as bytes of one length, whole numbers and doubles as they are."""
    return np.char.encode(values.astype(str), "utf-8") if values.dtype.kind in "UO" else np.ascontiguousarray(values)

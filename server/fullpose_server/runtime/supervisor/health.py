"""A rig process's health, as its shared memory tells it."""

import time

import numpy as np
from numpy.typing import NDArray

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.drive_call import pending
from fullpose_server.runtime.contract.hung import is_silent, recorder_lost
from fullpose_server.runtime.contract.shared_memory import Shared


def beat_age_s(memory: Shared) -> float:
    """How long ago the rig process gave its last sign of life [s]."""
    return (time.monotonic_ns() - int(memory.header["rig_beat_ns"][0])) / 1e9


def health_of(
    memory: Shared, published: messages.Published, *, pid: int, alive: bool, rate_hz: float
) -> messages.Health:
    """Health as of now, of the process `pid` and its recorder."""
    header = memory.header
    return messages.Health(
        realtime=published.realtime,
        rate_hz=rate_hz,
        lateness_us=memory.lateness_us(),
        busy_us=int(header["busy_ns"][0]) / 1000.0,
        ticks=int(header["ticks"][0]),
        deadline_misses=int(header["misses"][0]),
        rig_alive=alive,
        rig_pid=pid,
        heartbeat_age_s=beat_age_s(memory),
        recorder=messages.RecorderHealth(
            alive=not recorder_lost(header, time.monotonic_ns()),
            run=_text(header["recorder_run"][0]),
            lost=int(header["recorder_lost"][0]),
            lag=max(0, int(header["head"][0]) - int(header["recorder_seq"][0])),
            bytes_written=int(header["recorder_bytes"][0]),
            chunks=int(header["recorder_chunks"][0]),
            free_bytes=int(header["recorder_free_bytes"][0]),
            error=_text(header["recorder_error"][0]),
        ),
        drive=_drive(header),
        live=published.live,
    )


def _drive(header: NDArray[np.void]) -> messages.DriveHealth:
    read, longest_read, write, longest_write = (
        int(header[name][0]) / 1e3 for name in ("read_ns", "read_max_ns", "write_ns", "write_max_ns")
    )
    call = pending(header) if is_silent(header, time.monotonic_ns()) else None
    return messages.DriveHealth(read, longest_read, write, longest_write, None if call is None else call.call.word)


def _text(value: np.bytes_) -> str:
    return bytes(value).decode("utf-8", "replace")

"""The process that reads uploads and solves batches: `python -m fullpose_server.api.offload.worker BYTES`.

It may take BYTES of memory beyond what it has when it is ready. What would take more is refused, and costs the server
nothing; a library that cannot bear to be refused ends this process alone.
"""

import ctypes
import resource
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fullpose_server.planning.worker import Maker, serve

_M_MMAP_THRESHOLD = -3  # of malloc.h
_MAPPED = 256 * 1024  # bytes from which an allocation is mapped by itself


def main() -> None:
    """Answer requests until stdin ends."""
    bound = int(sys.argv[1])

    def load() -> Mapping[str, Maker]:
        import pyarrow as pa

        from fullpose_server.api.offload import work

        pa.set_memory_pool(pa.system_memory_pool())  # the others reserve far more than they need
        pa.set_cpu_count(1)
        ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, _MAPPED)  # what is let go of goes back to the system
        resource.setrlimit(resource.RLIMIT_DATA, (_data_bytes() + bound,) * 2)
        return work.MAKERS

    def failure(error: Exception) -> dict[str, Any]:
        from fullpose_server.api.offload import work

        return work.failure(error, bound)

    serve(load, failure, niceness=0)  # somebody waits for it


def _data_bytes() -> int:
    """What of this process RLIMIT_DATA counts, as of now."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmData:"):
            return int(line.split()[1]) * 1024
    return 0


if __name__ == "__main__":
    main()

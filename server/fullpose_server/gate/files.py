"""How many files a process may have open: as many as the system grants it."""

import contextlib
import resource

MOST = 65536


def files() -> int:
    """Ask for as many as we may have; returns what was granted."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, max(soft, MOST)), hard))
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]

"""How SQLite is to open a database that others may be working on, and leave no trace."""

from pathlib import Path
from urllib.parse import quote


def readonly(database: Path) -> str:
    """Its address for `sqlite3.connect(..., uri=True)`.

    Without a write-ahead log nobody has it open: it is read as a file that does not change, for otherwise SQLite would
    leave a log that belongs to whoever reads, and the server could not open it.
    """
    still = "" if database.with_name(f"{database.name}-wal").exists() else "&immutable=1"
    return f"file:{quote(str(database.resolve()))}?mode=ro{still}"

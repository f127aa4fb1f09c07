"""As CSV: every number by the shortest digits that read back to it; nothing where there is no value."""

from pathlib import Path

import pyarrow.csv as pacsv

from fullpose_server.formats.exporters.arrow import arrow_table
from fullpose_server.formats.exporters.table import ExportTable


def write(table: ExportTable, target: Path) -> None:
    """Write it."""
    pacsv.write_csv(arrow_table(table), target)

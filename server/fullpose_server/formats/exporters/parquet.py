"""As Parquet; what is known of the table is in the file's own metadata."""

from pathlib import Path

import pyarrow.parquet as pq

from fullpose_server.formats.exporters.arrow import arrow_table
from fullpose_server.formats.exporters.table import ExportTable


def write(table: ExportTable, target: Path) -> None:
    """Write it."""
    pq.write_table(arrow_table(table).replace_schema_metadata(dict(table.facts)), target)

"""An exported table as Arrow has it: what is not a number is null."""

import pyarrow as pa

from fullpose_server.formats.exporters.table import ExportTable


def arrow_table(table: ExportTable) -> pa.Table:
    """One column a column."""
    return pa.table({name: pa.array(values, from_pandas=True) for name, values in table.columns.items()})

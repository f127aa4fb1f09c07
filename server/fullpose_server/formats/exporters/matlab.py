"""As a MAT-file of version 5: each column a variable (n, 1) by its name, and a structure `about` with what is known."""

from pathlib import Path

import numpy as np
from scipy.io import savemat

from fullpose_server.formats.exporters.table import ExportTable, Values


def write(table: ExportTable, target: Path) -> None:
    """Write it."""
    variables: dict[str, object] = {name: _variable(values) for name, values in table.columns.items()}
    variables["about"] = {"what": table.name, **table.facts}
    savemat(str(target), variables, appendmat=False, oned_as="column", long_field_names=True, do_compression=True)


def _variable(values: Values) -> Values:
    """Text as a cell array."""
    return values.astype(object) if values.dtype.kind in "UO" else np.ascontiguousarray(values)

"""As TDMS (LabVIEW, VeriStand, DIAdem): a channel a column in one group, its unit where those programs look for it."""

from pathlib import Path

import numpy as np
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

from fullpose_server.formats.exporters.table import ExportTable, Values, unit_of


def write(table: ExportTable, target: Path) -> None:
    """Write it; what is known of the table is the file's properties."""
    with TdmsWriter(str(target)) as writer:
        writer.write_segment(
            [
                RootObject(properties={"name": table.name, **table.facts}),
                GroupObject(table.name),
                *(
                    ChannelObject(table.name, name, _data(values), _properties(name))
                    for name, values in table.columns.items()
                ),
            ]
        )


def _properties(name: str) -> dict[str, str]:
    unit = unit_of(name)
    return {"unit_string": unit} if unit else {}


def _data(values: Values) -> Values | list[str]:
    return [str(cell) for cell in values.tolist()] if values.dtype.kind in "UO" else np.ascontiguousarray(values)

"""Writing the solved angles: CSV at 17 significant digits, or what else the name ends in."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fullpose.solution import Solution
from fullpose_server.formats.exporters.registry import ExportKind, exporter_of, write_table
from fullpose_server.formats.exporters.table import ExportTable, Values, motion_of
from fullpose_server.formats.output_file import replacing

COLUMNS = ("time_s", "base_deg", "outer_deg", "middle_deg", "inner_deg", "error_deg", "limited")
_ROW = "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d\n"
_CHUNK = 4096


def write_solution(path: Path, solution: Solution, progress: Callable[[int, int], None] | None = None) -> None:
    """Write one row a sample; CSV where the name has the ending of no other kind. Raises `FileError`."""
    row = exporter_of(path)
    with replacing(path) as draft:
        if row is None or row.kind is ExportKind.CSV:
            _write_csv(draft, solution, progress)
        else:
            write_table(solution_table(solution), draft, row.kind, str(path))


def solution_table(solution: Solution) -> ExportTable:
    """The columns of `fullpose solve --out`, one row an input row."""
    position = np.rad2deg(solution.angles)
    values = [solution.time, *position.T, np.rad2deg(solution.error), (solution.limited > 0).astype(np.int8)]
    columns: dict[str, Values] = {name: np.ascontiguousarray(each) for name, each in zip(COLUMNS, values, strict=True)}
    facts = {"rig": solution.rig.name, "method": solution.method}
    return ExportTable("solution", columns, facts, lambda: motion_of(solution.time, position))


def _write_csv(path: Path, solution: Solution, progress: Callable[[int, int], None] | None) -> None:
    n = solution.time.size
    with path.open("w", encoding="ascii", newline="") as stream:
        stream.write(",".join(COLUMNS) + "\n")
        for begin in range(0, n, _CHUNK):
            part = slice(begin, min(begin + _CHUNK, n))
            rows = np.column_stack(
                [
                    solution.time[part],
                    np.rad2deg(solution.angles[part]),
                    np.rad2deg(solution.error[part]),
                    solution.limited[part] > 0,
                ]
            )
            stream.write(_ROW * len(rows) % tuple(rows.ravel().tolist()))
            if progress is not None:
                progress(part.stop, n)

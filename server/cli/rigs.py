"""`fullpose rigs`: the built-in rigs and their limits."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from server.store.rig_file import RigEntry


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("rigs", help="List the built-in rigs, or check a rig file.")(rigs)


def rigs(file: Annotated[Path | None, typer.Argument(metavar="[FILE]", help="A rig file to check.")] = None) -> None:
    """Print rigs as a table."""
    from server.store.rig_file import Payload, RigEntry, read_rig
    from solver.rig import builtin_rigs

    if file is not None:
        entries = [read_rig(file)]
    else:
        entries = [RigEntry(rig, Payload(), builtin=True) for rig in builtin_rigs().values()]
    for entry in entries:
        typer.echo(_table(entry))


def _table(entry: "RigEntry") -> str:
    import math

    from solver.rig import FRAMES

    def deg(value: float) -> str:
        return f"{math.degrees(value):.6g}" if math.isfinite(value) else "-"

    axes = " ".join("xyz"[axis] for axis in entry.rig.geometry.axes if axis >= 0)
    lines = [f"{entry.rig.name}: {entry.rig.geometry} (axes {axes})"]
    for index in entry.rig.geometry.frames:
        frame = entry.rig.frames[index]
        span = "continuous" if frame.continuous else f"{deg(frame.min)}..{deg(frame.max)} deg"
        lines.append(
            f"  {FRAMES[index]:<7} {span:<18} {deg(frame.max_rate):>6} deg/s {deg(frame.max_acceleration):>7} deg/s^2"
        )
    return "\n".join(lines)

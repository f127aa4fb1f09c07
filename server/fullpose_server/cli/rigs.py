"""`fullpose rigs`: the built-in rigs and their limits; one of them as a rig file; a rig file checked."""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fullpose_server.formats.rig_file import RigEntry


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("rigs", help="List the built-in rigs, print one as a rig file, or check a rig file.")(rigs)


def rigs(
    rig: Annotated[
        str | None, typer.Argument(metavar="NAME|FILE", help="A built-in rig to print, or a rig file to check.")
    ] = None,
) -> None:
    """Print rigs as a table, or one as TOML."""
    from fullpose.rig import builtin_rigs
    from fullpose_server.formats.rig_file import Payload, RigEntry, find_rig

    if rig is None:
        for known in builtin_rigs().values():
            typer.echo(_table(RigEntry(known, Payload(), builtin=True)))
        return
    entry = find_rig(rig)
    if entry.builtin:
        from fullpose_server.formats.rig_toml import rig_toml

        typer.echo(rig_toml(entry.rig), nl=False)
        return
    _check_drive(rig, entry)
    typer.echo(_table(entry))
    typer.echo(f"  drive   {entry.operating.drive}")


def _check_drive(file: str, entry: "RigEntry") -> None:
    """Raise `FileError` where the drive is not there, or does not take its options. Nothing is connected."""
    from fullpose_server.cli._configuration import configured
    from fullpose_server.drives import registry
    from fullpose_server.drives.base import DriveError
    from fullpose_server.errors import FileError

    operating = entry.operating
    rate_hz = configured().settings.rig_rate_hz
    try:
        registry.make(operating.drive, entry.rig, rate_hz, operating.drive_options)
    except DriveError as cause:
        value = repr({"name": operating.drive} | operating.drive_options)
        expected = f"a drive that is installed, and options that it takes ({cause})"
        raise FileError(file, expected, column="drive", value=value, column_word="key") from None


def _table(entry: "RigEntry") -> str:
    import math

    from fullpose.rig import FRAMES

    def deg(value: float) -> str:
        return f"{math.degrees(value):.6g}" if math.isfinite(value) else "-"

    axes = " ".join("xyz"[axis] for axis in entry.rig.geometry.axes if axis >= 0)
    lines = [f"{entry.rig.name}: {entry.rig.geometry} (axes {axes})"]
    for index in entry.rig.geometry.frames:
        frame = entry.rig.frames[index]
        span = "continuous" if frame.continuous else f"{deg(frame.min)}..{deg(frame.max)} deg"
        jerk = f" {deg(frame.max_jerk):>8} deg/s^3" if math.isfinite(frame.max_jerk) else ""
        lines.append(
            f"  {FRAMES[index]:<7} {span:<18} {deg(frame.max_rate):>6} deg/s {deg(frame.max_acceleration):>7} deg/s^2"
            f"{jerk}"
        )
    return "\n".join(lines)

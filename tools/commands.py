"""Writes docs/guide/commands.md: every command in every state. Run: python -m tools.commands"""

from pathlib import Path

from fullpose_server.session.states import NEEDS_NO_LEASE, Command, State
from fullpose_server.session.table import TABLE, allowed

PAGE = Path(__file__).parents[1] / "docs" / "guide" / "commands.md"
HEAD = """# Every command in every state

Generated from `server/fullpose_server/session/table.py` by `python -m tools.commands`: do not edit. A cell is the state
that the command leads to (200), or 409: refused, and nothing has changed; the problem names the state and what is
allowed. A command without the lease is refused with 403 before, but for {free}. A rig that no process runs for is
disconnected.
"""


def cell(command: Command, state: State) -> str:
    """What comes of a command in a state."""
    if (command, state) == (Command.ESTOP, State.ESTOPPED):
        return str(state)  # no E-stop is refused: asked for again, it is answered again
    if command not in allowed(state):
        return "409"
    rows = [row for row in TABLE if row.trigger == command and state in row.sources]
    return " / ".join(f"{row.target} [{row.when}]" if row.when else str(row.target) for row in rows) or str(state)


def page() -> str:
    """The whole page."""
    lines = [HEAD.format(free=" and ".join(sorted(NEEDS_NO_LEASE)))]
    lines += ["| command | " + " | ".join(State) + " |", "|---" * (len(State) + 1) + "|"]
    lines += [
        "| " + " | ".join([f"**{command}**", *(cell(command, state) for state in State)]) + " |" for command in Command
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()

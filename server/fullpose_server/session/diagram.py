"""The session's Mermaid diagram and command table, generated from `table.TABLE` into docs/guide/session.md.

`python -m fullpose_server.session.diagram FILE` rewrites the generated part of FILE; a test holds the two together.
"""

import sys
from pathlib import Path

from fullpose_server.session.states import Event, State
from fullpose_server.session.table import ANY, TABLE, Transition, allowed

BEGIN = "<!-- generated from server/fullpose_server/session/table.py: do not edit -->"
END = "<!-- end of generated part -->"


def _label(row: Transition) -> str:
    trigger = f"({row.trigger})" if isinstance(row.trigger, Event) else str(row.trigger)
    # A colon inside a label ends it for Mermaid's parser.
    trigger = trigger.replace(": ", " ")
    return f"{trigger} [{row.when}]" if row.when else trigger


def mermaid() -> str:
    """The diagram. Rows that start in almost every state are drawn from one node, `any`."""
    lines = ["stateDiagram-v2", "    [*] --> disconnected"]
    arrows: dict[tuple[str, str], list[str]] = {}
    for row in TABLE:
        wide = len(row.sources) >= len(ANY) - 3
        sources = ["any"] if wide else [s for s in State if s in row.sources]
        for source in sources:
            arrows.setdefault((source, row.target), []).append(_label(row))
    lines += [f"    {source} --> {target}: {' / '.join(labels)}" for (source, target), labels in arrows.items()]
    return "\n".join(lines)


def command_table() -> str:
    """Which commands each state accepts."""
    lines = ["| state | commands |", "|---|---|"]
    lines += [f"| {state} | {', '.join(allowed(state))} |" for state in State]
    return "\n".join(lines)


def order_table() -> str:
    """Every row, with what is ordered."""
    lines = ["| from | on | to | orders |", "|---|---|---|---|"]
    for row in TABLE:
        missing = [s for s in State if s not in row.sources]
        names = ", ".join(s for s in State if s in row.sources)
        if len(missing) <= 3:
            names = "any but " + ", ".join(missing) if missing else "any"
        lines.append(f"| {names} | {_label(row)} | {row.target} | {', '.join(row.actions)} |")
    return "\n".join(lines)


def generated() -> str:
    """The whole generated part, markers included."""
    return "\n\n".join([BEGIN, f"```mermaid\n{mermaid()}\n```", order_table(), command_table(), END])


def rewrite(text: str) -> str:
    """`text` with its generated part replaced. Raises ValueError where the markers are missing."""
    head, begin, rest = text.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise ValueError("no markers of the generated part")
    return head + generated() + tail


if __name__ == "__main__":
    page = Path(sys.argv[1])
    page.write_text(rewrite(page.read_text("utf-8")), "utf-8")

"""The channels of a record and the JSON schema of each, which the file carries."""

from typing import Any

import msgspec
from mcap.writer import Writer

from fullpose_server.runtime.contract.telemetry import FIELDS
from fullpose_server.session.states import STATES

TELEMETRY, EVENTS, STATISTICS = "/telemetry", "/events", "/statistics"
# One plain type a field, and no null: Foxglove and Lichtblick refuse a channel whose schema has more than they know.
# What is not a number, or has no value, is left out of its message.
_NUMBER, _INTEGER, _STRING, _TRUTH = ({"type": kind} for kind in ("number", "integer", "string", "boolean"))


def _sample_schema() -> dict[str, Any]:
    """Of a telemetry message: `FIELDS`, the state by name."""
    properties: dict[str, Any] = {}
    for field in FIELDS:
        kind = _INTEGER if field.integer else _NUMBER
        properties[field.name] = {"type": "array", "items": kind} if field.parts else kind
    properties["state"] = _STRING | {"enum": list(STATES)}
    return {"title": "fullpose.Sample", "type": "object", "properties": properties}


# Of the events of every kind: commands, transitions, alarms, runs.
_EVENT_SCHEMA = {
    "title": "fullpose.Event",
    "type": "object",
    "properties": {
        **dict.fromkeys(
            ("kind", "who", "command", "before", "after", "refused", "trigger", "run_id", "rig", "state"), _STRING
        ),
        **dict.fromkeys(("code", "severity", "message", "frame", "unit"), _STRING),
        **dict.fromkeys(("time_ns", "wall_ns", "epoch", "head", "number", "count", "pid"), _INTEGER),
        **dict.fromkeys(("value", "limit", "time_s"), _NUMBER),
        "first": _TRUTH,
    },
}
_STATISTICS_SCHEMA = {
    "title": "fullpose.LoopStatistics",
    "type": "object",
    "properties": {
        "ticks": _INTEGER,
        "deadline_misses": _INTEGER,
        "busy_us": _NUMBER,
        "lateness_us": {"type": "object", "properties": dict.fromkeys(("p50", "p99", "p999", "max"), _NUMBER)},
        "free_bytes": _INTEGER,
    },
}
SCHEMAS: dict[str, dict[str, Any]] = {
    TELEMETRY: _sample_schema(),
    EVENTS: _EVENT_SCHEMA,
    STATISTICS: _STATISTICS_SCHEMA,
}  # by topic


def register(writer: Writer, topic: str) -> int:
    """Register the channel `topic` with its schema in the file; returns the channel's number."""
    schema = SCHEMAS[topic]
    number = writer.register_schema(str(schema["title"]), "jsonschema", msgspec.json.encode(schema))
    return int(writer.register_channel(topic, "json", number))

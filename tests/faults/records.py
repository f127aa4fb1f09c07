"""What a record holds, read by the library's own reader. Imported as `tests.faults.records`."""

from pathlib import Path


def messages(path: Path) -> list[int]:
    """Sequences of the telemetry that can be read from a file, whole or cut off."""
    from fullpose_server.runtime.recording.mcap_reader import recover_messages

    return [m.sequence for topic, m in recover_messages(path) if topic == "/telemetry"]

"""Where the API is, and which requests are a rig's: what the server, the stop gate and the contract agree on."""

API = "/api/v1"
STOP_CHANNEL = "/stop"  # below API: the WebSocket of stop and E-stop
_RIGS = f"{API}/rigs/"


def of_rig(path: str) -> tuple[str, str] | None:
    """(rig, word) of a path /rigs/{rig}/{word} below the API; None of any other."""
    rig, parted, word = path.removeprefix(_RIGS).partition("/")
    return (rig, word) if path.startswith(_RIGS) and parted and "/" not in word else None

"""Where the API is: what the server, the stop gate and the contract agree on."""

API = "/api/v1"
STOP_CHANNEL = "/stop"  # below API: the WebSocket of stop and E-stop

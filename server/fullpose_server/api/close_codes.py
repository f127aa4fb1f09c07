"""What a WebSocket is closed with before it is accepted: a browser is told no more than that."""

UNKNOWN = 4401  # sign in first
FORBIDDEN = 4403  # not from this page, or not with this role

"""Secrets of the server's making: told once, to whom they are for, and kept nowhere."""

import hashlib
import secrets


def new_secret(prefix: str = "") -> str:
    """256 random bits, as text that a header or an address may carry."""
    return prefix + secrets.token_urlsafe(32)


def proof_of(secret: str) -> str:
    """What is kept of a secret: its sha-256, for a secret is as random as that. Passwords are another matter."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()

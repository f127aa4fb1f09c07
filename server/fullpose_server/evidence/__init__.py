"""Evidence of a run: one signed file with everything that it was, which anybody can verify without the server."""

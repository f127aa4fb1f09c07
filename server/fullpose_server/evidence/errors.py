"""What is wrong with a bundle, or why there can be none."""

from pathlib import Path

from fullpose_server.errors import ServerError


class BundleError(ServerError):
    """A file that is no sound bundle: which, and what is wrong with it."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.problem = problem


class NoEvidenceError(ServerError):
    """A run that there can be no evidence of, or not yet."""

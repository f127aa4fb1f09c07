"""The process that makes a run's evidence: `python -m fullpose_server.api.offload.evidence_worker`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fullpose_server.planning.worker import Maker, Progress, serve


def main() -> None:
    """Answer requests until stdin ends."""

    def load() -> Mapping[str, Maker]:
        from fullpose_server.api.offload.evidence import KIND

        return {KIND: _made}

    serve(load, _failure)


def _made(asked: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    from fullpose_server.evidence.bundle import make_bundle
    from fullpose_server.location import PostgresqlUrl

    url = asked["database"]
    database = None if url is None else PostgresqlUrl.of(url)
    make_bundle(Path(asked["folder"]), asked["run"], Path(asked["target"]), database)
    return {}


def _failure(error: Exception) -> dict[str, Any]:
    from fullpose_server.api.known_errors import known_problem
    from fullpose_server.api.problems import ApiError
    from fullpose_server.evidence.errors import NoEvidenceError

    if isinstance(error, NoEvidenceError):
        error = ApiError(409, "in-use", str(error))
    problem = known_problem(error)
    if problem is None:  # for the server to log
        return {"unexpected": f"{type(error).__name__}: {error}"}
    return problem.model_dump(mode="json")


if __name__ == "__main__":
    main()

"""The process that makes curves of a run: `python -m fullpose_server.api.offload.curves_worker`."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from fullpose_server.planning.worker import Maker, Progress, serve

_PARTS = 1000


def main() -> None:
    """Answer requests until stdin ends."""

    def load() -> Mapping[str, Maker]:
        from fullpose_server.api.offload.curves import KIND, KIND_AGAINST

        return {KIND: _made, KIND_AGAINST: _made_against}

    serve(load, _failure)


def _made(asked: Mapping[str, Any], progress: Progress) -> dict[str, Any]:
    from fullpose_server.runtime.recording.curves import make_curves

    make_curves(Path(asked["record"]), Path(asked["target"]), _from(progress, 0.0, 1.0))
    return {}


def _made_against(asked: Mapping[str, Any], progress: Progress) -> dict[str, Any]:
    from fullpose_server.formats.plan_folder import read_plan
    from fullpose_server.runtime.recording.against import Aligned, has_flight_time, make_difference, of_plan, of_run

    record, target, other = (Path(asked[key]) for key in ("record", "target", "reference"))
    target.parent.mkdir(parents=True, exist_ok=True)
    # Beside the target: a folder for passing things may be in memory.
    with tempfile.TemporaryDirectory(prefix=".reference.", dir=target.parent) as folder:
        aligned: Aligned = "flight"
        if asked["kind"] == "plan":
            reference = of_plan(read_plan(other), Path(folder))
        else:
            if not (has_flight_time(record) and has_flight_time(other)):
                aligned = "run"
            reference = of_run(other, aligned, Path(folder), _from(progress, 0.0, 0.5))
        make_difference(record, reference, aligned, asked["made_of"], target, _from(progress, 0.5, 1.0))
    return {}


def _from(progress: Progress, begin: float, end: float) -> Callable[[float], None]:
    return lambda part: progress("curves", round(_PARTS * (begin + (end - begin) * part)), _PARTS)


def _failure(error: Exception) -> dict[str, Any]:
    from fullpose_server.api.known_errors import known_problem
    from fullpose_server.errors import FileError
    from fullpose_server.runtime.recording.mcap_reader import RecordError

    if isinstance(error, RecordError):
        error = FileError(error.path.name, f"a record ({error.why})")
    problem = known_problem(error)
    if problem is None:  # for the server to log
        return {"unexpected": f"{type(error).__name__}: {error}"}
    return problem.model_dump(mode="json")


if __name__ == "__main__":
    main()

"""Solving without a session: POST /solve for a batch, the WebSocket /solve for a stream."""

import asyncio
import time
from collections.abc import Mapping
from typing import Any

import numpy as np
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from pydantic import TypeAdapter, ValidationError

from fullpose.errors import InputError, SolverError
from fullpose.flight import bad_time, check_flight
from fullpose.methods.base import Stepper
from fullpose.registry import find_step, method_options
from fullpose.rig import Rig
from fullpose.solve import solve
from fullpose.verify import attitude_errors, payload_attitudes, verify
from fullpose_server.api.attitudes import attitudes, limited_list
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.errors import ApiError, problem_of
from fullpose_server.api.schemas.plans import ReportOut
from fullpose_server.api.schemas.solve import (
    Opened,
    OpenSolve,
    Solved,
    SolveIn,
    SolveMessageIn,
    SolveOut,
    SolveProblem,
    SolveSamples,
)
from fullpose_server.errors import ServerError
from fullpose_server.formats.report import make_report
from fullpose_server.formats.start_pose import start_pose

router = APIRouter(tags=["solve"])
_INCOMING: TypeAdapter[SolveMessageIn] = TypeAdapter(SolveMessageIn)
SMALL = 64  # samples that are solved in the event loop itself: a thread's hand-over would take longer


@router.post("/solve")
async def solve_batch(body: SolveIn, services: ServicesDep) -> SolveOut:
    """A batch of attitudes in, frame angles and errors out; no session needed."""
    most = services.settings.max_solve_samples
    if len(body.time_s) > most:
        raise ApiError(413, "too-large", f"{len(body.time_s)} samples: this server solves up to {most} at once")
    entry = await asyncio.to_thread(services.rigs.get, body.rig)
    return await asyncio.to_thread(_solve, body, entry.rig)


def _solve(body: SolveIn, rig: Rig) -> SolveOut:
    at, C = attitudes(body)
    solution = solve(
        at,
        C,
        rig,
        method=body.method,
        options=method_options(body.method, dict(body.options)),
        start=None if body.start_deg is None else np.array(start_pose(body.start_deg, rig, "start_deg")),
        clock=time.perf_counter,
    )
    report = make_report(solution, verify(at, solution.angles, rig, C))
    return SolveOut.model_construct(
        time_s=body.time_s,
        angles_deg=[tuple(row) for row in np.rad2deg(solution.angles).tolist()],
        error_deg=np.rad2deg(solution.error).tolist(),
        limited=limited_list(solution.limited),
        report=ReportOut(**report),
    )


@router.websocket("/solve")
async def solve_stream(socket: WebSocket, services: ServicesDep) -> None:
    """`open` names rig and method; each `samples` is answered by a `solved` with the same number of rows.

    What a client did wrong is answered by a problem and changes nothing; after a fault of the server's own the problem
    is followed by a close, because the flight's state is not known any more.
    """
    await socket.accept()
    flight: _Flight | None = None
    try:
        while True:
            frame = await socket.receive()
            if frame["type"] == "websocket.disconnect":
                return
            try:
                message = _parsed(frame)
                if isinstance(message, OpenSolve):
                    flight = await asyncio.to_thread(_Flight, services, message)
                    answer: Any = Opened(rig=message.rig, method=message.method)
                elif flight is None:
                    raise ApiError(422, "not-open", "expected an open message before samples")
                elif len(message.time_s) <= SMALL:
                    answer = flight.solve(message)
                else:
                    answer = await asyncio.to_thread(flight.solve, message)
            except (ApiError, SolverError, ServerError, ValidationError) as error:
                answer = SolveProblem(problem=problem_of(error))
            except Exception as error:  # noqa: BLE001 - logged by problem_of; the client is not left without an answer
                await socket.send_text(SolveProblem(problem=problem_of(error)).model_dump_json())
                await socket.close(1011, "an error of the server")
                return
            await socket.send_text(answer.model_dump_json())
    except WebSocketDisconnect:
        return


def _parsed(frame: Mapping[str, Any]) -> OpenSolve | SolveSamples:
    """The message of a text frame. Raises `ApiError` for a binary frame, `ValidationError`."""
    text = frame.get("text")
    if text is None:
        raise ApiError(422, "validation", "expected a JSON message in a text frame, this one is binary")
    return _INCOMING.validate_json(text)  # not json.loads: it gives up on deep nesting and long numbers in other ways


class _Flight:
    """A flight in progress on one connection. A message that is refused leaves it as it was."""

    def __init__(self, services: Services, message: OpenSolve) -> None:
        self._rig = services.rigs.get(message.rig).rig
        self._most = services.settings.max_solve_samples
        self._method = find_step(message.method)
        options = method_options(message.method, dict(message.options))
        self._options = self._method.options() if options is None else options
        given = message.start_deg
        self._start = None if given is None else np.array(start_pose(given, self._rig, "start_deg"))
        self._stepper: Stepper | None = None
        self._last: float | None = None

    def solve(self, message: SolveSamples) -> Solved:
        """Angles and errors of the next samples."""
        if len(message.time_s) > self._most:
            raise ApiError(413, "too-large", f"{len(message.time_s)} samples in one message, at most {self._most}")
        at, C = check_flight(*attitudes(message))
        if found := bad_time(at, self._last):
            raise InputError("time_s", found[0], float(at[found[0]]), found[1])
        if self._stepper is None:
            self._stepper = self._method.stepper(self._rig, self._options, self._start, C[0])
        block = self._stepper.block(at, C)
        self._last = float(at[-1])
        error, _ = attitude_errors(payload_attitudes(self._rig, block.angles), C)
        return Solved.model_construct(
            time_s=message.time_s,
            angles_deg=[tuple(row) for row in np.rad2deg(block.angles).tolist()],
            error_deg=np.rad2deg(error).tolist(),
            limited=limited_list(block.limited),
        )

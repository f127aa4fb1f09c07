"""Solving without a session: POST /solve for a batch, the WebSocket /solve for a stream."""

import asyncio
from uuid import uuid4

import numpy as np
from fastapi import APIRouter, Request, WebSocket
from pydantic import TypeAdapter, ValidationError
from starlette.responses import FileResponse

from fullpose.errors import InputError, SolverError
from fullpose.flight import bad_time, check_flight
from fullpose.methods.base import Stepper
from fullpose.registry import find_step, method_options
from fullpose.verify import attitude_errors, payload_attitudes
from fullpose_server.api.answer_file import answered
from fullpose_server.api.attitudes import attitudes, limited_list
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.errors import problem_of
from fullpose_server.api.offload.work import SolveRequest, Work
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.solve import (
    Opened,
    OpenSolve,
    Solved,
    SolveMessageIn,
    SolveOut,
    SolveProblem,
    SolveSamples,
)
from fullpose_server.api.streams.tasks import NOT_TEXT, UNSUPPORTED, GoneError, close_for, send_text
from fullpose_server.api.uploads import receive_body
from fullpose_server.errors import ServerError
from fullpose_server.formats.start_pose import start_pose

router = APIRouter(tags=["solve"])
# Characters of a message of samples that the event loop itself answers, some thirty of them: a millisecond.
QUICK = 4096
_INCOMING: TypeAdapter[SolveMessageIn] = TypeAdapter(SolveMessageIn)
_BODY = {"required": True, "content": {"application/json": {"schema": {"$ref": "#/components/schemas/SolveIn"}}}}


@router.post(
    "/solve",
    response_model=SolveOut,
    openapi_extra={"requestBody": _BODY},
    responses=BUSY,
)
async def solve_batch(request: Request, services: ServicesDep) -> FileResponse:
    """A batch of attitudes in, frame angles and errors out; no session needed."""
    body, answer = (services.uploads / uuid4().hex for _ in range(2))
    try:
        await receive_body(request, body, services.settings.max_json_bytes)
        asked = SolveRequest(str(body), str(answer), str(services.rigs.folder), services.settings.max_solve_samples)
        return await answered(services, Work.SOLVE, asked, answer)
    finally:
        body.unlink(missing_ok=True)


@router.websocket("/solve")
async def solve_stream(socket: WebSocket, services: ServicesDep) -> None:
    """`open` names rig and method; each `samples` is answered by a `solved` with the same number of rows.

    What a client did wrong is answered by a problem and changes nothing; after a fault of the server's own the problem
    is followed by a close, because the flight's state is not known any more.
    """
    await socket.accept()
    conversation = _Conversation(services)
    try:
        while (frame := await socket.receive())["type"] != "websocket.disconnect":
            text = frame.get("text")
            if text is None:
                await close_for(socket, SolveProblem(problem=NOT_TEXT.problem).model_dump_json(), UNSUPPORTED)
                return
            quick = conversation.is_quick(text)
            answer = conversation.answer(text) if quick else await asyncio.to_thread(conversation.answer, text)
            await send_text(socket, answer)
    except GoneError:
        return
    except Exception as error:  # noqa: BLE001 - logged by problem_of; the client is not left without an answer
        await close_for(socket, SolveProblem(problem=problem_of(error)).model_dump_json())


class _Conversation:
    """One connection, one message after another."""

    def __init__(self, services: Services) -> None:
        self._services = services
        self._flight: _Flight | None = None

    def is_quick(self, text: str) -> bool:
        """Whether the answer is had sooner than a thread: a few more samples of a flight whose kernels are compiled."""
        if self._flight is None or not self._flight.begun:
            return False
        return len(text) <= QUICK and '"open"' not in text  # which reads a rig's file

    def answer(self, text: str) -> str:
        """The answer to a message, encoded; what the client did wrong is one too."""
        try:
            # Not json.loads: it gives up on deep nesting and long numbers in other ways.
            return self._answer(_INCOMING.validate_json(text)).model_dump_json()
        except (ApiError, SolverError, ServerError, ValidationError) as error:
            return SolveProblem(problem=problem_of(error)).model_dump_json()

    def _answer(self, message: OpenSolve | SolveSamples) -> Opened | Solved:
        if isinstance(message, OpenSolve):
            self._flight = _Flight(self._services, message)
            return Opened(rig=message.rig, method=message.method)
        if self._flight is None:
            raise ApiError(422, "not-open", "expected an open message before samples")
        return self._flight.solve(message)


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
        self._begun = False
        self._last: float | None = None

    @property
    def begun(self) -> bool:
        """Whether a block of it is solved: until then a kernel may have to be compiled, which takes seconds."""
        return self._begun

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
        self._begun = True
        return Solved.model_construct(
            time_s=message.time_s,
            angles_deg=[tuple(row) for row in np.rad2deg(block.angles).tolist()],
            error_deg=np.rad2deg(error).tolist(),
            limited=limited_list(block.limited),
        )

"""One client of the stop channel: nothing it sends waits for the answer to what it sent before."""

import time
from collections.abc import Callable, Coroutine
from typing import Any

from pydantic import TypeAdapter, ValidationError
from starlette.websockets import WebSocket

from fullpose_server.api.problems import ApiError, validation_problem
from fullpose_server.api.schemas.base import Problem, Wire
from fullpose_server.api.schemas.stop import RigStopped, StopIn, StopRefused, StopRig
from fullpose_server.api.schemas.stream import Ping, Pong
from fullpose_server.api.stopping import answer, who_stops
from fullpose_server.api.streams.tasks import NOT_TEXT, Tasks, close_for, send_text
from fullpose_server.runtime.contract.messages import Reply
from fullpose_server.session.states import Command

# Who is at the other end, asked before each order; None: nobody known, and nobody need be. Raises `ApiError`.
Known = Callable[[], str | None]
# The order stands when it returns; the coroutine, which is to be awaited, waits for the reply and audits it.
Stop = Callable[[str, Command, str, str | None], Coroutine[Any, Any, Reply]]
_INCOMING: TypeAdapter[StopIn] = TypeAdapter(StopIn)


class StopChannel:
    """Talks with one client until it leaves. `given` is the name that it came with."""

    def __init__(self, socket: WebSocket, stop: Stop, given: str | None, known: Known) -> None:
        self._socket = socket
        self._stop = stop
        self._given = given
        self._known = known
        self._answers = Tasks(self._failed)

    async def run(self) -> None:
        """Every stop that was asked for is done and audited, whoever still listens."""
        await self._socket.accept()
        try:
            while (frame := await self._socket.receive())["type"] != "websocket.disconnect":
                self._take(frame.get("text"))
        finally:
            await self._answers.finished()

    def _take(self, text: str | None) -> None:
        try:
            if text is None:
                raise NOT_TEXT  # told, and the channel stays: it may be needed next
            message = _INCOMING.validate_json(text)
        except ValidationError as error:
            self._say(StopRefused(problem=validation_problem(error.errors())))
        except ApiError as error:
            self._say(StopRefused(problem=error.problem))
        else:
            if isinstance(message, Ping):
                self._say(Pong(t=message.t, server_time=time.time()))
            else:
                self._ask(message)

    def _ask(self, asked: StopRig) -> None:
        try:
            known = self._known()
        except ApiError as error:
            self._say(StopRefused(id=asked.id, problem=error.problem))
        else:
            self._order(asked, known)

    def _order(self, asked: StopRig, known: str | None) -> None:
        address = None if self._socket.client is None else self._socket.client.host
        who = known or who_stops(asked.client or self._given, address)
        done = self._stop(asked.rig, Command(asked.type), who, address)

        async def answered() -> None:
            await send_text(self._socket, (await self._answer(asked, done)).model_dump_json())

        self._answers.start(answered, f"answer to {asked.type}")

    async def _answer(self, asked: StopRig, done: Coroutine[Any, Any, Reply]) -> Wire:
        try:
            return RigStopped(id=asked.id, rig=asked.rig, done=answer(asked.type, await done))
        except ApiError as error:
            return StopRefused(id=asked.id, problem=error.problem)

    def _say(self, message: Wire) -> None:
        self._answers.start(lambda: send_text(self._socket, message.model_dump_json()), "answer")

    async def _failed(self, error: Exception) -> None:
        problem: Problem = ApiError(500, "internal", f"an error of the server: {type(error).__name__}").problem
        await close_for(self._socket, StopRefused(problem=problem).model_dump_json())

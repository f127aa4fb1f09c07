"""The WebSocket /stop, as the stop gate serves it: here for a server that runs without one."""

from collections.abc import Coroutine
from typing import Any

from fastapi import APIRouter, WebSocket

from fullpose_server.api.commanding import by_priority
from fullpose_server.api.deps import PersonDep, ServicesDep
from fullpose_server.api.paths import STOP_CHANNEL
from fullpose_server.api.stopping import CLIENT_HEADER
from fullpose_server.api.streams.stop_channel import StopChannel
from fullpose_server.runtime.contract.messages import Reply
from fullpose_server.session.states import Command

router = APIRouter(tags=["session"])


@router.websocket(STOP_CHANNEL)
async def stop_channel(socket: WebSocket, services: ServicesDep, person: PersonDep) -> None:
    """Stops and E-stops of every rig, and pings."""

    def stop(rig: str, command: Command, who: str, address: str | None) -> Coroutine[Any, Any, Reply]:
        return by_priority(services, rig, command, who, address)

    known = None if person is None else person.who  # a channel ends with its person's session
    await StopChannel(socket, stop, socket.headers.get(CLIENT_HEADER), lambda: known).run()

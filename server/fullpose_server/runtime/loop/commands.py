"""The rig process's command handler: takes requests, checks them, has the session decide, and answers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from fullpose_server.drives.base import DriveError
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.live.steppers import LiveError
from fullpose_server.runtime.loop import orders
from fullpose_server.runtime.loop.orders import OrderError
from fullpose_server.session.errors import SessionError
from fullpose_server.session.machine import Binding
from fullpose_server.session.states import Action, Command, Event

if TYPE_CHECKING:
    from fullpose_server.formats.plan_folder import PlanFolder
    from fullpose_server.runtime.loop.control_loop import RigLoop

_MOVES = (Command.START, Command.MOVE, Command.HOME, Command.JOG)


class CommandHandler:
    """Answers for one loop."""

    def __init__(self, loop: RigLoop) -> None:
        self._loop = loop
        self.plan: PlanFolder | None = None

    def answer(self, request: messages.Request) -> messages.Answer:
        """The answer to `request`; a refusal is an answer too."""
        loop = self._loop
        before = loop.machine.state
        now = time.monotonic()
        lease = None
        error: messages.ErrorBody | None = None
        try:
            if request.op == "command":
                self._command(request, now)
            elif request.op == "lease":
                lease = loop.machine.lease_action(request.action, request.who, now, request.to)
            elif request.op == "exit":
                self._exit(request.who, now)
            else:
                raise OrderError("bad_request", f"no request {request.op!r}: command, lease, exit")
        except SessionError as refusal:
            allowed = [str(c) for c in loop.machine.allowed()]
            word = request.command or request.action or request.op
            error = messages.ErrorBody(refusal.code, str(refusal), loop.machine.state, word, allowed)
        if request.op == "command" or request.action != "renew":
            loop.log_event(
                "command",
                who=request.who,
                command=request.command or f"lease {request.action}",
                args=request.args,
                epoch=loop.machine.epoch,
                before=before,
                after=loop.machine.state,
                refused=None if error is None else error.code,
            )
        loop.publisher.publish()
        state = loop.machine.state
        reply = messages.Reply(error is None, before, state, loop.machine.revision, error)
        return messages.Answer(request.id, reply, lease)

    def by_priority(self, command: Command, who: str, now: float) -> None:
        """E-stop or stop from the priority channel: no lease, no reply; nothing where the state has no use for it."""
        loop = self._loop
        before = loop.machine.state
        refused = None
        try:
            actions = loop.machine.command(command, who, None, now)
        except SessionError as refusal:
            refused = refusal.code
        else:
            if command is Command.ESTOP:
                loop.estop_alarm(who)
            loop.do(actions)
        loop.log_event("command", who=who, command=command, before=before, after=loop.machine.state, refused=refused)

    def _exit(self, who: str, now: float) -> None:
        machine = self._loop.machine
        if machine.moving:
            self.by_priority(Command.ESTOP, who, now)
            raise OrderError("not_at_rest", "the rig was moving: E-stop given; ask again when it is at rest")
        self._loop.ending = True

    def _command(self, request: messages.Request, now: float) -> None:
        loop = self._loop
        try:
            command = Command(request.command)
        except ValueError:
            words = ", ".join(Command)
            raise OrderError("unknown_command", f"no command {request.command!r}: there are {words}") from None
        if command in (Command.STOP, Command.ESTOP):
            actions = loop.machine.command(command, request.who, None, now)
            if command is Command.ESTOP:
                loop.estop_alarm(request.who)
            loop.do(actions)
            return
        # Refused before anything is read or reached, and again below with what was read.
        loop.machine.check(command, request.who, request.lease, now)
        match command:
            case Command.CONNECT:
                self._connect(request, now)
            case Command.LOAD:
                self._load(request, now)
            case Command.ARM:
                self._arm(request, now)
            case _ if command in _MOVES:
                move = orders.move_of(command, request.args, loop.rig, loop.motion)
                self._decide(command, request, now)
                loop.motion.go(move, Event.AT_START if command is Command.START else Event.THERE)
                if command is Command.START:
                    loop.begin_run(request.who)
            case Command.GO_LIVE:
                orders.check_inside(loop.rig, loop.motion)
                self._decide(command, request, now)
                loop.begin_run(request.who)
            case Command.ACKNOWLEDGE:
                self._acknowledge(request, now)
            case _:
                self._decide(command, request, now)

    def _decide(
        self, command: Command, request: messages.Request, now: float, binding: Binding | None = None
    ) -> tuple[Action, ...]:
        actions = self._loop.machine.command(command, request.who, request.lease, now, binding=binding)
        self._loop.do(actions)
        return actions

    def _connect(self, request: messages.Request, now: float) -> None:
        loop = self._loop
        try:
            loop.drive.connect(now)
        except DriveError as cause:
            raise OrderError("drive_unreachable", str(cause)) from cause
        finally:
            loop.deadlines.restart()
        self._decide(Command.CONNECT, request, now)

    def _load(self, request: messages.Request, now: float) -> None:
        loop = self._loop
        load = orders.load_of(request.args, loop.config)
        if load.live is not None:
            try:
                loop.live.prepare(load.live)
            except LiveError as cause:
                raise OrderError("bad_arguments", str(cause)) from cause
        self._decide(Command.LOAD, request, now, load.binding)
        self.plan = load.plan
        if load.plan is not None:
            loop.motion.load(load.plan)
        loop.deadlines.restart()

    def _arm(self, request: messages.Request, now: float) -> None:
        loop = self._loop
        silent_s = now - int(loop.shared.header["recorder_beat_ns"][0]) / 1e9
        orders.check_record(loop.config.runs, loop.config.min_free_mb, silent_s)
        pair = orders.asked_pair(request.args, loop.machine.binding)
        loop.machine.check_pair(pair)
        # What came before in this very tick may have taken long (a load): the drive and we agree on the time again.
        loop.status = loop.drive.read(now, loop.measured, loop.measured_rate)
        try:
            loop.drive.enable()
        except DriveError as cause:
            raise OrderError("drive_refused", str(cause)) from cause
        self._decide(Command.ARM, request, now, pair)
        loop.hold_position(loop.measured)
        loop.enabled = True

    def _acknowledge(self, request: messages.Request, now: float) -> None:
        raw: Any = request.args.get("numbers")
        if raw is not None and not (isinstance(raw, list) and all(isinstance(n, int) for n in raw)):
            raise OrderError("bad_arguments", "numbers must be a list of alarm numbers, or left out for all")
        numbers = None if raw is None else frozenset(raw)
        self._loop.machine.command(Command.ACKNOWLEDGE, request.who, request.lease, now, alarms=numbers)

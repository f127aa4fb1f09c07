"""The rig process's command handler: prepare, decide, do.

What a request needs is read, checked and made ready first; then the session decides; then the executor does what it
ordered. A refusal changes nothing, wherever it comes from.
"""

from collections.abc import Callable
from typing import Protocol, TypeAlias

from fullpose_server.drives.base import DriveError
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.hung import recorder_ended
from fullpose_server.runtime.contract.messages import Op
from fullpose_server.runtime.live.provenance import digest_of
from fullpose_server.runtime.loop import orders
from fullpose_server.runtime.loop.clock import Deadlines, seconds
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.executor import Executor
from fullpose_server.runtime.loop.orders import Load, OrderError
from fullpose_server.runtime.loop.publisher import Publisher
from fullpose_server.runtime.motion.point_to_point import PointMove
from fullpose_server.session.actions import Given as GivenOf
from fullpose_server.session.alarms import Severity
from fullpose_server.session.errors import SessionError
from fullpose_server.session.lease import Lease, LeaseAction
from fullpose_server.session.run_end import Ending, RunEnd
from fullpose_server.session.states import Command, State

Given: TypeAlias = GivenOf[Load, PointMove]
_RECORDER_SILENT_S = 2.0  # a recorder that has not been heard for longer: no arming
_ESTOP = "estop"  # code of its alarm
_AT_ONCE = (Command.STOP, Command.ESTOP)  # need neither lease nor arguments


class Requests(Protocol):
    """Where commands come from."""

    def poll(self) -> None:
        """Have what is waiting answered, a little of it."""
        ...

    def close(self) -> None:
        """No more."""
        ...


Serve: TypeAlias = Callable[[Callable[[messages.Request], messages.Answer]], Requests]


class CommandHandler:
    """Answers for one rig."""

    def __init__(self, parts: Parts, executor: Executor, publisher: Publisher, deadlines: Deadlines) -> None:
        self._parts = parts
        self._executor = executor
        self._publisher = publisher
        self._deadlines = deadlines
        self._terminated = False

    def answer(self, request: messages.Request) -> messages.Answer:
        """The answer to `request`; a refusal is an answer too."""
        p, machine = self._parts, self._parts.machine
        before = machine.state
        now = seconds(p.clock)
        lease = None
        error: messages.ErrorBody | None = None
        try:
            match request.op:
                case Op.COMMAND:
                    self._command(request, now)
                case Op.LEASE:
                    lease = self._lease(request, now)
                case Op.LAPSE:
                    lease = machine.lapse(request.who, now)
                case Op.LIVE:
                    self._check_key(request.key or "")
                case Op.EXIT:
                    self._exit(request.who, now)
        except SessionError as refusal:
            allowed = [str(c) for c in machine.allowed()]
            error = messages.ErrorBody(refusal.code, str(refusal), machine.state, request.word, allowed)
        if request.op is not Op.LIVE and request.action != LeaseAction.RENEW:
            p.log.add(
                "command",
                who=request.who,
                command=f"lease {request.action}" if request.op is Op.LEASE else request.word,
                args=request.args,
                epoch=machine.epoch,
                before=before,
                after=machine.state,
                refused=None if error is None else error.code,
            )
        self._publisher.publish()
        reply = messages.Reply(error is None, before, machine.state, machine.revision, error)
        return messages.Answer(request.id, reply, lease)

    def by_priority(self, command: Command, who: str, now: float) -> None:
        """E-stop or stop from the priority channel: no lease, no reply; nothing where the state has no use for it."""
        machine = self._parts.machine
        before = machine.state
        refused = None
        try:
            self._at_once(command, who, now)
        except SessionError as refusal:
            refused = refusal.code
        self._parts.log.add("command", who=who, command=command, before=before, after=machine.state, refused=refused)

    def _at_once(self, command: Command, who: str, now: float) -> None:
        ordered = self._parts.machine.command(command, who, None, now)
        if command is Command.ESTOP:
            self._executor.ends(Ending(RunEnd.ESTOP, _ESTOP))
            self._executor.alarm(_ESTOP, Severity.EMERGENCY, f"E-stop by {who or 'an unnamed operator'}")
        else:
            self._executor.ends(Ending(RunEnd.STOPPED))
        self._executor.do(ordered)

    def terminate(self) -> None:
        """On SIGTERM: see `end_where_asked`."""
        self._terminated = True

    def end_where_asked(self, now: float) -> None:
        """After `terminate`: the process ends, at rest; E-stop first where the rig moves."""
        p = self._parts
        if not self._terminated:
            return
        if not p.machine.moving:
            p.state.ending = True
        elif p.machine.state is not State.ESTOPPED:
            self.by_priority(Command.ESTOP, "SIGTERM", now)

    def _exit(self, who: str, now: float) -> None:
        if self._parts.machine.moving:
            self.by_priority(Command.ESTOP, who, now)
            raise OrderError("not_at_rest", "the rig was moving: E-stop given; ask again when it is at rest")
        self._parts.state.ending = True

    def _lease(self, request: messages.Request, now: float) -> Lease:
        try:
            action = LeaseAction(request.action)
        except ValueError:
            words = ", ".join(LeaseAction)
            raise OrderError("bad_request", f"no lease action {request.action!r}: there are {words}") from None
        return self._parts.machine.lease_action(action, request.who, now, request.proof, request.to)

    def _check_key(self, key: str) -> None:
        if not self._parts.live.has(digest_of(key)):
            raise OrderError("live_key", "this is not the key of the live source that is loaded: load it anew")

    def _command(self, request: messages.Request, now: float) -> None:
        machine = self._parts.machine
        try:
            command = Command(request.command)
        except ValueError:
            words = ", ".join(Command)
            raise OrderError("unknown_command", f"no command {request.command!r}: there are {words}") from None
        if command in _AT_ONCE:
            self._at_once(command, request.who, now)
            return
        # Refused before anything is read or reached, and again below with what was read.
        machine.check(command, request.lease, now)
        given = self._prepare(command, request, now)
        try:
            ordered = machine.command(command, request.who, request.lease, now, given)
        except SessionError:
            if given.load is not None:
                given.load.close()
            raise
        self._executor.do(ordered)
        if command is Command.ARM and machine.state is State.FAULTED:
            raise OrderError("drive_refused", "the drive refused to be enabled: see its alarm")

    def _prepare(self, command: Command, request: messages.Request, now: float) -> Given:
        """What `command` needs, read, checked and made ready. Raises `OrderError`."""
        p = self._parts
        match command:
            case Command.CONNECT:
                self._connect(now)
            case Command.LOAD:
                orders.check_rig(request.args, p.config.rig)
                try:
                    binding, load = orders.load_of(request.args, p.config.rig, p.motion, p.live, request.key)
                except MemoryError as cause:
                    raise OrderError(
                        "out_of_memory", "the rig process has no memory for it: load a shorter one"
                    ) from cause
                finally:
                    self._deadlines.restart()
                return GivenOf(binding, load)
            case Command.ARM:
                return self._ready_to_arm(request, now)
            case Command.START | Command.MOVE | Command.HOME | Command.JOG:
                return GivenOf(move=orders.move_of(command, request.args, p.config.rig, p.motion))
            case Command.HOLD:
                orders.check_hold(p.config.rig)
            case Command.GO_LIVE:
                orders.check_inside(p.config.rig, p.motion)
            case Command.SHELVE | Command.UNSHELVE:
                return GivenOf(shelf=orders.shelf_of(request.args, request.who, p.clock.steady_ns() / 1e9))
            case Command.ACKNOWLEDGE:
                return GivenOf(alarms=orders.alarms_of(request.args), time_s=p.clock.wall_ns() / 1e9)
            case _:
                pass
        return GivenOf()

    def _connect(self, now: float) -> None:
        """A link is no motion: it is made before the session decides, and may fail."""
        try:
            self._parts.drive.connect(now)
        except DriveError as cause:
            raise OrderError("drive_unreachable", str(cause)) from cause
        finally:
            self._deadlines.restart()

    def _ready_to_arm(self, request: messages.Request, now: float) -> Given:
        p = self._parts
        header = p.shared.header
        silent_s = now - int(header["recorder_beat_ns"][0]) / 1e9
        # One that was killed a moment ago has been heard a moment ago: the run would go without its record.
        recorder = silent_s <= _RECORDER_SILENT_S and not recorder_ended(header)
        orders.check_record(p.config.runs, p.config.min_free_mb, recorder=recorder)
        pair = orders.asked_pair(request.args, p.machine.binding)
        p.machine.check_pair(pair)
        orders.check_rig(request.args, p.config.rig)
        try:
            orders.check_stored(p.state.plan_folder, p.state.plan)
        finally:
            self._deadlines.restart()
        # What came before in this very tick may have taken long (a load): the drive and we agree on the time again.
        p.state.status = p.drive.read(now, p.state.measured, p.state.measured_rate)
        return GivenOf(pair)

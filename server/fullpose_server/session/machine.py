"""The session's state machine: pure and synchronous. Commands and events in, orders out; time is passed in.

A refusal raises a `SessionError` and changes nothing. What happens is decided by `table.TABLE` alone; this file adds
what a table cannot say: who may command, which plan is bound to which rig, and which alarms still stand.
"""

from dataclasses import dataclass
from typing import Generic

from fullpose_server.session import table
from fullpose_server.session.actions import Given, L, M, Order, order_of
from fullpose_server.session.alarms import Alarm, AlarmBook, Severity, Shelf
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import BindingError, IllegalCommandError, LeaseError, NotReadyError
from fullpose_server.session.lease import Lease, LeaseAction, LeaseBook, LeaseToken
from fullpose_server.session.states import IN_MOTION, NEEDS_NO_LEASE, Action, Command, Event, State
from fullpose_server.session.table import When


@dataclass(frozen=True)
class SilencePolicy:
    """After how long a silence [s] the rig holds, stops and disarms; strictly rising."""

    hold_s: float = 5.0
    stop_s: float = 15.0
    disarm_s: float = 60.0

    def __post_init__(self) -> None:
        if not 0.0 < self.hold_s < self.stop_s < self.disarm_s:
            raise ValueError(f"silence {self}: expected 0 < hold_s < stop_s < disarm_s")


_STAGES = (Event.SILENT_HOLD, Event.SILENT_STOP, Event.SILENT_DISARM)


class Silence:
    """Counts one party's silence and names each stage once, in order."""

    def __init__(self, policy: SilencePolicy) -> None:
        self._limits = (policy.hold_s, policy.stop_s, policy.disarm_s)
        self._stage = 0

    def due(self, silence_s: float) -> tuple[Event, ...]:
        """The stages that fall due at this length of silence. Speech (a shorter silence) starts over."""
        if silence_s <= self._limits[0]:
            self._stage = 0
            return ()
        before = self._stage
        self._stage = max(before, sum(silence_s > limit for limit in self._limits))
        return _STAGES[before : self._stage]


class SessionMachine(Generic[L, M]):
    """One rig's session, of loads L and moves M. Not thread-safe: the rig process owns it."""

    def __init__(
        self, rig: str, rig_hash: str, policy: SilencePolicy | None = None, shelves: tuple[Shelf, ...] = ()
    ) -> None:
        """`shelves`: of an earlier session of the rig; they last until their end."""
        policy = policy or SilencePolicy()
        self.rig = rig
        self.rig_hash = rig_hash
        self.state = State.DISCONNECTED
        self.revision = 0
        self.binding: Binding | None = None
        self.alarms = AlarmBook(shelves=shelves)
        self.linked = False
        self.moving = False
        self._flight = False  # whether positioning leads to a flight
        self._lease = LeaseBook(policy.hold_s)
        self._owner = Silence(policy)

    # --- what may be asked ---

    def allowed(self) -> tuple[Command, ...]:
        """The commands that the present state accepts."""
        return table.allowed(self.state)

    def lease(self, now: float) -> Lease:
        """Who holds command."""
        return self._lease.view(now)

    @property
    def epoch(self) -> int:
        """The lease's epoch: drives refuse writes of an older one."""
        return self._lease.epoch

    def check(self, command: Command, token: LeaseToken | None, now: float) -> None:
        """Raise the `SessionError` with which `command` would be refused; changes nothing."""
        if command not in NEEDS_NO_LEASE:
            self._lease.checked(token, now)
        if command not in table.ANYWHERE and self._find(command) is None:
            raise IllegalCommandError(self.state, command, self.allowed())
        if command in (Command.START, Command.GO_LIVE) and self.binding is not None:
            wanted = "a live source" if command is Command.GO_LIVE else "a plan"
            if self.binding.live != (command is Command.GO_LIVE):
                raise NotReadyError("wrong_load", f"{command} needs {wanted} loaded: disarm, unload and load it")
        codes = ", ".join(alarm.code for alarm in self.alarms.unacknowledged)
        if command is Command.ARM and codes:
            raise NotReadyError("standing_fault", f"a fault stands that nobody has acknowledged: {codes}")
        if command is Command.RESET:
            if self.moving:
                raise NotReadyError("not_at_rest", "the rig is still braking: reset when it is at rest")
            if codes:
                raise NotReadyError("unacknowledged", f"acknowledge first: {codes}")

    # --- what is done ---

    def command(
        self,
        command: Command,
        who: str,
        token: LeaseToken | None,
        now: float,
        given: Given[L, M] | None = None,
    ) -> tuple[Order[L, M], ...]:
        """Do `command` with what was made ready for it: returns the orders.

        Raises a `SessionError`, and changes nothing, where the table, the lease, the binding or standing alarms
        forbid it, or where what it needs was not given.
        """
        given = given or Given()
        self.check(command, token, now)
        if command is Command.LOAD:
            self._check_loadable(given.binding)
        if command is Command.ARM:
            self.check_pair(given.binding)
        alarms = self._alarms_after(command, who, given)
        row = self._find(command)
        orders = () if row is None else tuple(order_of(word, given, who) for word in row.actions)
        if command not in NEEDS_NO_LEASE:
            self._lease = self._lease.checked(token, now)
        if alarms is not self.alarms:
            self.alarms = alarms
            self.revision += 1
        if row is None:  # `check` has looked: only what is done anywhere has no row
            return ()
        if command is Command.LOAD:
            self.binding = given.binding
        if command is Command.CONNECT:
            self.linked = True
            self.alarms = self.alarms.first_awaited()  # what a link made anew meets follows from nothing of before
        if command is Command.START:
            self._flight = True
        if command in (Command.MOVE, Command.HOME, Command.JOG):
            self._flight = False
        self._go(row)
        return orders

    def event(self, event: Event) -> tuple[Order[L, M], ...]:
        """Report what happened: returns the orders, none where the state has no use for it."""
        if event is Event.AT_REST and self.state in table.LATCHED:
            self.moving = False  # elsewhere the rows say what rest means
        if event is Event.LINK_LOST:
            # A rig without link is out of our hands: its drive brakes by itself.
            self.linked = self.moving = False
        row = self._find(event)
        if row is None:
            return ()
        nothing: Given[L, M] = Given()
        orders = tuple(order_of(word, nothing, "") for word in row.actions)
        self._go(row)
        return orders

    def alarm(
        self,
        code: str,
        severity: Severity,
        message: str,
        time_s: float,
        *,
        frame: str | None = None,
        value: float | None = None,
        limit: float | None = None,
        unit: str | None = None,
    ) -> Alarm:
        """Raise an alarm (latched first-out); the state is not touched: report the `Event` as well."""
        self.alarms = self.alarms.raised(code, severity, message, time_s, frame, value, limit, unit)
        self.revision += 1
        wanted = (code, frame, severity)
        return next(a for a in reversed(self.alarms.history) if (a.code, a.frame, a.severity) == wanted)

    def end_shelves(self, time_s: float) -> None:
        """Take away the shelves whose time is over, `time_s` [s, Unix]."""
        alarms = self.alarms.ended(time_s)
        if alarms is not self.alarms:
            self.alarms = alarms
            self.revision += 1

    def lease_action(
        self, action: LeaseAction, who: str, now: float, proof: str | None, to: str | None = None
    ) -> Lease:
        """`proof` is of the lease's secret, or of the new one where the action gives one (`GIVES_SECRET`).

        `to`: to whom it is granted. Raises `LeaseError`.
        """
        return self._take_book(self._lease_after(action, who, now, proof, to), now)

    def lapse(self, holder: str, now: float) -> Lease:
        """Take the lease from `holder`, who may command no longer: what silence brings about falls due from now on."""
        return self._take_book(self._lease.lapse(holder, now), now)

    @property
    def lapsed(self) -> bool:
        """Whether nobody holds the lease since its holder may command no longer."""
        return self._lease.lapsed

    def _take_book(self, book: LeaseBook, now: float) -> Lease:
        if (book.epoch, book.asked) != (self._lease.epoch, self._lease.asked):
            self.revision += 1
        self._lease = book
        return book.view(now)

    def _lease_after(self, action: LeaseAction, who: str, now: float, proof: str | None, to: str | None) -> LeaseBook:
        book = self._lease
        match action:
            case LeaseAction.RELEASE:
                return book.release(proof, now)
            case LeaseAction.RENEW:
                return book.renew(proof, now)
            case LeaseAction.GRANT:
                return book.grant(proof, now, to)
        if proof is None:
            raise LeaseError("lease_needed", f"{action} needs a secret of its own")
        if action is LeaseAction.REQUEST:
            return book.request(who, proof)
        return book.take(who, proof, now, force=action is LeaseAction.TAKEOVER)

    def silence(self, now: float) -> tuple[Event, ...]:
        """The stages that fall due because the lease's owner is silent; report each as an event, with an alarm."""
        return self._owner.due(self._lease.silence(now))

    # --- inside ---

    def _alarms_after(self, command: Command, who: str, given: Given[L, M]) -> AlarmBook:
        """What becomes of the alarms. Raises `NotReadyError` where `command` needs a shelf."""
        if command is Command.ACKNOWLEDGE:
            seen = self.alarms.acknowledged(who, given.alarms, given.time_s)
            # Where no reset comes, what stood on would take `first` from the next fault.
            return seen if self.state in table.LATCHED else seen.cleared()
        if command not in (Command.SHELVE, Command.UNSHELVE):
            return self.alarms
        if given.shelf is None:
            raise NotReadyError("nothing_to_shelve", f"{command} needs the code of a warning")
        if command is Command.SHELVE:
            return self.alarms.shelve(given.shelf)
        return self.alarms.unshelved(given.shelf.code, given.shelf.frame)

    def _find(self, trigger: Command | Event) -> table.Transition | None:
        holding = {When.FLIGHT if self._flight else When.MOVE, When.LINKED if self.linked else When.UNLINKED}
        return table.find(self.state, trigger, frozenset(holding))

    def _go(self, row: table.Transition) -> None:
        self.state = row.target
        self.revision += 1
        if row.target in IN_MOTION:
            self.moving = True
        elif row.target not in table.LATCHED:
            self.moving = False
        if Action.CLEAR in row.actions:
            self.alarms = self.alarms.cleared()
        if Action.UNBIND in row.actions:
            self.binding = None

    def _check_loadable(self, binding: Binding | None) -> None:
        if binding is None:
            raise NotReadyError("nothing_to_load", "load needs a plan folder or a live source")
        if (binding.rig, binding.rig_hash) != (self.rig, self.rig_hash):
            raise BindingError("the plan's rig", self.rig_hash, binding.rig_hash)

    def check_pair(self, asked: Binding | None) -> None:
        """Raise where the rig, or the pair that the caller names if any, is not the pair that was loaded."""
        bound = self.binding
        if bound is None:
            raise NotReadyError("nothing_loaded", "nothing is loaded: load a plan")
        if bound.rig_hash != self.rig_hash:
            raise BindingError("the rig", bound.rig_hash, self.rig_hash)
        if asked is not None:
            if asked.plan_hash != bound.plan_hash:
                raise BindingError("the plan", bound.plan_hash, asked.plan_hash)
            if asked.rig_hash != bound.rig_hash:
                raise BindingError("the rig", bound.rig_hash, asked.rig_hash)

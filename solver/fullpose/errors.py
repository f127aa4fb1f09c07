"""The errors of this package: one root; each child carries its evidence."""


class SolverError(Exception):
    """Root of every error that `solver` raises."""


class RigError(SolverError):
    """A rig that cannot exist: which field, which value, what was expected."""

    def __init__(self, field: str, value: object, expected: str) -> None:
        super().__init__(f"{field} = {value!r}: expected {expected}")
        self.field = field
        self.value = value
        self.expected = expected


class InputError(SolverError):
    """Input arrays that are not a flight: which sample (or None), which value, what was expected."""

    def __init__(self, name: str, sample: int | None, value: object, expected: str) -> None:
        where = name if sample is None else f"{name}, sample {sample}"
        super().__init__(f"{where}: {value!r}: expected {expected}")
        self.name = name
        self.sample = sample
        self.value = value
        self.expected = expected


class MethodError(SolverError):
    """A method asked for what it cannot do: unknown name or option, or a rig it does not apply to."""


class CancelledError(SolverError):
    """The caller's progress callback asked to stop."""


class OutOfTimeError(CancelledError):
    """The caller's progress callback gives up one trial of a search: it counts as one that does not do."""

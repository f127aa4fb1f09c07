"""The errors of this package: one root; each child carries its evidence."""

from fullpose.errors import InputError, MethodError, RigError, SolverError


class ServerError(Exception):
    """Root of what this package raises for its users to read."""


class FileError(ServerError):
    """A file that cannot be used: which file, line and column, which value, and what was expected there."""

    def __init__(
        self,
        file: str,
        expected: str,
        *,
        line: int | None = None,
        column: str | None = None,
        value: str | None = None,
        unit: str = "line",
        column_word: str = "column",
        otherwise: tuple[str, str] | None = None,
    ) -> None:
        """`otherwise`: a field of the reading's options and what it does: a person may have it so."""
        where = [file]
        if line is not None:
            where.append(f"{unit} {line}")
        if column is not None:
            where.append(f"{column_word} {column}")
        found = "" if value is None else f"{value}: "
        told = f"{', '.join(where)}: {found}expected {expected}"
        super().__init__(told if otherwise is None else f"{told}; {' '.join(otherwise)}")
        self.file = file
        self.line = line
        self.column = column
        self.value = value
        self.expected = expected
        self.otherwise = otherwise
        self._told = told

    @property
    def for_command_line(self) -> str:
        """The message with the option of that field's name: `--bridge-gaps` for `bridge_gaps`."""
        if self.otherwise is None:
            return self._told
        field, does = self.otherwise
        return f"{self._told}; --{field.replace('_', '-')} {does}"


class NotFoundError(ServerError):
    """A thing that is named and not in the store."""

    def __init__(self, kind: str, name: str, hint: str = "") -> None:
        super().__init__(f"no {kind} named {name!r}{hint and ': '}{hint}")
        self.kind = kind
        self.name = name


class InUseError(ServerError):
    """A thing that cannot go because something else needs it."""

    def __init__(self, kind: str, name: str, by: str) -> None:
        super().__init__(f"{kind} {name!r} is in use by {by}")
        self.kind = kind
        self.name = name
        self.by = by


class StorageError(ServerError):
    """The database cannot be written or read as things are."""


class StorageFullError(StorageError):
    """There is no room for it."""


class StorageBusyError(StorageError):
    """Another program holds the database."""


class DamagedError(ServerError):
    """A file of the server's own that is not what it wrote."""


class TransitionError(ServerError):
    """A job told to do what its status does not allow."""


class NoRemedyError(ServerError):
    """No single limit, raised, makes the flight fit."""


# The codes of the problem documents, where the same error is one there.
_JOB_CODES: tuple[tuple[type[Exception], str], ...] = (
    (InputError, "solver-input"),
    (MethodError, "method"),
    (RigError, "rig"),
    (FileError, "file"),
    (NotFoundError, "not-found"),
    (NoRemedyError, "no-remedy"),
    (SolverError, "solver"),
    (ServerError, "job"),
)


def job_code(error: Exception) -> str:
    """The stable code of what a job failed by; "internal" for what nobody planned."""
    return next((code for kind, code in _JOB_CODES if isinstance(error, kind)), "internal")

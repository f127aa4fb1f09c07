"""What each of the server's own errors is to a client: its problem document. Light: offload processes tell it too."""

import errno

from fullpose.errors import SolverError
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import FieldProblem, Problem
from fullpose_server.errors import DamagedError, FileError, NotFoundError, StorageError, StorageFullError
from fullpose_server.formats.importers.columns import TooLargeError


def known_problem(error: Exception) -> Problem | None:
    """The document of an error; None for one that nobody planned for."""
    match error:
        case ApiError():
            return error.problem
        case NotFoundError():
            return ApiError(404, "not-found", str(error)).problem
        case FileError():
            status, code = (413, "too-large") if isinstance(error, TooLargeError) else (422, "file")
            return ApiError(status, code, str(error), errors=[_file_problem(error)]).problem
        case StorageFullError():
            return ApiError(507, "disk-full", str(error)).problem
        case StorageError():
            return ApiError(503, "database", str(error)).problem
        case DamagedError():
            return ApiError(409, "damaged", str(error)).problem
        case SolverError():
            return ApiError(422, "solver-input", str(error)).problem
        case OSError(errno=errno.ENOSPC | errno.EDQUOT):
            return ApiError(507, "disk-full", f"the disk is full: {error.strerror}").problem
        case _:
            return None


def _file_problem(error: FileError) -> FieldProblem:
    return FieldProblem(
        where=error.column or "file",
        message=str(error),
        value=error.value,
        line=error.line,
        expected=error.expected,
    )

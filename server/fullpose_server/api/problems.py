"""The API's own errors and their problem documents (RFC 9457); light: the stop gate has them too."""

from collections.abc import Sequence
from http import HTTPStatus

from fullpose_server.api.schemas.base import FieldProblem, Problem

MEDIA_TYPE = "application/problem+json"


class ApiError(Exception):
    """Root of the errors that the API raises on purpose; it carries its problem document."""

    def __init__(
        self,
        status: int,
        code: str,
        detail: str,
        *,
        errors: Sequence[FieldProblem] = (),
        state: str | None = None,
        command: str | None = None,
        allowed: Sequence[str] | None = None,
    ) -> None:
        super().__init__(detail)
        self.problem = Problem(
            type=f"urn:fullpose:problem:{code}",
            title=HTTPStatus(status).phrase,
            status=status,
            detail=detail,
            errors=list(errors),
            state=state,
            command=command,
            allowed=None if allowed is None else list(allowed),
        )


def not_found(kind: str, name: str) -> ApiError:
    """404 for a thing that is named and not there."""
    return ApiError(404, "not-found", f"no {kind} named {name!r}")

"""The API's own errors and their problem documents (RFC 9457); light: the stop gate has them too."""

import reprlib
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from fullpose_server.api.schemas.base import FieldProblem, Problem

MEDIA_TYPE = "application/problem+json"
RETRY_S = 5  # what a client is told to wait where the server has too much to do, or no room
LONGEST = 2000  # characters of a detail
_SECRET = {"lease", "secret", "key", "password", "current", "new"}  # what a problem never shows the value of
_ABRIDGING = reprlib.Repr()  # never the whole of a large value
_ABRIDGING.maxstring = _ABRIDGING.maxother = _ABRIDGING.maxlong = 120


class ApiError(Exception):
    """Root of the errors that the API raises on purpose; it carries its problem document, and headers of the answer."""

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
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(detail)
        self.headers = headers
        self.problem = Problem(
            type=f"urn:fullpose:problem:{code}",
            title=HTTPStatus(status).phrase,
            status=status,
            detail=plain(detail, LONGEST),
            errors=list(errors),
            state=state,
            command=command,
            allowed=None if allowed is None else list(allowed),
        )


def not_found(kind: str, name: str) -> ApiError:
    """404 for a thing that is named and not there."""
    return ApiError(404, "not-found", f"no {kind} named {name!r}")


def validation_problem(errors: Sequence[Any]) -> Problem:
    """422 from pydantic's list of errors."""
    fields = [
        FieldProblem(
            where=plain(".".join(str(part) for part in item["loc"]), 200),
            message=plain(item["msg"], 400),
            value=None if item["type"] == "missing" or _SECRET & {*item["loc"]} else _abridged(item.get("input")),
        )
        for item in errors[:20]
    ]
    more = f" (and {len(errors) - 20} more)" if len(errors) > 20 else ""
    detail = "; ".join(f"{field.where}: {field.message}" for field in fields[:3]) + more
    return ApiError(422, "validation", detail, errors=fields).problem


def plain(text: str, longest: int) -> str:
    """Text that an answer may carry whatever a client has sent: not longer, and without halves of characters."""
    text = text if len(text) <= longest else text[: longest - 3] + "..."
    return text.encode("utf-8", "backslashreplace").decode()


def problem_response(
    problem: Problem, request: Request | None = None, headers: Mapping[str, str] | None = None
) -> Response:
    """The HTTP answer of a problem."""
    if request is not None:
        problem = problem.model_copy(update={"instance": request.url.path})
    told = {"Retry-After": str(RETRY_S)} if problem.status in (429, 503, 507) else {}
    return Response(
        problem.model_dump_json(exclude_none=True), problem.status, {**told, **(headers or {})}, media_type=MEDIA_TYPE
    )


def _abridged(value: object) -> str | None:
    try:
        return plain(_ABRIDGING.repr(value), 120)
    except (RecursionError, ValueError):  # too deep, or a number of too many digits
        return None

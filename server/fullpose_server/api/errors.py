"""Every error as application/problem+json (RFC 9457), with a stable code in its type."""

import logging

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import ValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from fullpose.errors import InputError, MethodError
from fullpose_server.api.problems import MEDIA_TYPE, ApiError, validation_problem
from fullpose_server.api.schemas.base import FieldProblem, Problem
from fullpose_server.errors import FileError, NotFoundError

log = logging.getLogger(__name__)


def problem_of(error: Exception) -> Problem:
    """The document of an error; errors nobody planned for become 500 and are logged, without their text."""
    match error:
        case ApiError():
            return error.problem
        case HTTPException():
            return ApiError(error.status_code, "http", str(error.detail)).problem
        case RequestValidationError() | ValidationError():
            return validation_problem(error.errors())
        case NotFoundError():
            return ApiError(404, "not-found", str(error)).problem
        case FileError():
            return ApiError(422, "file", str(error), errors=[_file_problem(error)]).problem
        case InputError() | MethodError():
            return ApiError(422, "solver-input", str(error)).problem
        case _:
            log.error("unexpected error", exc_info=error)
            return ApiError(500, "internal", "an error of the server; its log tells more").problem


def problem_response(problem: Problem, request: Request | None = None) -> Response:
    """The HTTP answer of a problem."""
    if request is not None:
        problem = problem.model_copy(update={"instance": request.url.path})
    return Response(problem.model_dump_json(exclude_none=True), problem.status, media_type=MEDIA_TYPE)


def install(app: FastAPI) -> None:
    """Answer every error of the app with a problem document."""

    async def answer(request: Request, error: Exception) -> Response:
        return problem_response(problem_of(error), request)

    for kind in (ApiError, HTTPException, RequestValidationError, FileError, NotFoundError, InputError, MethodError):
        app.add_exception_handler(kind, answer)
    app.add_exception_handler(Exception, answer)


def _file_problem(error: FileError) -> FieldProblem:
    return FieldProblem(
        where=error.column or "file",
        message=str(error),
        value=error.value,
        line=error.line,
        expected=error.expected,
    )

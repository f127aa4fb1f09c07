"""Every error as application/problem+json (RFC 9457), with a stable code in its type."""

import logging

from asgi_correlation_id import correlation_id
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import ValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.routing import Match, Mount

from fullpose.errors import SolverError
from fullpose_server.api.known_errors import known_problem
from fullpose_server.api.problems import ApiError, problem_response, validation_problem
from fullpose_server.api.schemas.base import Problem
from fullpose_server.errors import ServerError

METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE")
log = logging.getLogger(__name__)


class BodyError(HTTPException):
    """An `ApiError` while a body is received, where FastAPI takes others for a body that it cannot parse."""

    def __init__(self, error: ApiError) -> None:
        super().__init__(error.problem.status, error.problem.detail)
        self.problem = error.problem


def problem_of(error: Exception) -> Problem:
    """The document of an error; errors nobody planned for become 500 and are logged, without their text."""
    match error:
        case BodyError():
            return error.problem
        case HTTPException():
            return ApiError(error.status_code, "http", str(error.detail)).problem
        case RequestValidationError() | ValidationError():
            return validation_problem(error.errors())
    problem = known_problem(error)
    if problem is None:
        log.error("unexpected error", exc_info=error)
        request = correlation_id.get()
        where = f" of request {request}" if request else ""
        return ApiError(500, "internal", f"an error of the server; its log{where} tells more").problem
    return problem


def install(app: FastAPI) -> None:
    """Answer every error of the app with a problem document."""

    async def answer(request: Request, error: Exception) -> Response:
        if isinstance(error, HTTPException) and error.status_code in (404, 405):  # nobody's own: the router's
            methods = _methods(app, request)
            if methods:
                listed = ", ".join(methods)
                refusal = ApiError(405, "method", f"{request.method} {request.url.path}: expected {listed}")
                return problem_response(refusal.problem, request, {"Allow": listed})
            if error.status_code == 405:  # by the console, which takes what is nothing of the API for a page
                return problem_response(ApiError(404, "http", "Not Found").problem, request)
        return problem_response(problem_of(error), request, error.headers if isinstance(error, ApiError) else None)

    for kind in (ApiError, HTTPException, RequestValidationError, ServerError, SolverError, OSError):
        app.add_exception_handler(kind, answer)
    app.add_exception_handler(Exception, answer)


def _methods(app: FastAPI, request: Request) -> list[str]:
    """What the path would take, were it not for this method. The console, which takes every path, is left out."""
    asked = {"type": "http", "path": request.scope["path"], "root_path": "", "headers": [], "path_params": {}}
    routes = [route for route in app.router.routes if not isinstance(route, Mount)]
    found = [m for m in METHODS if any(r.matches({**asked, "method": m})[0] is Match.FULL for r in routes)]
    if request.method in found:
        return []
    if not found and request.method not in ("GET", "HEAD") and not request.url.path.startswith("/api/"):
        return ["GET", "HEAD"]  # a page of the console
    return found

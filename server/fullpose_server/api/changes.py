"""What changes something beside a session (flights, plans, comparisons, records), in the audit too.

`dependencies=CHANGE` in a route's decorator is all that it takes. The entry's command is the route's method and path;
its args are what was asked for by the path, and what was made where the answer says where that is.
"""

from collections.abc import AsyncIterator
from typing import Any

from fastapi import Depends, Request, Response

from fullpose_server.api.deps import AddressDep, ServicesDep, WhoDep
from fullpose_server.api.known_errors import known_problem
from fullpose_server.api.paths import API
from fullpose_server.store.audit_entry import of_no_rig


async def _change(
    request: Request, response: Response, services: ServicesDep, who: WhoDep, address: AddressDep
) -> AsyncIterator[None]:
    refused: str | None = None
    try:
        yield
    except BaseException as error:
        refused = _why(error)
        raise
    finally:
        route = str(request.scope["route"].path).removeprefix(API)
        made = response.headers.get("location")
        args: dict[str, Any] = dict(request.path_params) | ({} if made is None else {"made": made.removeprefix(API)})
        services.trail.follow(of_no_rig(who, f"{request.method} {route}", args, address, refused))


def _why(error: BaseException) -> str:
    problem = known_problem(error) if isinstance(error, Exception) else None
    return type(error).__name__ if problem is None else f"{problem.type.rpartition(':')[2]}: {problem.detail}"


CHANGE = [Depends(_change)]

"""What every way to change people shares."""

import asyncio
from collections.abc import Callable
from typing import Any

from fullpose_server.api.deps import Services
from fullpose_server.api.problems import ApiError
from fullpose_server.people.admitted import Credential
from fullpose_server.people.passwords import PasswordError
from fullpose_server.store.people import PersonError

NO_PEOPLE = "no users are configured: the first is made by `fullpose user add NAME --role admin`"
# Of every route about people.
REFUSED: dict[int | str, dict[str, Any]] = {
    409: {"description": "No users are configured, or people would be left as they may not be"},
}


def signed_in(person: Credential | None) -> Credential:
    """Who asks. Raises `ApiError` where no people are configured."""
    if person is None:
        raise ApiError(409, "no-people", NO_PEOPLE)
    return person


async def changed(services: Services, change: Callable[[], object]) -> None:
    """Make a change to people, in force when this returns. Raises `ApiError`, `ServerError`."""
    try:
        await asyncio.to_thread(change)
    except PersonError as error:
        raise ApiError(409, "person", str(error)) from None
    except PasswordError as error:
        raise ApiError(422, "password", str(error)) from None
    await services.people.refresh()

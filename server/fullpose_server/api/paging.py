"""Lists in pages: the newest rows, then those before the last one seen (keyset), by a link to the next page (RFC 8288).

What comes meanwhile shifts no page, and the last page of many costs what the first does.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

from fastapi import Depends, Query, Request
from starlette.responses import Response

from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.problems import ApiError
from fullpose_server.store.keyset import Key

ROWS = 100  # where the client does not say
_KEY = re.compile(r"([0-9]{1,12}(?:\.[0-9]{1,12})?)~([\w.-]{1,200})", re.ASCII)
LINKED: dict[int | str, dict[str, Any]] = {
    200: {
        "headers": {
            "Link": {
                "description": 'The next page, `<path>; rel="next"`, where there is one',
                "schema": {"type": "string"},
            }
        }
    }
}
_Row = TypeVar("_Row")


@dataclass(frozen=True)
class Page:
    """Which page is asked for."""

    rows: int
    before: Key | None

    @property
    def wanted(self) -> int:
        """How many rows to read: one more tells that there is another page."""
        return self.rows + 1

    def cut(self, found: Sequence[_Row]) -> Sequence[_Row]:
        """The rows of the page."""
        return found[: self.rows]

    def answer(self, request: Request, body: bytes, found: int, last: Key | None) -> Response:
        """The page as JSON, with the link to the next one where more than its rows were `found`."""
        before = f"{last.created!r}~{last.id}" if found > self.rows and last is not None else None
        return listed(request, body, before, self.rows)


def listed(request: Request, body: bytes, before: str | None, rows: int) -> Response:
    """A page of so many rows as JSON, with the link to the next one, which goes on `before` there."""
    headers = {}
    if before is not None:
        url = request.url.include_query_params(before=before, limit=rows)
        headers["Link"] = f'<{url.path}?{url.query}>; rel="next"'
    return Response(body, headers=headers, media_type="application/json")


async def _page(
    services: ServicesDep,
    limit: Annotated[int | None, Query(ge=1, le=1_000_000, description="Rows of the page; 100 where not given")] = None,
    before: Annotated[str | None, Query(description="Of the link to the next page", max_length=256)] = None,
) -> Page:
    most = services.settings.max_page_rows
    if limit is not None and limit > most:
        raise ApiError(422, "validation", f"query.limit: {limit}: this server lists up to {most} rows at once")
    key = None
    if before is not None:
        found = _KEY.fullmatch(before)
        if found is None:
            raise ApiError(422, "validation", "query.before: expected what a link to the next page has")
        key = Key(float(found[1]), found[2])
    return Page(min(ROWS, most) if limit is None else limit, key)


PageDep = Annotated[Page, Depends(_page)]

"""Tags and notes over HTTP: what a list is searched for, and what is put to one thing."""

from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import Depends, Query

from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.labels import LabelsIn
from fullpose_server.formats.labels import LabelError, Labels, Wanted, labels_of

LONGEST_QUERY = 200


async def _wanted(
    q: Annotated[
        str | None,
        Query(max_length=LONGEST_QUERY, description="Words that are all in its name, notes or tags, whatever capitals"),
    ] = None,
    tag: Annotated[str | None, Query(max_length=LONGEST_QUERY, description="A tag that it has")] = None,
) -> Wanted:
    try:
        return Wanted.of(q, tag)
    except LabelError as error:
        raise ApiError(422, "validation", f"query.q: {error}") from None


WantedDep = Annotated[Wanted, Depends(_wanted)]
LABELLED: dict[int | str, dict[str, Any]] = {422: {"description": "A tag, or notes, that cannot be"}}


def changed(body: LabelsIn, tags: Sequence[str], notes: str) -> Labels:
    """The labels that a thing has after a change to those it had. Raises `ApiError`."""
    try:
        return labels_of(tags if body.tags is None else body.tags, notes if body.notes is None else body.notes)
    except LabelError as error:
        raise ApiError(422, "validation", str(error)) from None

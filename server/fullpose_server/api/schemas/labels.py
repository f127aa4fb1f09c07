"""Tags and notes on the wire."""

from pydantic import Field

from fullpose_server.api.schemas.base import Wire
from fullpose_server.formats.labels import LONGEST_NOTES, LONGEST_TAG, MOST_TAGS


class LabelsIn(Wire):
    """In place of those that it has; what is left out stays as it is."""

    tags: list[str] | None = Field(
        default=None,
        description=f"Up to {MOST_TAGS} of 1 to {LONGEST_TAG} characters, without a comma; two that differ in capitals"
        " only are one",
    )
    notes: str | None = Field(default=None, description=f"Up to {LONGEST_NOTES} characters")


class LabelledOut(Wire):
    """What people put to it."""

    tags: list[str]
    notes: str

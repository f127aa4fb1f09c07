"""What the job of a plan leaves in the plan's row, read again."""

from collections.abc import Mapping
from typing import Any

from fullpose_server.formats.plan_folder import EARLIER_FORMAT, FORMAT


def refusal_of(result: Mapping[str, Any]) -> str | None:
    """Why a plan that was made cannot be flown; None where it can, or where it is not made yet (`result` is empty)."""
    if result and result.get("format") != FORMAT:
        return f"it was {EARLIER_FORMAT}"
    refusal: str | None = result.get("refusal")
    return refusal

"""What every wire model shares, and the problem document (RFC 9457).

The surface is in degrees and seconds with the unit in the name; arrays of frames are base, outer, middle, inner.
"""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from fullpose.rig import Frame, Geometry, Limit
from fullpose.vocabulary import RemedyKind

CLIENT_NAME = r"^[\w.@:+-]{1,64}$"  # of who commands
_INT64 = 2**63  # what database and rig process hold
# Numbers as JSON has them, in what a client sends: true and "1" are none.
Number = Annotated[float, Field(strict=True)]
Integer = Annotated[int, Field(strict=True, ge=-_INT64, lt=_INT64)]
Ordinal = Annotated[int, Field(strict=True, ge=0, lt=_INT64)]
Truth = Annotated[bool, Field(strict=True)]
Word = Annotated[str, Field(max_length=64)]
Four = tuple[Number, Number, Number, Number]
Three = tuple[Number, Number, Number]
Cursor = Annotated[int, Field(ge=0, lt=_INT64)]  # of a query, where all is text
OptionValue = Truth | Integer | Number | Word
Options = Annotated[dict[Word, OptionValue], Field(max_length=32)]
if TYPE_CHECKING:
    FrameName = Frame
    LimitName = Limit
    GeometryName = Geometry
    RemedyName = RemedyKind
else:  # the words where they are used, not a named component of the contract
    FrameName = Literal[*Frame]
    LimitName = Literal[*Limit]
    GeometryName = Literal[*Geometry]
    RemedyName = Literal[*RemedyKind]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")]
Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class Wire(BaseModel):
    """A message: frozen, and strict about what it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def check_one(message: Wire, first: str, second: str, expected: str) -> None:
    """Raise ValueError unless exactly one of two fields is given."""
    if (getattr(message, first) is None) == (getattr(message, second) is None):
        raise ValueError(f"expected {expected}")


class FieldProblem(Wire):
    """One thing wrong with a request: where, which value, what was expected."""

    where: str = Field(description="Path in the body, query or header, or the column of a file")
    message: str
    value: str | None = None
    line: int | None = Field(default=None, description="Line of the file, the first is 1")
    expected: str | None = None


class Problem(Wire):
    """Every error answer, as application/problem+json."""

    type: str = Field(description="urn:fullpose:problem:<code>; the code is stable, the texts are not")
    title: str
    status: int
    detail: str
    instance: str | None = None
    errors: list[FieldProblem] = Field(default=[])
    state: str | None = Field(default=None, description="Session state, where a command was refused")
    command: str | None = None
    allowed: list[str] | None = Field(default=None, description="Commands the state allows")


class Notice(Wire):
    """Something accepted that a person should look at."""

    code: str
    message: str
    column: str | None = None
    row: int | None = Field(default=None, description="Line of a text, row of another file; the first is 1")
    value: str | None = None

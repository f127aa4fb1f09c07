"""Profiles on the wire."""

from pydantic import Field

from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.trajectories import ConventionName
from fullpose_server.formats.column_map import ColumnMap


class ProfileIn(Wire):
    """A column map to be saved."""

    about: str = Field(default="", max_length=200)
    columns: ColumnMap


class ProfileOut(Wire):
    """A named profile."""

    name: str
    about: str
    axes: ConventionName
    saved: bool = Field(description="By a person, on this server; others ship")

"""How a flight is to be read: what a person may say of it, the same wherever one is read."""

from dataclasses import dataclass

from fullpose_server.formats.trajectory import Convention


@dataclass(frozen=True)
class ReadOptions:
    """What was said."""

    convention: Convention | None = None  # None: the profile's
    profile: str | None = None  # a named one or a TOML file; None: the first that fits
    columns: str | None = None  # a column map as JSON, in the place of a profile
    source: str | None = None  # of a file with several attitudes: the topic, message, group or sheet
    strict: bool = False  # a warning is a refusal
    bridge_gaps: bool = False  # a gap is flown through by interpolation
    drop_duplicates: bool = False  # of samples with one stamp, the first is kept


AS_IT_IS = ReadOptions()

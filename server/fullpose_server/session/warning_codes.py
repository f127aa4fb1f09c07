"""What a rig can warn of: the codes of its warnings, which are the codes that can be shelved."""

from enum import StrEnum


class WarningCode(StrEnum):
    """All of them; some are of a fault too, where a tolerance has a second level."""

    FOLLOWING_ERROR = "following_error"
    ATTITUDE_ERROR = "attitude_error"
    LATENESS = "lateness"
    MISSED_DEADLINES = "missed_deadlines"
    OUTSIDE_RANGE = "outside_range"
    STALE_WRITE = "stale_write"
    RECORDER_LOST = "recorder_lost"
    RECORD_ERROR = "record_error"
    DISK_LOW = "disk_low"
    OWNER_SILENT = "owner_silent"
    SERVER_SILENT = "server_silent"
    LIVE_SOURCE_LOST = "live_source_lost"
    LIVE_SOURCE_STALE = "live_source_stale"
    LIVE_BAD = "live_bad"
    LIVE_DROPPED = "live_dropped"
    LIVE_CLOCK_STEPS = "live_clock_steps"
    LIVE_SECOND_SOURCE = "live_second_source"
    LIVE_UNPROVEN = "live_unproven"
    LIVE_IMPLAUSIBLE_RATE = "live_implausible_rate"
    PREVIEW_LATE = "preview_late"

"""What a person may do. Each role may all that the one before it may."""

from enum import StrEnum


class Role(StrEnum):
    """Of a person or a token."""

    VIEWER = "viewer"  # sees everything, solves, stops a rig
    OPERATOR = "operator"  # uploads, plans, takes the lease and commands
    ADMIN = "admin"  # people, tokens of others

    def may(self, needed: "Role") -> bool:
        """Whether this role is at least the one that is needed."""
        return _ORDER.index(self) >= _ORDER.index(needed)

    def at_most(self, other: "Role") -> "Role":
        """The lesser of the two."""
        return self if other.may(self) else other


_ORDER = tuple(Role)

"""What a remedy is asked for with; light, so that the API takes its words from here."""

from dataclasses import dataclass

from fullpose.rig import LIMITS, Rig
from fullpose.vocabulary import RemedyKind
from fullpose_server.errors import ServerError
from fullpose_server.planning.plan_request import check_frame

KINDS = tuple(RemedyKind)


@dataclass(frozen=True)
class RemedyRequest:
    """What may be changed; `relax` may be asked of one frame or one kind of limit alone."""

    kind: str
    frame: str | None = None
    limit: str | None = None

    def check(self, rig: Rig) -> None:
        """Raise `ServerError` for a word that is none, or a frame or limit that the kind has no use for.

        `InputError` for a frame that the rig has not.
        """
        if self.kind not in KINDS:
            raise ServerError(f"remedy {self.kind!r}: expected one of {', '.join(KINDS)}")
        if self.kind != RemedyKind.RELAX and (self.frame is not None or self.limit is not None):
            raise ServerError(f"remedy {self.kind} has no frame and no limit: they are for relax")
        check_frame(self.frame, rig)
        if self.limit is not None and self.limit not in LIMITS:
            raise ServerError(f"limit {self.limit!r}: expected one of {', '.join(LIMITS)}")

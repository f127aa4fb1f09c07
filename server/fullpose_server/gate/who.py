"""Who may stop a rig, as the gate was told: anybody signed in, whatever their role.

Before the server has told it, and while it cannot, whoever asks is let in: a stop does nothing that is worse than none.
"""

import time

from fullpose_server.api.problems import ApiError
from fullpose_server.gate.messages import LetIn
from fullpose_server.people.admitted import STOPS_AFTER_S, Admitted, Credential, shown_by


class Who:
    """As told last."""

    def __init__(self) -> None:
        self._admitted: Admitted | None = None
        self._coming: list[Credential] = []

    def take(self, told: LetIn) -> None:
        """A part of what the server tells; with the last part it is in force."""
        self._coming = [*([] if told.first else self._coming), *told.credentials]
        if told.last:
            self._admitted = Admitted(told.people, self._coming)
            self._coming = []

    def admit(self, authorization: str | None, cookie: str | None) -> Credential | None:
        """Who asks; None: nobody known, and nobody need be. Raises `ApiError`."""
        if self._admitted is None or not self._admitted.people:
            return None
        found = self._admitted.find(shown_by(authorization, cookie), time.time() - STOPS_AFTER_S)
        if found is None:
            raise ApiError(401, "sign-in", "a stop is for those who are signed in: sign in, or show a token")
        return found

"""What can go wrong between the server and a rig process."""

from fullpose_server.runtime.contract import messages


class HostError(Exception):
    """The rig process cannot be started or reached; the message holds the end of its log where there is one."""


class RigUnreachableError(Exception):
    """The rig process does not answer: gone, or stuck. The message says which."""


class RequestTooLargeError(ValueError):
    """A request that the rig process would not read whole: its size and the most that is read are in the message."""


class RefusedError(Exception):
    """The rig process refused; `reply` has the code and what is allowed."""

    def __init__(self, reply: messages.Reply) -> None:
        super().__init__(reply.error.message if reply.error else "refused")
        self.reply = reply

"""The planner of a live preview, a child of the rig process.

`python -m fullpose_server.runtime.live.planner_process --fd N`

It takes one pickled job (`fullpose.plan.Replan`) a message and answers with the way (`fullpose.plan.Ahead`). It has
no real-time priority and ends with the socket, so with the rig process.
"""

import argparse
import contextlib
import os
import pickle
import signal
import socket

_NICE = -10  # behind the loop, before what else the machine does: a way that comes late is of less use
MESSAGE = 1 << 20  # bytes, more than any job: two seconds of known attitude are some 40 kB


def main() -> None:
    """Answer until the other end is closed."""
    parser = argparse.ArgumentParser(description="Plans ahead for one rig's loop.")
    parser.add_argument("--fd", type=int, required=True)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # as the rig process: its end is ours
    with contextlib.suppress(PermissionError):
        os.nice(_NICE)
    with socket.socket(fileno=parser.parse_args().fd) as link:
        while data := link.recv(MESSAGE):
            link.sendall(pickle.dumps(pickle.loads(data).run(), protocol=5))


if __name__ == "__main__":
    main()

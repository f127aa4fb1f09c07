"""The stop gate's process, `python -m fullpose_server.gate.process --listener FD --link FD --beat FD`.

The server starts it, and another in reserve; it ends with the server.
"""

import argparse
import asyncio
import signal
import socket

from fullpose_server.gate.beat import Beat
from fullpose_server.gate.gate import Gate
from fullpose_server.gate.system import GATE, before_others, files
from fullpose_server.logs import LogFormat, LogLevel, LogSettings, configure


def main() -> None:
    """Run until the server is gone."""
    arguments = argparse.ArgumentParser(description="The stop gate of one server.")
    arguments.add_argument("--listener", type=int, required=True)
    arguments.add_argument("--link", type=int, required=True)
    arguments.add_argument("--beat", type=int, required=True, help="memory for its sign of life")
    arguments.add_argument("--proxy", action="append", default=[], help="who may say for whom they ask")
    arguments.add_argument("--log-format", type=LogFormat, required=True)
    arguments.add_argument("--log-level", type=LogLevel, required=True)
    given = arguments.parse_args()
    configure(LogSettings(given.log_format, given.log_level))
    # A rig that brakes while the server ends, or that flies while Ctrl-Z suspends it, can still be stopped.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    before_others(GATE)
    listener, link = socket.socket(fileno=given.listener), socket.socket(fileno=given.link)
    listener.setblocking(False)
    beat = Beat(given.beat)

    async def gate() -> None:
        await Gate(listener, link, files(), given.proxy).run(beat.say)

    asyncio.run(gate())


if __name__ == "__main__":
    main()

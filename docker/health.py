"""The container's health check: whether the server answers, and whether every process of its own does.

A full disk or a rig file with a mistake degrades /alive, and is no reason to take a server for dead or to keep its
proxy from starting: what counts here is a planner, a rig's process or a recorder that is not there. It says which, and
exits with 1.
"""

import json
import os
import sys
import urllib.request

TIMEOUT_S = 4.0


def main() -> int:
    """Ask once; what needs no sign-in."""
    url = f"http://127.0.0.1:{os.environ['FULLPOSE_PORT']}/api/v1/alive"
    try:
        with urllib.request.urlopen(url, timeout=TIMEOUT_S) as answer:
            found = json.load(answer)["dead"]
    except (OSError, ValueError, KeyError) as error:
        print(f"the server does not answer: {error}")  # noqa: T201 - for `docker inspect`
        return 1
    print(f"dead: {', '.join(found)}" if found else "ok")  # noqa: T201
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

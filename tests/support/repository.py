"""Where things are in the repository, for tests that read its files or run its programs."""

import os
from pathlib import Path

ROOT = Path(__file__).parents[2]
FLIGHTS = ROOT / "examples" / "flights"
SCENARIOS = ROOT / "examples" / "scenarios"
# For processes that tests start: the packages as they are in this tree.
PYTHONPATH = os.pathsep.join(str(ROOT / folder) for folder in ("solver", "server"))

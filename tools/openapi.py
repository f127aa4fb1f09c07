"""Writes docs/openapi.json, the committed contract. Run: python -m tools.openapi"""

import json
from pathlib import Path

from fullpose_server.app import create_app
from fullpose_server.settings import Settings


def main() -> None:
    """Write the contract of the app as it is now."""
    target = Path(__file__).parents[1] / "docs" / "openapi.json"
    document = create_app(Settings()).openapi()
    target.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

"""Writes docs/rig.schema.json, the rig file's JSON schema, for editors. Run: python -m tools.rig_schema"""

import json
from pathlib import Path
from typing import Any

from fullpose_server.formats.rig_document import RigDocument

TARGET = Path(__file__).parents[1] / "docs" / "rig.schema.json"


def schema() -> dict[str, Any]:
    """The schema as the code has it now."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | RigDocument.model_json_schema()


def main() -> None:
    """Write it."""
    TARGET.write_text(json.dumps(schema(), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

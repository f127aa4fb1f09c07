"""A checked document as the text of a TOML file."""

import json
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel


def toml(document: BaseModel) -> str:
    """A document as a file: what was given, and nothing that is left to its default."""
    said = document.model_dump(mode="json", exclude_unset=True, exclude_none=True)
    return "\n".join(_lines(said, ())).lstrip() + "\n"


def _lines(table: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
    if path and plain:
        yield from ("", f"[{'.'.join(path)}]")
    for key, value in plain.items():
        yield f"{key} = {json.dumps(value, ensure_ascii=False)}"  # of text, numbers, truths and lists TOML's form, too
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _lines(value, (*path, key))

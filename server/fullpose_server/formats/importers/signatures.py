"""By which bytes a file is told. No library is loaded for it."""

import io

PARQUET = b"PAR1"


def is_text(head: bytes) -> bool:
    """Whether the bytes are UTF-8 but for a character cut off at the end; Latin-1 letters in a comment are text too."""
    if b"\0" in head:
        return False
    try:
        io.TextIOWrapper(io.BytesIO(head), encoding="utf-8").read()
    except UnicodeDecodeError as error:
        if error.start >= len(head) - 4:
            return True
        control = sum(byte < 9 or 13 < byte < 32 for byte in head)
        return control == 0 and sum(byte > 127 for byte in head) < len(head) // 20
    return True

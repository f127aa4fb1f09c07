"""Text as a person sees all of it: byte order marks, blanks of no width and full-width signs are written out."""

import unicodedata

_FULL_WIDTH = range(0xFF01, 0xFF66)  # full-width commas, digits and letters look like the plain ones


def visible(text: str) -> str:
    """The text with what cannot be seen, or is taken for something else, as escapes: '\\ufefftime_s'."""
    return "".join(_escape(sign) if _deceives(sign) else sign for sign in text)


def without_invisible(text: str) -> str:
    """The text without signs of no width: byte order marks, joiners, soft hyphens."""
    return "".join(sign for sign in text if unicodedata.category(sign) != "Cf")


def _deceives(sign: str) -> bool:
    if sign.isascii():
        return not sign.isprintable()
    kind = unicodedata.category(sign)
    return kind in ("Cf", "Cc", "Cs", "Co", "Zs", "Zl", "Zp") or ord(sign) in _FULL_WIDTH or sign in "、。‚٫−"


def _escape(sign: str) -> str:
    return sign.encode("unicode_escape").decode("ascii")

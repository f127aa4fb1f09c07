"""Tags and notes that people put to flights, plans and runs, and how those are found again."""

from collections.abc import Iterable
from dataclasses import dataclass

from fullpose_server.errors import ServerError

MOST_TAGS = 32
LONGEST_TAG = 40
LONGEST_NOTES = 4000
MOST_WORDS = 16
_EDGE = "\x1f"  # around every tag in a search text; nothing else in one has it


class LabelError(ServerError):
    """A tag, or notes, that cannot be."""


@dataclass(frozen=True)
class Labels:
    """Of one thing. Two tags that differ in capitals only are one."""

    tags: tuple[str, ...] = ()
    notes: str = ""


NO_LABELS = Labels()


def labels_of(tags: Iterable[str], notes: str) -> Labels:
    """As people gave them: in their order, each once. Raises `LabelError`."""
    found: dict[str, str] = {}
    for tag in tags:
        if not 1 <= len(tag) <= LONGEST_TAG or not tag.isprintable() or tag != tag.strip() or "," in tag:
            raise LabelError(
                f"tag {tag[:50]!r}: expected 1 to {LONGEST_TAG} printable characters without a comma, and no blank at"
                " either end"
            )
        found.setdefault(tag.casefold(), tag)
    if len(found) > MOST_TAGS:
        raise LabelError(f"{len(found)} tags: expected at most {MOST_TAGS}")
    if len(notes) > LONGEST_NOTES:
        raise LabelError(f"notes of {len(notes)} characters: expected at most {LONGEST_NOTES}")
    wrong = next((letter for letter in notes if not letter.isprintable() and letter not in "\n\t"), None)
    if wrong is not None:
        raise LabelError(f"notes with the character {wrong!r}: expected printable ones, tabs and line ends")
    return Labels(tuple(found.values()), notes)


def search_text(labels: Labels, *texts: str) -> str:
    """What a thing is searched by: its texts, its notes and its tags, whatever their capitals."""
    said = "\n".join([*texts, labels.notes]).replace(_EDGE, " ")
    return (said + _EDGE + "".join(f"{tag}{_EDGE}" for tag in labels.tags)).casefold()


@dataclass(frozen=True)
class Wanted:
    """What is looked for; `parts` are all to be in a search text."""

    parts: tuple[str, ...] = ()

    @classmethod
    def of(cls, words: str | None, tag: str | None) -> "Wanted":
        """Every word of `words`, in any order and anywhere; and the tag, all of it. Raises `LabelError`."""
        found = [] if words is None else words.replace(_EDGE, " ").casefold().split()
        if len(found) > MOST_WORDS:
            raise LabelError(f"a search for {len(found)} words: expected at most {MOST_WORDS}")
        if tag is not None:
            found.append(f"{_EDGE}{tag.casefold()}{_EDGE}")
        return cls(tuple(found))

    def fits(self, text: str) -> bool:
        """Whether it is what is looked for."""
        return all(part in text for part in self.parts)


EVERYTHING = Wanted()

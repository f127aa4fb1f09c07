"""Tags and notes as people give them, and what is found by them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.formats.labels import NO_LABELS, LabelError, Labels, Wanted, labels_of, search_text


def test_tags_are_each_once_in_their_order() -> None:
    assert labels_of(["b", "A", "a", "c d"], "n") == Labels(("b", "A", "c d"), "n")


@pytest.mark.parametrize("tag", ["", " a", "a ", "a,b", "a\nb", "a\x1fb", "x" * 41, "\0"])
def test_a_tag_that_cannot_be_is_named(tag: str) -> None:
    with pytest.raises(LabelError, match="expected 1 to 40"):
        labels_of([tag], "")


def test_more_than_can_be_is_refused() -> None:
    with pytest.raises(LabelError, match="33 tags"):
        labels_of([f"{k}" for k in range(33)], "")
    for notes in ("x" * 4001, "a\0b", "a\x1fb"):
        with pytest.raises(LabelError, match="notes"):
            labels_of([], notes)
    with pytest.raises(LabelError, match="17 words"):
        Wanted.of("a " * 17, None)


TAGS = st.lists(st.sampled_from(["red", "Blue", "blueish", "red blue", "ß"]), unique_by=str.casefold, max_size=4)


@given(TAGS, st.text(max_size=20), st.sampled_from(["red", "BLUE", "blu", "blue", "SS", "red blue"]))
def test_a_tag_is_found_where_it_is_and_nowhere_else(tags: list[str], name: str, asked: str) -> None:
    found = Wanted.of(None, asked).fits(search_text(Labels(tuple(tags)), name))
    assert found is (asked.casefold() in [tag.casefold() for tag in tags])


@given(st.text(max_size=20), st.text(max_size=5))
def test_words_are_found_where_python_finds_them(name: str, words: str) -> None:
    said = search_text(NO_LABELS, name)
    wanted = all(word in name.casefold() for word in words.casefold().split() if "\x1f" not in word + name)
    if "\x1f" not in name + words:
        assert Wanted.of(words, None).fits(said) is wanted

"""Flights and plans are found by words and tags, page by page; both databases find the same."""

from pathlib import Path

import pytest

from fullpose_server.errors import NotFoundError
from fullpose_server.formats.labels import Labels, Wanted
from fullpose_server.store.keyset import Key
from tests.support.flown import FLIGHT
from tests.support.stores import Stores

NAMES = ("Überflug 1", "loop 100%", "loop_2", "LOOP [3]", "straße", "O'Hara; --", "a/b\\c")


def flights(stores: Stores, names: tuple[str, ...] = NAMES) -> dict[str, str]:
    """Flights of these names: their hashes, by name."""
    head, first, rest = FLIGHT.partition("\n")
    found = {}
    for number, name in enumerate(names):
        lines = rest.splitlines()
        last = lines[-1].split(",")
        lines[-1] = ",".join([*last[:-1], f"{float(last[-1]) + 0.01 * number}"])
        found[name] = stores.add_flight(head + first + "\n".join(lines) + "\n", name)
    return found


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("überFLUG", {"Überflug 1"}),
        ("loop", {"loop 100%", "loop_2", "LOOP [3]"}),
        ("100%", {"loop 100%"}),
        ("%", {"loop 100%"}),
        ("_", {"loop_2"}),
        ("p_2", {"loop_2"}),
        ("[3] loop", {"LOOP [3]"}),
        ("STRASSE", {"straße"}),
        ("o'hara; --", {"O'Hara; --"}),
        ("a/b\\c", {"a/b\\c"}),
        ("nothing of the kind", set()),
        ("", set(NAMES)),
    ],
)
def test_words_are_found_as_they_are(stores: Stores, words: str, names: set[str]) -> None:
    flights(stores)
    assert {row.name for row in stores.trajectories.all(wanted=Wanted.of(words, None))} == names


def test_tags_are_found_whole_and_words_of_notes_too(stores: Stores) -> None:
    made = flights(stores, ("one", "two"))
    stores.trajectories.label(made["one"], Labels(("Blue", "red"), "flown on Monday"))
    stores.trajectories.label(made["two"], Labels(("blueish",), "one more"))

    def names(words: str | None, tag: str | None = None) -> list[str]:
        return [row.name for row in stores.trajectories.all(wanted=Wanted.of(words, tag))]

    assert names(None, "blue") == ["one"]
    assert names(None, "BLUE") == ["one"]
    assert names("blue") == ["two", "one"]
    assert names("monday RED", "blue") == ["one"]
    assert names("one") == ["two", "one"]
    stores.trajectories.label(made["one"], Labels())
    assert names(None, "blue") == []
    with pytest.raises(NotFoundError):
        stores.trajectories.label("0" * 64, Labels())


def test_a_search_has_pages_like_any_list(stores: Stores) -> None:
    made = flights(stores, tuple(f"{'even' if k % 2 == 0 else 'odd'} {k}" for k in range(8)))
    wanted, before, seen = Wanted.of("even", None), None, []
    while page := stores.trajectories.all(before, 3, wanted):
        seen += [row.name for row in page]
        before = Key(page[-1].created, page[-1].sha256)
    assert seen == ["even 6", "even 4", "even 2", "even 0"]
    assert len(made) == 8


def test_a_plan_is_found_by_its_own_and_its_flight_s_words(stores: Stores, tmp_path: Path) -> None:
    made = flights(stores, ("loop", "dive"))
    loop, dive = (stores.add_plan(made[name], "exact") for name in ("loop", "dive"))
    stores.plans.label(dive, Labels(("release",), "for Friday"))

    def ids(words: str | None, tag: str | None = None) -> list[str]:
        return [row.id for row, _ in stores.plans.all(wanted=Wanted.of(words, tag))]

    assert ids("loop") == [loop]
    assert ids("exact") == [dive, loop]
    assert ids("dive friday vertical-4") == [dive]
    assert ids(None, "Release") == [dive]
    assert stores.plans.of_wanted("loop") == {loop}
    assert stores.plans.of_wanted("exact", {dive, "none"}) == {dive}
    assert stores.plans.of_wanted("exact", set()) == frozenset()
    assert stores.plans.get(dive).tags == ["release"]
    with pytest.raises(NotFoundError):
        stores.plans.label("none", Labels())

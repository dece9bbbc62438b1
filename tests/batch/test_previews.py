"""Previews: of the worst layouts, of a sweep one, with the part, its contacts and the evidence in words."""

import json
from pathlib import Path

import numpy as np

from fixture_design.batch import input_files
from fixture_design.batch.outcome import OUTCOMES
from fixture_design.batch.previews import deviations_in_words, previews
from fixture_design.batch.sweep import Deviations
from fixture_design.batch.worst import MOST_PREVIEWS, worst_numbers
from fixture_design.layout import Layout, Verdict
from fixture_design.verification.found import FoundContacts
from fixture_design.viewing.markup import Markup, tag
from tests.batch.layouts import FAILS, HOLDS, lines, planar
from tests.batch.test_alike import LAYOUT, on_box
from tests.batch.test_output import run
from tests.batch.test_pages import failed, record


def drawn(tmp_path: Path, layouts: list[object]) -> str:
    library = lines(tmp_path / "lib.jsonl", layouts)
    _, records = run(library, tmp_path / "o.jsonl", detail="full")
    return previews(worst_numbers(records), input_files([library])) or ""


def test_the_worst_are_no_then_undecided_then_small_margins() -> None:
    records = [
        record("a", "yes", 0.3), failed("b"), record("c", "undecided", 0.0), record("d", "no", -0.1),
        record("e", "no", -0.2), record("f", "yes", 0.01), record("g", None, None),
    ]  # fmt: skip
    assert worst_numbers(records) == [4, 3, 2, 6, 5, 0]
    assert OUTCOMES.index("nothing required") < OUTCOMES.index("yes")
    assert worst_numbers(records, 2) == [4, 3]
    assert worst_numbers([failed("b")]) == []


def test_a_sweep_is_drawn_once() -> None:
    many = [record(f"s[{n}]", "no", -1.0 - n, source="s.yaml") for n in range(100)]
    found = worst_numbers([record("a", "no", -0.5), *many, record("b", "no", -150.0)])
    assert found == [101, 100, 0]


def test_only_so_many_and_in_bounded_memory() -> None:
    records = (record(f"n{n}", "no", -((n * 7919) % 1000) / 1e3) for n in range(1000))
    found = worst_numbers(records)
    assert len(found) == MOST_PREVIEWS
    assert [(n * 7919) % 1000 for n in found] == list(range(999, 999 - MOST_PREVIEWS, -1))


def test_a_card_has_the_contacts_and_the_reason(tmp_path: Path) -> None:
    text = drawn(tmp_path, [planar("good", require=HOLDS), planar("loose <b>", require=FAILS), "{"])
    first, second = text.split("<article>")[1:]
    assert "loose &lt;b&gt;" in first
    assert "can move" in first
    assert first.count("<circle") == 3
    assert "lib.jsonl:2" in first
    assert "good" in second


def test_a_part_is_drawn_with_its_edges(tmp_path: Path) -> None:
    layout = on_box(tmp_path, np.random.default_rng(3), name="b", require={"all": ["form_closure"]})
    text = drawn(tmp_path, [layout])
    assert text.count("<svg") == 3
    assert text.count("<circle") == 3 * 9
    paths = [piece.split('"')[1] for piece in text.split("<path ")[1:]]
    assert [path.count("M") for path in paths] == [4, 4, 4]  # a box from three sides


def test_a_variant_says_how_far_it_is_off(tmp_path: Path) -> None:
    text = drawn(tmp_path, [planar("s", require=FAILS, sweep={"at": 0.2, "friction": [0.1, 0.1], "samples": 3})])
    assert text.count("<article>") == 1
    assert "Off what the layout says: P2 by (" in text
    off = Deviations(np.array([0.001, 0, 0, 0, 0, np.pi / 180]), {"A": np.array([0, 2e-5, 0]), "B": np.zeros(3)}, 0.25)
    assert deviations_in_words(off) == (
        "the part by (1, 0, 0) mm; the part turned by (0, 0, 1) degrees; A by (0, 0.02, 0) mm; friction 0.25"
    )


def test_a_file_that_is_another_one_by_now_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps(planar("a", require=FAILS)))
    _, records = run(tmp_path / "a.json", tmp_path / "o.jsonl")
    (tmp_path / "a.json").write_text(json.dumps({"schema": LAYOUT}))
    text = previews(worst_numbers(records), [tmp_path / "a.json"])
    assert text is not None
    assert "a.json" in text
    assert "<svg" not in text


def test_another_drawing_may_take_its_place(tmp_path: Path) -> None:
    library = lines(tmp_path / "lib.jsonl", [planar("a", require=FAILS)])
    _, records = run(library, tmp_path / "o.jsonl")

    def draw(layout: Layout, found: FoundContacts, verdict: Verdict) -> Markup:
        return tag("canvas", layout.name, len(found.contacts), verdict.satisfied)

    assert "<canvas>a3no</canvas>" in (previews(worst_numbers(records), [library], draw) or "")

"""Sweeps of layouts on a part: elements that are off its surface touch it all the same, and the records say so."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from fixture_design.batch.alike import Alike
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.items import items_of
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.reading import layout_of
from fixture_design.batch.records import Detail, Looked, entry_of, look_at
from fixture_design.tolerances import SURFACE_GAP
from tests.batch.test_alike import LAYOUT, REQUIRE, compare, on_box, record

AT = 1e-3


def together(items: Sequence[Item], parts: PartCache, detail: Detail) -> dict[int, Entry]:
    waiting = {place: looked for place, item in enumerate(items) if isinstance(looked := look_at(item, parts), Looked)}
    assert len(waiting) == len(items)
    return dict(Alike(detail).entries_of_found(waiting, items))


@pytest.mark.parametrize("detail", ["brief", "full"])
def test_displaced_elements_touch_and_the_record_tells_the_gap(tmp_path: Path, detail: Detail) -> None:
    sweep = {"part_pose": {"xyz": [AT, 0, 0], "rpy": [0, 0, 0.01]}, "at": AT, "samples": 20, "seed": 2}
    layout = on_box(tmp_path, np.random.default_rng(8), name="b", require=REQUIRE, sweep=sweep)
    (tmp_path / "b.json").write_text(json.dumps(layout))
    parts, gaps = PartCache(), set()
    items = list(items_of([tmp_path / "b.json"]))
    known = together(items, parts, detail)
    assert len(known) > 15
    for place, item in enumerate(items):
        expected = record(entry_of(item, parts, detail).line)
        found = record(known[place].line) if place in known else expected
        assert list(found["run"])[-2:] == ["surface_gap", "input"]
        gap = found["run"]["surface_gap"]
        assert gap == expected["run"]["surface_gap"] == layout_of(item).surface_gap
        assert SURFACE_GAP < gap <= SURFACE_GAP + AT * (1 + 3**0.5) + 0.01 * np.linalg.norm([0.1, 0.08, 0.05])
        gaps.add(gap)
        if detail == "full":
            compare(found, expected)
            assert max(contact["distance"] for contact in found["contacts"]) <= gap
    assert len(gaps) == 20


def test_without_a_sweep_the_gap_is_the_layouts(tmp_path: Path) -> None:
    layout = on_box(tmp_path, np.random.default_rng(8), name="b", require=REQUIRE)
    (tmp_path / "b.json").write_text(json.dumps(layout))
    (item,) = items = list(items_of([tmp_path / "b.json"]))
    for entry in (*together(items, PartCache(), "brief").values(), entry_of(item, PartCache(), "brief")):
        assert "surface_gap" not in record(entry.line)["run"]


def test_bodies_alone_may_be_swept(tmp_path: Path) -> None:
    box = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    (tmp_path / "box.urdf").write_text(f'<robot name="box"><link name="b">{box}</link></robot>')
    table = {"name": "table", "role": "locator", "urdf": "box.urdf", "pose": {"xyz": [0, 0, -0.1]}}
    sweep = {"part_pose": {"xyz": [0.01, 0, 0]}}
    layout = {"schema": LAYOUT, "part": {"urdf": "box.urdf"}, "bodies": [table], "sweep": sweep}
    (tmp_path / "b.json").write_text(json.dumps(layout))
    found = [record(entry_of(item, PartCache(), "full").line) for item in items_of([tmp_path / "b.json"])]
    assert [each["name"] for each in found] == ["b[0]", "b[1]", "b[2]"]
    assert [len(each["contacts"]) for each in found] == [4, 4, 4]

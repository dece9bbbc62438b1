"""Variants: within their ranges, each by its number alone, and all of a grid."""

import json
from pathlib import Path

import numpy as np
import pytest

from fixture_design.batch.items import items_of
from fixture_design.batch.reading import layout_of
from fixture_design.batch.sweep import deviations_of, variant_count, variant_of
from fixture_design.errors import InputError
from fixture_design.io import layout_from_data
from fixture_design.io.layout_writing import layout_data
from fixture_design.layout import Layout
from fixture_design.tolerances import SURFACE_GAP
from tests.batch.layouts import LAYOUT, planar


def layout(sweep: dict[str, object], **keys: object) -> Layout:
    return layout_from_data(planar(sweep=sweep, **keys), "x.yaml")


def on_part(sweep: dict[str, object]) -> Layout:
    elements = [{"name": "L1", "role": "locator", "at": [0.1, 0, 0]}]
    part = {"mesh": "a.stl", "pose": {"xyz": [0, 0, 1]}}
    return layout_from_data({"schema": LAYOUT, "part": part, "elements": elements, "sweep": sweep}, "x.yaml")


def test_samples_stay_within_and_reach_out() -> None:
    given = layout({"at": 0.1, "friction": [0.1, 0.3], "samples": 200, "seed": 3})
    assert variant_count(given) == 200
    variants = [variant_of(given, k) for k in range(200)]
    off = np.array([[c.point - g.point for c, g in zip(v.contacts, given.contacts, strict=True)] for v in variants])
    friction = np.array([v.friction for v in variants])
    assert 0.09 < np.abs(off).max() <= 0.1
    assert np.abs(off.mean(axis=0)).max() < 0.02
    assert 0.1 <= friction.min() < 0.11
    assert 0.29 < friction.max() <= 0.3
    assert all(contact.friction == v.friction for v in variants for contact in v.contacts)


def test_a_variant_depends_on_seed_and_number_alone() -> None:
    def points(seed: int, number: int) -> list[list[float]]:
        return [c.point.tolist() for c in variant_of(layout({"at": 1, "samples": 9, "seed": seed}), number).contacts]

    assert points(1, 5) == points(1, 5)
    assert points(1, 5) != points(1, 6)
    assert points(1, 5) != points(2, 5)


def test_a_grid_has_all_combinations_once() -> None:
    given = on_part({"part_pose": {"xyz": [0.001, 0, 0.002], "rpy": [0, 0.1, 0]}})
    assert variant_count(given) == 27
    poses = [variant_of(given, k).part.pose for k in range(27)]  # type: ignore[union-attr]
    moved = {tuple(np.round(pose.translation - [0, 0, 1], 9).tolist()) for pose in poses}
    assert moved == {(x, 0.0, z) for x in (-0.001, 0.0, 0.001) for z in (-0.002, 0.0, 0.002)}
    turned = {round(float(np.arctan2(pose.rotation[0, 2], pose.rotation[0, 0])), 9) for pose in poses}
    assert turned == {-0.1, 0.0, 0.1}


def test_what_is_moved_off_the_surface_still_touches() -> None:
    """The gap grows by the way that the element makes against the part, whatever moves."""
    given = on_part({"part_pose": {"xyz": [0, 0, 0.002], "rpy": [0.01, 0.02, 0.03]}, "at": 0.001})
    assert variant_count(given) == 3**7
    for number in range(0, 3**7, 31):
        variant = variant_of(given, number)
        assert variant.part is not None
        off = variant.part.pose.rotation @ np.array([0.1, 0, -1]) + variant.part.pose.translation
        way = float(np.linalg.norm(off - variant.elements[0].at))
        assert variant.surface_gap == pytest.approx(given.surface_gap + way, abs=1e-15)


def test_only_what_moves_against_the_part_needs_a_gap() -> None:
    assert variant_of(on_part({"friction": [0, 1], "samples": 1}), 0).surface_gap == SURFACE_GAP
    contacts = [{"name": "Q", "role": "locator", "point": [1, 0], "normal": [0, 1]}]
    given = layout({"at": 0.1, "samples": 1}, contacts=contacts)
    assert variant_of(given, 0).surface_gap == SURFACE_GAP
    assert variant_of(layout({}, contacts=[]), 0).contacts == ()


def test_deviations_are_what_a_variant_changes() -> None:
    given = on_part({"part_pose": {"xyz": [0.001, 0, 0]}, "at": 0.002, "friction": [0.1, 0.3], "samples": 5})
    off, variant = deviations_of(given, 3).as_dict(), variant_of(given, 3)
    assert variant.part is not None
    assert off["part_pose"] == {"xyz": [pytest.approx(variant.part.pose.translation[0]), 0, 0], "rpy": [0, 0, 0]}
    assert off["at"] == {"L1": pytest.approx((variant.elements[0].at - given.elements[0].at).tolist())}
    assert off["friction"] == variant.friction
    assert deviations_of(layout({}), 0).as_dict() == {}
    assert deviations_of(
        layout({"part_pose": {"theta": 1}}, part={"polygon": [[0, 0], [1, 0], [0, 1]]}), 0
    ).as_dict() == {"part_pose": {"xy": [0, 0], "theta": -1}}


@pytest.mark.parametrize("own", [0.5, 0.2])
def test_friction_of_its_own_stays(own: float) -> None:
    """Also where it is the layout's number."""
    contacts = [{"name": "Q", "role": "clamp", "point": [0, 0], "normal": [0, 1], "friction": own}]
    given = layout({"friction": [0.1, 0.3], "samples": 1}, contacts=contacts, friction=0.2)
    variant = variant_of(given, 0)
    assert variant.friction != 0.2
    assert variant.contacts[0].friction == own
    assert layout_data(given, Path())["contacts"][0]["friction"] == own


def test_an_empty_sweep_is_one_variant() -> None:
    assert variant_count(layout({})) == 1


@pytest.mark.parametrize(
    ("sweep", "words"),
    [
        ({"at": 0.1, "friction": [0.1, 0.2], "part_pose": {"xy": [1, 1]}}, "moves the part, and there is none"),
    ],
)
def test_wrong_sweeps(sweep: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        variant_count(layout(sweep))


def test_a_grid_may_not_explode(tmp_path: Path) -> None:
    contacts = [{"name": f"Q{k}", "role": "clamp", "point": [k, 0], "normal": [0, 1]} for k in range(9)]
    file = tmp_path / "x.json"
    file.write_text(json.dumps(planar(contacts=contacts, sweep={"at": 0.1})))
    (item,) = items_of([file])
    with pytest.raises(InputError, match=r"grid of 3\^18 variants.*samples"):
        layout_of(item)


def test_variants_are_numbered_items(tmp_path: Path) -> None:
    file = tmp_path / "x.json"
    file.write_text(json.dumps(planar("fig", sweep={"at": 0.1, "samples": 3})))
    items = list(items_of([file]))
    assert [layout_of(item).name for item in items] == ["fig[0]", "fig[1]", "fig[2]"]
    assert {item.source for item in items} == {str(file)}
    assert sum(item.share for item in items) == pytest.approx(file.stat().st_size)

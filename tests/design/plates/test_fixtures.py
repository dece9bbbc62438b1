"""What fixtures on a plate are: laws, verification, layouts, choice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from scipy.spatial import KDTree

from fixture_design.design.plates import (
    Clamp,
    Fixtures,
    Plate,
    best_fixture,
    enumerate_fixtures,
    fixture_layout,
    locating_error,
    reaction,
)
from fixture_design.io import read_layout, write_layout
from fixture_design.layout import Answer
from fixture_design.tolerances import DEFAULT
from fixture_design.verification import verify
from tests.design.plates.keys import keys_of
from tests.design.plates.polygons import SPECIAL, random_case, rotation

PLATE = Plate(0.025, 6, 5, 0.005, Clamp(0.004, shortest=0.01))
#: In metres; a turned letter with notches on two sides.
PART = 0.025 * np.array([[0, 0], [3.1, 0.2], [3.0, 2.9], [1.9, 2.4], [1.6, 1.2], [0.7, 1.3], [0.4, 2.6]])


def found_on(plate: Plate = PLATE, margin: float = 0.001, part: np.ndarray = PART) -> Fixtures:
    return enumerate_fixtures(part, plate, margin)


def assert_among(some: np.ndarray, all_of_them: np.ndarray, same: float = 1e-7) -> None:
    away, partner = KDTree(all_of_them).query(some, p=np.inf)
    assert away.max() < same
    assert len(set(partner.tolist())) == len(some)


def test_moving_the_part_in_its_frame_changes_nothing() -> None:
    moved = PART @ rotation(0.7).T + [0.4, -0.2]
    keys, others = keys_of(found_on()), keys_of(found_on(part=moved))
    others[:, 8:10] = others[:, 8:10] @ rotation(0.7)
    assert len(keys) == len(others) > 100
    # the margin is about the bounding box in that frame
    assert_among(others[:, :11], keys[:, :11])


def test_far_from_the_origin_of_its_frame() -> None:
    """The part's coordinates keep ten digits there; so do the fixtures."""
    keys, others = keys_of(found_on()), keys_of(found_on(part=PART + 1e3))
    assert len(keys) == len(others)
    assert_among(others, keys, same=1e-6)


@pytest.mark.parametrize("factor", [1e-3, 40.0])
def test_another_unit_changes_nothing(factor: float) -> None:
    clamp = Clamp(0.004 * factor, shortest=0.01 * factor)
    scaled = Plate(0.025 * factor, 6, 5, 0.005 * factor, clamp)
    keys, others = keys_of(found_on()), keys_of(found_on(scaled, 0.001 * factor, PART * factor))
    lengths = [4, 5, 6, 7, 10]
    others[:, lengths] /= factor
    assert len(keys) == len(others)
    assert_among(others, keys)


def test_a_larger_plate_has_all_fixtures_of_a_smaller_one() -> None:
    small, large = keys_of(found_on(Plate(0.025, 5, 4, 0.005, PLATE.clamp))), keys_of(found_on())
    assert len(large) > len(small) > 0
    assert_among(small, large)


def test_a_plate_and_its_turned_one_have_the_same_fixtures() -> None:
    keys, turned = keys_of(found_on()), keys_of(found_on(Plate(0.025, 5, 6, 0.005, PLATE.clamp)))
    assert len(keys) == len(turned)
    assert_among(turned, keys)


def test_a_larger_margin_leaves_those_that_keep_it() -> None:
    wide = keys_of(found_on())
    lengths = np.linalg.norm(np.roll(PART, -1, axis=0) - PART, axis=1)[wide[:, :4].astype(int)]
    kept = ((wide[:, 4:8] > 0.004) & (wide[:, 4:8] < lengths - 0.004)).all(axis=1)
    narrow = keys_of(found_on(margin=0.004))
    assert 0 < len(narrow) == kept.sum() < len(wide)
    assert_among(narrow, wide)


def test_each_is_listed_once() -> None:
    keys = keys_of(found_on())
    assert not KDTree(keys).query_pairs(1e-7)


def test_a_symmetric_part_has_each_fixture_for_each_name_of_its_edges() -> None:
    """A square turned by 90 degrees is itself, with the next names for its edges and the plunger's next direction."""
    keys = keys_of(enumerate_fixtures(SPECIAL["square with room for tips"], Plate(1.0, 4, 4, 0.25)))
    renamed = keys.copy()
    renamed[:, :4] = (keys[:, :4] + 1) % 4
    renamed[:, 8:10] = np.column_stack([-keys[:, 9], keys[:, 8]])
    for row in renamed:
        order = np.lexsort((row[4:7], row[:3]))
        row[:3], row[4:7] = row[order], row[4 + order]
    assert_among(renamed, keys)
    assert_among(keys, renamed)


def test_everything_is_where_it_is_said_to_be() -> None:
    found = found_on()
    tips = found.points + found.normals * np.array([0.005, 0.005, 0.005, 0.004])[:, None]
    assert np.abs(tips[:, :3] - 0.025 * found.holes).max() < 1e-12
    behind = tips[:, 3] - 0.025 * found.clamp_holes
    along = np.einsum("ki,ki->k", behind, found.clamp_directions)
    assert np.abs(behind - along[:, None] * found.clamp_directions).max() < 1e-12
    assert ((along >= 0.01) & (along < 0.01 + 0.025)).all()
    every = np.concatenate([found.holes, found.clamp_holes[:, None]], axis=1)
    assert (every.min(axis=1) == 0).all()
    assert (every.max(axis=1) < [6, 5]).all()


def test_nothing_overlaps() -> None:
    """By the areas that shapely has for what a fixture is made of."""
    found = found_on()
    for index in range(0, len(found), 7):
        x, y = rotation(found.theta[index]) @ PART.T + found.translation[index][:, None]
        part = shapely.Polygon(np.column_stack([x, y]))
        tip = found.points[index, 3] + 0.004 * found.normals[index, 3]
        middle = shapely.LineString([tip, 0.025 * found.clamp_holes[index]])
        shapes = [shapely.Point(0.025 * hole).buffer(0.005) for hole in found.holes[index]] + [middle.buffer(0.004)]
        assert max(part.intersection(shape).area for shape in shapes) < 1e-9
        pairs = [(a, b) for a in range(4) for b in range(a)]
        assert max(shapes[a].intersection(shapes[b]).area for a, b in pairs) == 0


def test_verification_says_yes_with_the_same_margin() -> None:
    found = found_on()
    for index in [*range(0, len(found), 50), int(np.argmin(found.margin)), best_fixture(found)]:
        verdict = verify(fixture_layout(found, index))
        finding = verdict.groups["all"].findings["form_closure"]
        assert verdict.satisfied is Answer.YES
        assert finding.margin == pytest.approx(found.margin[index], rel=1e-7, abs=1e-9)
        assert verdict.groups["locators"].findings["form_closure"].answer is Answer.NO


def test_verification_says_yes_to_the_least_held() -> None:
    """Of all fixtures of the random polygons, those with the smallest margins."""
    cases = [enumerate_fixtures(*random_case(seed)) for seed in range(60)]
    worst = sorted((found.margin.min(), seed) for seed, found in enumerate(cases) if len(found))[:10]
    for margin, seed in worst:
        found = cases[seed]
        verdict = verify(fixture_layout(found, int(np.argmin(found.margin))))
        assert verdict.satisfied is Answer.YES, (margin, seed)
    assert worst[0][0] < 1e-3


def test_a_polygon_of_many_edges_is_no_arc() -> None:
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    found = enumerate_fixtures(np.column_stack([0.045 * np.cos(angles), 0.03 * np.sin(angles)]), PLATE)
    assert verify(fixture_layout(found, best_fixture(found))).satisfied is Answer.YES


def test_layouts_are_written_and_read(tmp_path: Path) -> None:
    found = found_on()
    layout = fixture_layout(found, best_fixture(found), "chosen", friction=0.2)
    write_layout(layout, tmp_path / "chosen.layout.yaml")
    read = read_layout(tmp_path / "chosen.layout.yaml")
    assert read.name == "chosen"
    assert read.friction == 0.2
    assert [element.role for element in read.elements] == ["locator"] * 3 + ["clamp"]
    assert verify(read).satisfied is Answer.YES


def test_the_best_by_each_quality() -> None:
    found = found_on()
    assert found.margin[best_fixture(found)] == found.margin.max()
    assert reaction(found)[best_fixture(found, by="reaction")] == reaction(found).min()
    assert locating_error(found)[best_fixture(found, by="locating_error")] == locating_error(found).min()


def test_reactions_balance_the_clamp() -> None:
    """About W's origin, with forces from least squares."""
    found = found_on()
    for index in range(0, len(found), 40):
        points, normals = found.points[index], found.normals[index]
        wrenches = np.column_stack([normals, points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]])
        forces = np.linalg.solve(wrenches[:3].T, -wrenches[3])
        assert (forces > 0).all()
        assert reaction(found)[index] == pytest.approx(forces.max())


def test_locating_error_bounds_the_parts_error() -> None:
    found = found_on()
    index = best_fixture(found, by="locating_error")
    half = np.linalg.norm(np.ptp(PART, axis=0)) / 2
    middle = (PART.min(axis=0) + PART.max(axis=0)) / 2
    center = rotation(found.theta[index]) @ middle + found.translation[index]
    arms, normals = found.points[index, :3] - center, found.normals[index, :3]
    rows = np.column_stack([normals, (arms[:, 0] * normals[:, 1] - arms[:, 1] * normals[:, 0]) / half])
    errors = np.random.default_rng(1).normal(size=(2000, 3))
    errors /= np.linalg.norm(errors, axis=1, keepdims=True)
    moves = np.linalg.norm(np.linalg.solve(rows, errors.T), axis=0)
    worst = locating_error(found)[index]
    assert 0.95 * worst < moves.max() <= worst * (1 + DEFAULT.tie)

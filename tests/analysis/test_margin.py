"""Margins against brute force: s is the smallest value of max_i d_i . u on the unit sphere."""

from itertools import product

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from fixture_design.analysis.bounds import bounds_of, closure_bound
from fixture_design.analysis.hull import nearest_facet
from fixture_design.analysis.margin import closure_margin, open_margin
from fixture_design.cones.kernel import tucker_partition
from fixture_design.contacts import Contact, Scale, constraints_of
from fixture_design.tolerances import DEFAULT


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def closed_rows(rng: np.random.Generator, dimension: int, count: int) -> np.ndarray:
    while True:
        rows = unit(rng.normal(size=(count, dimension)))
        if tucker_partition(rows, DEFAULT.tie).closes:
            return rows


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("dimension", "count"), [(3, 5), (3, 30), (6, 9), (6, 14), (6, 40)])
def test_margin_of_closed_rows(dimension: int, count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = closed_rows(rng, dimension, count)
    found = nearest_facet(rows)
    assert found is not None
    margin, motion = found.distance, found.motion
    assert margin * (1 - 1e-6) <= found.at_least <= margin
    assert np.max(rows @ motion) == pytest.approx(margin, abs=1e-12)
    sampled = np.max(rows @ unit(rng.normal(size=(20_000, dimension))).T, axis=0).min()
    assert 0 < margin <= sampled + 1e-12
    around = unit(motion + 1e-3 * rng.normal(size=(2_000, dimension)))
    assert np.max(rows @ around.T, axis=0).min() >= margin - 1e-12


@pytest.mark.parametrize("seed", range(8))
def test_a_growing_hull_finds_the_nearest_facet_of_the_whole(seed: int) -> None:
    """Nine friction cones of eight edges, as Qhull has all of their hull; and with rows that come twice."""
    rng = np.random.default_rng(seed)
    while True:
        normals, points = unit(rng.normal(size=(9, 3))), rng.uniform(-1, 1, size=(9, 3))
        turns = np.linspace(0, 2 * np.pi, 8, endpoint=False)
        first = unit(np.cross(normals, [0.3, 0.5, 0.8]))
        tangents = np.cos(turns)[:, None, None] * first + np.sin(turns)[:, None, None] * np.cross(normals, first)
        forces = normals + 0.2 * tangents
        rows = np.concatenate([forces, np.cross(np.broadcast_to(points, forces.shape), forces)], axis=2).reshape(-1, 6)
        if tucker_partition(unit(rows), DEFAULT.tie).closes:
            break
    whole = float((-ConvexHull(rows).equations[:, -1]).min())
    for each in (rows, np.vstack([rows, rows[:20]])):
        found = nearest_facet(each)
        assert found is not None
        assert found.distance == pytest.approx(whole, rel=1e-9)
        assert found.at_least <= found.distance


def test_a_hull_that_begins_flat_grows_from_all_rows() -> None:
    """The longest rows lie in a plane: what a hull would begin with has no inside."""
    turns = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(24)])
    found = nearest_facet(np.vstack([ring, [[0.01, 0.0, 0.5]], [[0.0, 0.01, -0.5]]]))
    assert found is not None
    assert found.distance == pytest.approx(0.44, abs=0.01)


@pytest.mark.parametrize("seed", range(20))
def test_margin_of_open_rows_is_the_distance_of_the_hull(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = unit(np.column_stack([rng.normal(size=(8, 5)), np.full(8, 1.5)]))
    margin, exact = open_margin(rows)
    sampled = np.max(rows @ unit(rng.normal(size=(20_000, 6))).T, axis=0).min()
    assert exact
    assert margin < 0
    assert margin <= sampled + 1e-12


@pytest.mark.parametrize("seed", range(30))
def test_bounds_enclose_the_margin(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = closed_rows(rng, 6, int(rng.integers(7, 15)))
    exact = nearest_facet(rows)
    assert exact is not None
    bounds = bounds_of(rows, np.zeros(len(rows)), DEFAULT)
    assert 0 < bounds.lower <= exact.distance + 1e-12
    assert bounds.weights is not None
    assert closure_bound(rows, bounds.weights) <= exact.distance + 1e-12
    # errors of the normals lower what is proved by at most their size
    wide = bounds_of(rows, np.full(len(rows), 1e-3), DEFAULT)
    assert wide.lower <= bounds.lower - 1e-3 + 1e-12


@pytest.mark.parametrize("seed", range(12))
def test_margin_of_many_branches_is_the_smallest_one(seed: int) -> None:
    """Best first finds what trying all branches finds."""
    rng = np.random.default_rng(seed)
    contacts = []
    for i in range(7):
        out = unit(rng.normal(size=(1, 2)))[0]
        alternatives = [(out + 0.5 * rng.normal(size=2)).tolist() for _ in range(1 + i % 3)]
        contacts.append(Contact.of(f"C{i}", "locator", out, [alternatives]))
    scale = Scale(np.zeros(2), 1.0)
    every = [
        closure_margin(
            constraints_of(
                [Contact.on_facet(c.name, "locator", c.point, n) for c, n in zip(contacts, normals, strict=True)], scale
            )
        )
        for normals in product(*(contact.normals for contact in contacts))
    ]
    assert closure_margin(constraints_of(contacts, scale)) == pytest.approx(min(m for m in every if m is not None))


def test_margin_of_a_union_is_that_of_its_worst_branch() -> None:
    square = [([1, 0], [1, 0.2]), ([-1, 0], [-1, 0.2]), ([0, 1], [0.3, 1]), ([0, -1], [0.3, -1])]
    single = [Contact.on_facet(f"C{i}", "locator", p, n) for i, (p, n) in enumerate(square)]
    either = Contact("E", "locator", np.array([1.0, 1.0]), ((np.array([1.0, 0.0]), np.array([0.0, 1.0])),))
    scale = Scale(np.zeros(2), 1.0)
    whole = closure_margin(constraints_of([*single, either], scale))
    parts = [
        closure_margin(constraints_of([*single, Contact("E", "locator", either.point, ((normal,),))], scale))
        for normal in either.normals
    ]
    assert whole == pytest.approx(min(p for p in parts if p is not None))

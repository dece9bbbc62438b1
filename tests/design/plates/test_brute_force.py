"""The same fixtures as by trying everything."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import KDTree

from fixture_design.design.plates import Plate, enumerate_fixtures
from tests.design.plates.brute_force import brute_force
from tests.design.plates.keys import keys_of
from tests.design.plates.polygons import SPECIAL, random_case

#: Keys that agree to this are of one fixture.
SAME = 1e-7


def assert_same(polygon: np.ndarray, plate: Plate, edge_margin: float) -> int:
    """One to one; returns how many there are."""
    found = keys_of(enumerate_fixtures(polygon, plate, edge_margin))
    tried = np.array(brute_force(polygon, plate, edge_margin)).reshape(-1, found.shape[1])
    assert len(found) == len(tried)
    if len(found):
        away, partner = KDTree(found).query(tried, p=np.inf)
        assert away.max() < SAME
        assert len(set(partner.tolist())) == len(found)
    return len(found)


def test_random_polygons() -> None:
    """On an oblong plate, where some fixtures only fit turned by 90 degrees."""
    counts = [assert_same(*random_case(seed, columns=4, rows=3)) for seed in range(20)]
    assert np.count_nonzero(counts) > 10


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(200))
def test_more_random_polygons(seed: int) -> None:
    assert_same(*random_case(seed))


@pytest.mark.parametrize("name", SPECIAL)
def test_special_polygons(name: str) -> None:
    """Parallel, equal and collinear edges; symmetric parts; corners on the grid."""
    rows = 3 if name == "U" else 4  # more edges take longer
    assert_same(np.array(SPECIAL[name], dtype=float), Plate(1.0, 3, rows, 0.25), 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.0, 0.1, 0.25])
@pytest.mark.parametrize("name", SPECIAL)
def test_special_polygons_on_more_holes(name: str, radius: float) -> None:
    assert_same(np.array(SPECIAL[name], dtype=float), Plate(1.0, 4, 4, radius), 0.1)

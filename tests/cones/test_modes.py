"""Contact modes: counts that are known, the bound for contacts in general position, witnesses, and noise."""

import numpy as np
import pytest
from hypothesis import assume, given, settings

from fixture_design.cones import convert_rows, kernel
from fixture_design.errors import ConeError
from tests import exact
from tests.strategies import Vectors, seeds, vector_sets

NOISES = (0.0, 1e-16, 1e-14, 1e-12, 1e-10)


def box_rows(walls: int) -> np.ndarray:
    """A unit cube's corners on the floor, two sides, then the ceiling and a third side: normals into the walls."""
    sides = [(2, -1), (1, -1), (0, -1), (0, 1), (1, 1)][:walls]
    rows = []
    for axis, sign in sides:
        for corner in np.ndindex(2, 2, 2):
            point = np.array(corner) - 0.5
            if np.sign(point[axis]) == sign:
                normal = sign * np.eye(3)[axis]
                rows.append([*normal, *np.cross(point, normal)])
    return np.array(rows)


def modes_of(rows: np.ndarray) -> kernel.Faces:
    unit = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    found = convert_rows(unit, np.zeros((0, rows.shape[1])))
    return kernel.faces_of(len(found.lines), found.vectors, found.incidence, rows.shape[1])


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize(("walls", "count"), [(1, 10), (3, 136), (5, 2)])
def test_a_box_on_walls(walls: int, count: int, noise: float):
    rows = box_rows(walls)
    assert len(kernel.exact_faces(rows, dimension=6)) == count
    noisy = rows + noise * np.random.default_rng(walls).normal(size=rows.shape)
    assert len(modes_of(noisy)) == count


@pytest.mark.parametrize("n", [*range(6, 13), 20, 40])
def test_the_moment_curve_reaches_the_bound(n: int, implementation: str):
    if implementation == "numpy":
        n = min(n, 9)  # the same law; Python's integers would take minutes for more
    rows = [[1, t, t * t, t**5, t**4, -2 * t**3] for t in range(1, n + 1)]
    assert len(kernel.exact_faces(rows, dimension=6)) == 6 * n * n - 36 * n + 64


@given(seeds())
def test_random_contacts_never_exceed_it(rng: np.random.Generator):
    n = int(rng.integers(6, 15))
    normals, points = rng.normal(size=(n, 3)), rng.normal(size=(n, 3))
    normals[:, 0] = np.abs(normals[:, 0])
    assert len(modes_of(np.column_stack([normals, np.cross(points, normals)]))) <= 6 * n * n - 36 * n + 64


@settings(max_examples=20)
@given(vector_sets(both_ways=False, most=4))
def test_modes_are_those_that_exact_arithmetic_finds(vectors: Vectors):
    """Brute force: a set is a mode if some motion is zero on it and negative on the others."""
    found = kernel.exact_faces(vectors.rows, dimension=vectors.dimension)
    count = len(vectors.rows)
    assume(count <= 6)
    expected = []
    for bits in range(1 << count):
        on = [row for k, row in enumerate(vectors.rows) if bits >> k & 1]
        off = [row for k, row in enumerate(vectors.rows) if not bits >> k & 1]
        if _some_motion(on, off):
            expected.append([bool(bits >> k & 1) for k in range(count)])
    assert sorted(found.rows.tolist()) == sorted(expected)
    unit = vectors.array / np.maximum(np.linalg.norm(vectors.array, axis=1, keepdims=True), 1)
    heights = found.witnesses @ unit.T
    assert np.abs(heights[found.rows]).max(initial=0) < 1e-12
    assert heights[~found.rows].max(initial=-1) < -1e-9


def _some_motion(on: list, off: list) -> bool:
    """Some u with on . u = 0 and off . u < 0: no weights > 0 of `off` lie in the span of `on` (Motzkin)."""
    if not off:
        return True
    generators = [[*row, 0] for row in on] + [[*(-v for v in row), 0] for row in on] + [[*row, 1] for row in off]
    return not exact.in_cone([0] * len(off[0]) + [1], generators)


def test_the_order_and_the_limit():
    rows = box_rows(1)
    found = kernel.exact_faces(rows, dimension=6)
    counts = found.rows.sum(axis=1).tolist()
    assert counts == sorted(counts, reverse=True)
    with pytest.raises(ConeError, match="more than 9 faces"):
        kernel.exact_faces(rows, dimension=6, most=9)


def test_no_contacts():
    found = kernel.exact_faces([], dimension=3)
    assert found.rows.shape == (1, 0)
    assert not found.witnesses.any()

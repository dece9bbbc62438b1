"""Several hundred degenerate cones, turned by a random rotation and shaken by noise: no wrong structure unflagged.

An integer cone tells exactly how many extreme rays and lines there must be. Rotated by floats, its ties are off by
rounding and by the noise. A wrong count is allowed only where `certain` is False, and that must be rare.
"""

import numpy as np
import pytest

from fixture_design.cones import convert_rows, kernel
from tests import exact

CONES = 150
NOISES = (0.0, 1e-15, 1e-14)


def degenerate_rows(rng: np.random.Generator, d: int) -> np.ndarray:
    """Small integers with repeats, multiples, opposites and sums; a third in a hyperplane, a third on one side."""
    rows = rng.integers(-2, 3, size=(rng.integers(2, 11), d))
    rows[rng.random(rows.shape) < 0.3] = 0
    style = rng.integers(3)
    if style == 1:
        rows[:, 0] = 0
    if style == 2:
        rows[:, 0] = -np.abs(rows).sum(axis=1)
    extra = [rng.integers(1, 4) * rows[rng.integers(len(rows))], rows[0] + rows[-1]]
    if rng.random() < 0.5:
        extra.append(-rows[: rng.integers(1, len(rows) + 1)].sum(axis=0))
    return np.vstack([rows, *extra])


def random_rotation(rng: np.random.Generator, d: int) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(d, d)))
    return q * np.sign(np.diag(r))


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("d", [3, 6])
def test_no_wrong_structure_goes_unflagged(d: int, noise: float):
    rng = np.random.default_rng(20 * d + round(-np.log10(noise or 1)))
    wrong, flagged = [], 0
    for number in range(CONES):
        rows = degenerate_rows(rng, d)
        rays, lines = exact.extreme(rows.tolist(), dimension=d)
        turned = rows @ random_rotation(rng, d)
        turned = turned * (1 + noise * rng.normal(size=turned.shape)) * 10.0 ** rng.integers(-3, 4, size=(len(rows), 1))
        found = convert_rows(turned, np.zeros((0, d)))
        flagged += not found.certain
        if found.certain and (len(found.vectors), len(found.lines)) != (len(rays), len(lines)):
            wrong.append((number, rows.tolist(), len(found.vectors), len(rays)))
    assert not wrong
    assert flagged <= CONES // 50


@pytest.mark.parametrize(("count", "rays"), [(20, 272), (50, 2162)])
def test_cyclic_cones(count: int, rays: int, implementation: str):
    """Neighbours are nearly dependent: floats have all the rays, or say that they may not; integers have them."""
    if implementation == "numpy":
        count, rays = 12, 72  # (n - 3) (n - 4) for n face vectors; fewer for the sake of time
    points = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    found = convert_rows(np.vander(points, 6, increasing=True), np.zeros((0, 6)))
    assert len(found.vectors) == rays or not found.certain
    whole = [[t**k for k in range(6)] for t in range(-count // 2, count // 2)]
    assert len(kernel.exact_double_description(whole, dimension=6).rays) == rays


@pytest.mark.parametrize("exponent", [-16, -14, -12, -11, -7, -6, -5, -4])
def test_outside_the_band_a_near_tie_is_a_tie_or_none(exponent: int):
    """An opposed pair tilted by far less or far more than the tolerance: two lines, or a wedge with one."""
    found = convert_rows(np.array([[1.0, 0.0, 0.0], [-1.0, -(10.0**exponent), 0.0]]), np.zeros((0, 3)))
    assert found.certain
    assert (len(found.lines), len(found.vectors)) == ((2, 0) if exponent < -9 else (1, 2))

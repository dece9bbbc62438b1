"""Largest factors: proofs checked by products alone, Clarabel's optimum in every bracket, ties and ends."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.cones import kernel
from fixture_design.cones.kernel.balance import balance_guesses
from fixture_design.cones.second_order import ForceCones, largest_factors
from fixture_design.errors import ConeError
from tests.cones.second_order import check, clarabel, contacts, on_a_grid, planar_map, spatial_map, unit

#: Clarabel's factors are good to about this [-].
CLARABEL = 2e-6
#: It stops at this gap even where nothing is given that could be held, and the factor is zero.
CLARABEL_GAP = 1e-8
#: Brackets are at most this wide, next to the factor or what is held [-].
NARROW = 1e-6


def cones_of(maps: list[np.ndarray], heads: list[float] | None = None) -> ForceCones:
    sizes = np.array([m.shape[1] for m in maps])
    return ForceCones(np.hstack(maps), sizes, np.full(len(maps), np.nan) if heads is None else np.array(heads))


def block(friction: float, heads: tuple[float, ...] = ()) -> ForceCones:
    """A unit square on a floor and against a wall, with a clamp on its top and one on its side if they have heads."""
    at = [([-0.5, -0.5], [0, -1]), ([0.5, -0.5], [0, -1]), ([-0.5, 0.3], [-1, 0])]
    at += [([0.0, 0.5], [0, 1]), ([0.5, 0.3], [1, 0])][: len(heads)]
    maps = [planar_map(np.array(p), np.array(n, dtype=float), friction, 2) for p, n in at]
    return cones_of(maps, [np.nan] * 3 + list(heads))


@pytest.mark.parametrize("seed", range(60))
def test_clarabel_s_factor_is_in_every_bracket(seed: int):
    pytest.importorskip("pydrake.solvers")
    rng = np.random.default_rng(seed)
    dimension, count = int(rng.choice([3, 6, 6])), int(rng.integers(3, 15))
    cones = contacts(rng, dimension, count, sided=seed % 3 > 0, most_friction=float(rng.choice([0.0, 0.3, 1.0])))
    fixed, loads = rng.normal(size=dimension) * rng.choice([0.0, 0.1, 1.0]), rng.normal(size=(5, dimension))
    found = largest_factors(cones, fixed, loads)
    check(cones, fixed, loads, found)
    made = np.linalg.norm(fixed) + np.nansum(cones.heads)
    for load, lower, upper in zip(loads, found.lower, found.upper, strict=True):
        said = clarabel(cones, fixed, load)
        if said is None:
            continue
        if not np.isfinite(said):
            assert lower == upper == said
            continue
        size = max(abs(said), made / np.linalg.norm(load))
        assert upper - lower <= NARROW * size
        room = max(CLARABEL * size, CLARABEL_GAP)
        assert lower - room <= said <= upper + room


@pytest.mark.parametrize("seed", range(5))
def test_ties_are_decided_by_proof_or_left_open(seed: int):
    rng, open_ends, count = np.random.default_rng(seed), 0, 0
    for _ in range(20):
        cones, fixed, loads = on_a_grid(rng)
        found = largest_factors(cones, fixed, loads)
        check(cones, fixed, loads, found)
        proved = (found.lower == found.upper) | (np.isfinite(found.lower) & np.isfinite(found.upper))
        open_ends += int((~proved).sum())
        count += len(loads)
    assert open_ends <= 0.1 * count


def test_a_block_slides_when_friction_says_so():
    """Pulled away from the wall: the floor and the top rub with 0.5 x (weight + clamp) and 0.5 x clamp."""
    cones = block(0.5, (10.0,))
    weight, pull = np.array([0.0, -4.0, 0.0]), np.array([[1.0, 0.0, -0.5]])
    found = largest_factors(cones, weight, pull)
    check(cones, weight, pull, found)
    assert found.lower[0] == pytest.approx(0.5 * (4 + 10) + 0.5 * 10, rel=1e-7)
    assert found.upper[0] == pytest.approx(found.lower[0], rel=1e-7)


def test_smallest_factors_are_largest_ones_of_the_opposite():
    cones = block(0.2, (10.0, 5.0))
    load = np.array([[0.0, 1.0, 0.0]])
    most, least = largest_factors(cones, np.zeros(3), load), largest_factors(cones, np.zeros(3), -load)
    assert -least.upper[0] <= 0 <= most.lower[0]
    # downwards the floor takes all that it is given
    assert np.isposinf(least.lower[0])


def test_without_friction_and_load():
    cones = block(0.0)
    loads = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.3], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    found = largest_factors(cones, np.array([0.0, -1.0, 0.0]), loads)
    check(cones, np.array([0.0, -1.0, 0.0]), loads, found)
    assert found.lower[0] == pytest.approx(0.0, abs=1e-9)
    assert np.isposinf(found.lower[2])
    assert found.upper[3] == pytest.approx(0.5, rel=1e-7)
    # nothing holds it down
    found = largest_factors(cones, np.array([0.0, 1.0, 0.0]), loads[[0, 2, 3]])
    check(cones, np.array([0.0, 1.0, 0.0]), loads[[0, 2, 3]], found)
    assert np.isneginf(found.upper).all()


def test_opposed_contacts_squeeze_as_hard_as_they_must():
    """Two soft tips face each other: what they squeeze they hold; the dual has no interior."""
    tips = [spatial_map(np.array([x, 0, 0]), np.array([np.sign(x), 0, 0]), 0.5, 4) for x in (-1.0, 1.0)]
    cones, loads = cones_of(tips), np.vstack([np.eye(6), np.zeros(6)])
    found = largest_factors(cones, np.array([0.0, 0, -9.81, 0, 0, 0]), loads)
    check(cones, np.array([0.0, 0, -9.81, 0, 0, 0]), loads, found)
    assert np.isposinf(found.lower).all()
    # hard tips leave the rotation about their line to a third contact, which is a clamp
    hard = [tip[:, :3] for tip in tips] + [spatial_map(np.array([0, 0, 1.0]), np.array([0, 0, 1.0]), 0.5, 3)]
    cones, load = cones_of(hard, [np.nan, np.nan, 3.0]), np.array([[0.0, 0, 0, 1, 0, 0]])
    found = largest_factors(cones, np.zeros(6), load)
    check(cones, np.zeros(6), load, found)
    assert found.lower[0] == pytest.approx(1.5, rel=1e-7)
    assert found.upper[0] == pytest.approx(1.5, rel=1e-7)
    # without it the line is all that they leave
    found = largest_factors(cones_of(hard[:2]), np.zeros(6), load)
    check(cones_of(hard[:2]), np.zeros(6), load, found)
    assert found.lower[0] == found.upper[0] == 0


def test_coplanar_contacts_without_friction():
    """Four feet on a plane: rank 3; a load in the plane has the factor 0, one that turns it over a finite one."""
    at = [[1.0, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]]
    feet = [spatial_map(np.array(p), np.array([0, 0, -1.0]), 0.0, 1) for p in at]
    cones, weight = cones_of(feet), np.array([0, 0, -8.0, 0, 0, 0])
    loads = np.array([[1.0, 0, 0, 0, 0, 0], [0, 0, -1, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 2, 0, 0]])
    found = largest_factors(cones, weight, loads)
    check(cones, weight, loads, found)
    np.testing.assert_allclose(found.lower, [0, np.inf, 8, 4], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(found.upper, [0, np.inf, 8, 4], rtol=1e-7, atol=1e-9)
    found = largest_factors(cones, np.array([1.0, 0, -8, 0, 0, 0]), loads)
    check(cones, np.array([1.0, 0, -8, 0, 0, 0]), loads, found)
    np.testing.assert_allclose(found.upper, [-1, -np.inf, -np.inf, -np.inf])
    assert found.lower[0] == -1


def test_nothing_pushes():
    for cones in (
        ForceCones(np.zeros((6, 0)), np.zeros(0, dtype=int), np.zeros(0)),
        ForceCones(np.zeros((6, 3)), np.array([3]), np.array([np.nan])),
        cones_of([spatial_map(np.ones(3), np.array([0, 0, 1.0]), 0.3, 3)], [0.0]),
    ):
        loads = np.array([[1.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]])
        for fixed, factors in (
            (np.zeros(6), [0, np.inf]),
            (np.eye(6)[0], [-1, -np.inf]),
            (np.eye(6)[1], [-np.inf] * 2),
        ):
            found = largest_factors(cones, fixed, loads)
            check(cones, fixed, loads, found)
            np.testing.assert_array_equal(found.upper, factors)
            np.testing.assert_array_equal(found.lower, factors)
        assert largest_factors(cones, np.zeros(6), np.zeros((0, 6))).lower.shape == (0,)


@pytest.mark.parametrize("newtons", [1e-3, 1.0, 1e9])
@pytest.mark.parametrize("metres", [1e-3, 1.0, 1e3])
def test_units_change_no_answer(newtons: float, metres: float):
    rng = np.random.default_rng(3)
    cones = contacts(rng, 6, 9, sided=True, most_friction=0.5)
    fixed, loads = rng.normal(size=6), rng.normal(size=(8, 6))
    before = largest_factors(cones, fixed, loads)
    lengths = np.array([1, 1, 1, metres, metres, metres])
    scaled = ForceCones(cones.maps * lengths[:, None], cones.sizes, cones.heads * newtons)
    fixed, loads = fixed * lengths * newtons, loads * lengths
    after = largest_factors(scaled, fixed, loads)
    check(scaled, fixed, loads, after)
    np.testing.assert_allclose(after.lower, before.lower * newtons, rtol=1e-6)
    np.testing.assert_allclose(after.upper, before.upper * newtons, rtol=1e-6)


def test_more_pushes_hold_no_less():
    rng = np.random.default_rng(8)
    for _ in range(10):
        cones = contacts(rng, 6, 10, sided=True, most_friction=0.6)
        fewer = ForceCones(cones.maps[:, : -cones.sizes[-1]], cones.sizes[:-1], cones.heads[:-1])
        if not np.isnan(cones.heads[-1]):
            continue
        loads, fixed = rng.normal(size=(6, 6)), 0.1 * rng.normal(size=6)
        assert (largest_factors(cones, fixed, loads).upper >= largest_factors(fewer, fixed, loads).lower - 1e-9).all()


def test_threads_and_company_change_nothing():
    rng = np.random.default_rng(4)
    cones, fixed, loads = (
        contacts(rng, 6, 8, sided=True, most_friction=0.5),
        rng.normal(size=6),
        rng.normal(size=(11, 6)),
    )
    all_at_once = largest_factors(cones, fixed, loads, threads=3)
    for k in range(11):
        alone = largest_factors(cones, fixed, loads[k : k + 1], threads=1)
        assert alone.lower[0] == pytest.approx(all_at_once.lower[k], rel=1e-6)
        assert alone.upper[0] == pytest.approx(all_at_once.upper[k], rel=1e-6)


@pytest.mark.skipif("rust" not in kernel.available(), reason="the compiled kernel was not built")
@pytest.mark.parametrize(("dimension", "width"), [(2, 2), (3, 2), (3, 3), (3, 4), (5, 3), (6, 3), (6, 4), (7, 4)])
@pytest.mark.parametrize("seek", [True, False])
def test_numpy_and_rust_take_the_same_steps(dimension: int, width: int, seek: bool):
    rng = np.random.default_rng(dimension)
    maps = rng.normal(size=(dimension, 8, width))
    maps[0, :, 0] = np.abs(maps[0, :, 0])
    balls = np.arange(8) < 4
    maps[:, balls, 0] = 0.0
    loads, fixed = unit(rng.normal(size=(9, dimension))), 0.1 * rng.normal(size=(9, dimension))
    found = {}
    for name in ("numpy", "rust"):
        with kernel.using(name):
            found[name] = balance_guesses(maps, balls, fixed, loads, seek=seek)
    np.testing.assert_allclose(found["numpy"].sizes, found["rust"].sizes, rtol=1e-2, atol=1e-9)
    ended = found["numpy"].sizes > 1e-6
    assert (np.abs(found["numpy"].steps - found["rust"].steps) <= 2).all()
    if seek:
        ratio = [f.motions[ended] / f.sizes[ended, None] for f in found.values()]
        np.testing.assert_allclose(ratio[0], ratio[1], rtol=1e-3, atol=1e-4)


def test_what_does_not_fit_is_said():
    maps, free = np.eye(6)[:, :3], np.array([np.nan])
    for sizes, heads in (([2], free), ([3], np.array([-1.0])), ([3], np.array([np.inf]))):
        with pytest.raises(ConeError):
            ForceCones(maps, np.array(sizes), heads)
    with pytest.raises(ConeError):
        ForceCones(maps * np.nan, np.array([3]), free)
    with pytest.raises(ConeError):
        largest_factors(ForceCones(np.eye(6)[:, :5], np.array([5]), free), np.zeros(6), np.eye(6))
    cones = ForceCones(maps, np.array([3]), free)
    for fixed, loads in ((np.zeros(3), np.eye(3)), (np.full(6, np.inf), np.eye(6))):
        with pytest.raises(ConeError):
            largest_factors(cones, fixed, loads)

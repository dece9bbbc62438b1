"""Friction cones: exact in the plane (2-79, 2-80); in space inner pyramids are inside, outer ones around the cone."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import friction_edges
from tests import exact
from tests.strategies import seeds

FRICTION = st.sampled_from([1e-6, 1e-3, 0.1, 0.5, 1.0, 3.0])
EDGES = st.sampled_from([3, 4, 8, 17, 64])


def slope(edge: np.ndarray, unit: np.ndarray) -> float:
    """Tangential over normal component: at most mu inside the cone."""
    along = edge @ unit
    return float(np.linalg.norm(edge - along * unit) / along)


def unit_normal(rng: np.random.Generator, p: int) -> tuple[np.ndarray, np.ndarray]:
    normal = rng.normal(size=p) * 10.0 ** rng.integers(-6, 7)
    return normal, normal / np.linalg.norm(normal)


@given(seeds(), FRICTION)
def test_in_the_plane_the_edges_are_those_of_the_cone(rng, friction):
    normal, unit = unit_normal(rng, 2)
    edges = friction_edges(normal, friction)
    assert edges.shape == (2, 2)
    assert [slope(edge, unit) for edge in edges] == pytest.approx([friction, friction], rel=1e-9)
    across = edges @ [-unit[1], unit[0]]
    assert across[0] < 0 < across[1]


@given(seeds(), FRICTION, EDGES)
def test_inner_edges_are_on_the_cone(rng, friction, count):
    normal, unit = unit_normal(rng, 3)
    edges = friction_edges(normal, friction, count, "inner")
    assert edges.shape == (count, 3)
    assert edges @ unit == pytest.approx(np.ones(count))
    assert max(slope(edge, unit) for edge in edges) == pytest.approx(friction, rel=1e-9, abs=1e-15)


@given(seeds(), FRICTION, EDGES)
def test_the_outer_pyramid_holds_every_vector_of_the_cone(rng, friction, count):
    """Its faces touch the cone: neighbouring edges meet midway at mu exactly, and farther out everywhere else."""
    normal, unit = unit_normal(rng, 3)
    edges = friction_edges(normal, friction, count, "outer")
    middles = (edges + np.roll(edges, -1, axis=0)) / 2
    assert [slope(middle, unit) for middle in middles] == pytest.approx([friction] * count, rel=1e-9, abs=1e-15)
    assert min(slope(edge, unit) for edge in edges) >= friction * (1 - 1e-9)


@given(seeds(), st.sampled_from([2, 3]))
def test_without_friction_it_is_the_unit_normal(rng, p):
    normal, unit = unit_normal(rng, p)
    assert friction_edges(normal, 0.0) == pytest.approx(unit[None])


def test_tangents_of_normals_along_an_axis_are_exact():
    for axis in np.vstack([np.eye(3), -np.eye(3)]):
        edges = friction_edges(axis, 0.5, 4)
        assert set(np.abs(edges.round(15)).ravel().tolist()) == {0.0, 0.5, 1.0}


@given(st.tuples(*[st.integers(-5, 5)] * 3).filter(any), st.sampled_from([8, 32, 128]))
def test_the_exact_bracket_is_a_bracket(normal, count):
    """Squares tell it without roots: |t|^2 <= mu^2 |n|^2 inside; outside the polygon's edges stay clear of the disc."""
    mu, square = Fraction(3, 10), exact.dot(normal, normal)
    for side in ("inner", "outer"):
        edges = exact.friction_edges(normal, mu, count, side)
        tangents = [[a - b for a, b in zip(edge, normal, strict=True)] for edge in edges]
        assert all(exact.dot(t, normal) == 0 for t in tangents)
        if side == "inner":
            assert all(exact.dot(t, t) <= mu * mu * square for t in tangents)
        else:
            for first, second in zip(tangents, tangents[1:] + tangents[:1], strict=True):
                edge = [b - a for a, b in zip(first, second, strict=True)]
                distance = exact.dot(first, first) - Fraction(exact.dot(first, edge)) ** 2 / exact.dot(edge, edge)
                assert distance >= mu * mu * square
    ratio = exact.dot(tangents[0], tangents[0]) / (mu * mu * square)
    assert 1 <= ratio < 1 + 12 / count**2 * 2

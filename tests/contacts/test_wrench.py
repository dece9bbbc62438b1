"""Face vectors (2-5) against the thesis's numbers, and the way between scaled and world coordinates."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import face_vectors, motion_about_origin, motion_scaled, velocity
from tests import exact
from tests.problems import FIGURE_8_CONTACTS, FIGURE_8_FACE_VECTORS
from tests.strategies import seeds


@pytest.mark.parametrize("name", FIGURE_8_CONTACTS)
def test_face_vectors_of_figure_8_2_64(name):
    point, alternatives = FIGURE_8_CONTACTS[name]
    for normal, face_vector in alternatives:
        found = face_vectors(np.array([point], dtype=float), np.array([normal], dtype=float))
        assert found[0].tolist() == list(FIGURE_8_FACE_VECTORS[face_vector])


def test_a_face_vector_in_space():
    """d = [n; x X n]: a push along z at x = 1 turns about -y."""
    found = face_vectors(np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]]))
    assert found.tolist() == [[0, 0, 1, 0, -1, 0]]


@given(st.sampled_from([2, 3]).flatmap(lambda p: st.lists(st.integers(-9, 9), min_size=2 * p, max_size=2 * p)))
def test_face_vectors_are_the_exact_ones(numbers):
    half = len(numbers) // 2
    point, normal = numbers[:half], numbers[half:]
    found = face_vectors(np.array([point], dtype=float), np.array([normal], dtype=float))
    assert found[0].tolist() == list(exact.face_vector(point, normal))


@given(st.sampled_from([2, 3]), seeds())
def test_the_product_with_a_face_vector_is_the_speed_along_the_normal_2_6(p: int, rng: np.random.Generator):
    point, normal, motion = rng.normal(size=p), rng.normal(size=p), rng.normal(size=3 * (p - 1))
    row = face_vectors(point[None], normal[None])[0]
    assert row @ motion == pytest.approx(normal @ velocity(motion, point), abs=1e-12)


@given(st.sampled_from([2, 3]), seeds())
def test_scaled_motions_and_back(p: int, rng: np.random.Generator):
    reference, length = rng.normal(size=p) * 10, float(10.0 ** rng.uniform(-3, 3))
    scaled = rng.normal(size=3 * (p - 1))
    motion = motion_about_origin(scaled, reference, length)
    assert motion_scaled(motion, reference, length) == pytest.approx(scaled, abs=1e-9 * (1 + 1 / length))
    assert motion_about_origin(motion_scaled(motion, reference, length), reference, length) == pytest.approx(
        motion, abs=1e-9 * (1 + 1 / length)
    )


@given(st.sampled_from([2, 3]), seeds())
def test_products_are_the_same_in_both_coordinates(p: int, rng: np.random.Generator):
    reference, length = rng.normal(size=p) * 3, float(10.0 ** rng.uniform(-2, 2))
    points, normals = rng.normal(size=(5, p)) * length, rng.normal(size=(5, p))
    scaled = rng.normal(size=3 * (p - 1))
    rows = face_vectors(points - reference, normals)
    rows[:, p:] /= length
    in_world = face_vectors(points, normals) @ motion_about_origin(scaled, reference, length)
    assert in_world == pytest.approx(rows @ scaled, rel=1e-9, abs=1e-9 * (1 + 1 / length))


def test_a_turn_about_the_reference_does_not_move_it():
    reference = np.array([1.0, 2.0, 3.0])
    motion = motion_about_origin(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), reference, 0.5)
    assert motion.tolist() == [4.0, -2.0, 0.0, 0.0, 0.0, 2.0]
    assert velocity(motion, reference).tolist() == [0, 0, 0]

"""Section 4.7: Table 6 from Table 5, Table 7 from Table 6."""

import numpy as np
import pytest

from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.cones import ConeUnion, PolyhedralConvexCone
from fixture_design.io import read_assembly
from fixture_design.recognition import MeasurementSet, Signals, StateClass, measurement_set, transitions
from fixture_design.recognition.discriminants import Against, discriminants
from fixture_design.recognition.measurement import oriented_rows
from fixture_design.recognition.sample_cones import Physics, sample_cones
from tests.assembly.parts import FIGURE_14
from tests.exact import in_cone
from tests.problems import (
    FIGURE_14_SUCCESSORS,
    FIGURE_14_TABLE_5,
    FIGURE_14_TABLE_5_CONTACTS,
    FIGURE_14_TABLE_6,
    FIGURE_14_TABLE_6_ROUNDING,
    FIGURE_14_TABLE_7,
)

SIGNALS = Signals("force", "fixed", 2, 1.0)
PHYSICS = Physics(0.0, 8, np.zeros(2), np.zeros(2))


def test_the_contact_geometry_has_the_length_of_the_thesis() -> None:
    """Table 6 does not scale moments; the peg is so large that no scale is one."""
    assert geometry_of(read_assembly(FIGURE_14)).radius == 1.0


@pytest.mark.parametrize("name", FIGURE_14_TABLE_5)
def test_table_6_from_table_5(name: str) -> None:
    q = np.array(FIGURE_14_TABLE_5[name])
    geometry = geometry_of(read_assembly(FIGURE_14))
    cones = sample_cones(geometry, FIGURE_14_TABLE_5_CONTACTS[name], q, True, SIGNALS, PHYSICS)
    (cone,) = measurement_set(cones, [range(len(q))], SIGNALS).cones
    found, published = scaled(oriented_rows(cone)), np.array(FIGURE_14_TABLE_6[name])
    distances = np.abs(found[:, None] - published[None]).max(axis=2)
    # as sets: each face of the one has a partner in the other
    assert len(found) == len(published)
    assert distances.min(axis=0).max() < FIGURE_14_TABLE_6_ROUNDING[name]
    assert distances.min(axis=1).max() < FIGURE_14_TABLE_6_ROUNDING[name]


@pytest.mark.parametrize("name", FIGURE_14_TABLE_5)
def test_table_6_is_within_the_rounding_of_table_5(name: str) -> None:
    """Each face is no further from the published one than other tables go that round to Table 5."""
    geometry = geometry_of(read_assembly(FIGURE_14))
    q, published = np.array(FIGURE_14_TABLE_5[name]), np.array(FIGURE_14_TABLE_6[name])
    half = 0.5 * 10.0 ** (np.floor(np.log10(np.abs(q))) - 5)  # of the last of six digits
    rng = np.random.default_rng(0)

    def distances(rows: np.ndarray) -> np.ndarray:
        cones = sample_cones(geometry, FIGURE_14_TABLE_5_CONTACTS[name], rows, True, SIGNALS, PHYSICS)
        (cone,) = measurement_set(cones, [range(len(q))], SIGNALS).cones
        found = scaled(oriented_rows(cone))
        return np.abs(found[:, None] - published[None]).max(axis=2).min(axis=0)

    spread = np.max([distances(q + half * rng.uniform(-1, 1, q.shape)) for _ in range(60)], axis=0)
    rounding_of_table_6 = 1e-6
    assert (distances(q) <= spread + rounding_of_table_6).all()


def scaled(rows: np.ndarray) -> np.ndarray:
    return rows / np.abs(rows).max(axis=1, keepdims=True)


@pytest.fixture(scope="module")
def states() -> tuple[StateClass, ...]:
    """Table 6 as it is, with its order and its digits."""
    return tuple(
        StateClass(
            name,
            (),
            MeasurementSet(ConeUnion.of([PolyhedralConvexCone.from_faces(rows)])),
            FIGURE_14_SUCCESSORS.get(name, (name,)),
        )
        for name, rows in FIGURE_14_TABLE_6.items()
    )


def test_table_7_from_table_6(states: tuple[StateClass, ...]) -> None:
    found = {(some.source, some.target): some.faces for some in transitions(states)}
    for key, published in FIGURE_14_TABLE_7.items():
        (faces,) = found[key]
        rows = {FIGURE_14_TABLE_6[key[1]][face] for face in faces}
        assert rows == set(published), key
        assert len(faces) == len(published)


def test_all_at_once_would_drop_all(states: tuple[StateClass, ...]) -> None:
    """(4-16) as it stands: D(S1, S2) of Table 6 would come out empty, though S2 is larger than S1."""
    s1, s2 = (FIGURE_14_TABLE_6[name] for name in ("N1", "N2"))
    whole = [[round(1e6 * v) for v in row] for row in (*s1, *s2)]
    assert all(in_cone(whole[k], [*whole[:k], *whole[k + 1 :]]) for k in range(len(s1)))
    rows = np.array(s1, dtype=float)
    assert len(discriminants(rows, Against.of(PolyhedralConvexCone.from_faces(s2)))) == 1


def test_the_smallest_groups(states: tuple[StateClass, ...]) -> None:
    """Never more than Table 7, and one instead of two for N1 after N1: all forces of S2 and S3 have moments >= 0."""
    in_order = {(some.source, some.target): some.faces for some in transitions(states)}
    fewest = {(some.source, some.target): some.faces for some in transitions(states, fewest=True)}
    for key, faces in in_order.items():
        assert len(fewest[key][0]) <= len(faces[0]), key
    assert len(fewest["N1", "N1"][0]) == 1

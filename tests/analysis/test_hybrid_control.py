"""Position- and force-controlled sets, reciprocal commands, classed measurements (2.3 (d), 2.6 (d), Table 3)."""

import numpy as np
import pytest

from fixture_design.analysis import (
    HybridControl,
    Restraint,
    admissible_displacements,
    classify_pair,
    commanded_pair,
    hybrid_control,
)
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, element, union_element
from fixture_design.contacts import Contact
from fixture_design.errors import DimensionError
from tests.problems import figure_8


def control_of(contacts: list[Contact]) -> HybridControl:
    displacements = admissible_displacements(Restraint.of(contacts))
    assert displacements is not None
    return hybrid_control(displacements)


@pytest.mark.parametrize("names", [("P1", "P2", "P3", "P4"), ("P2", "P3", "P4"), ("P1", "P2", "P3", "P4", "P5")])
@pytest.mark.parametrize("seed", range(20))
def test_commands_are_admissible_and_reciprocal(names: tuple[str, ...], seed: int) -> None:
    control = control_of(figure_8(names))
    rng = np.random.default_rng(seed)
    displacement, force = commanded_pair(control, rng.normal(size=3), rng.normal(size=3))
    assert union_element(displacement, control.displacements)
    assert element(force, control.forces)
    assert abs(force @ displacement) <= 1e-9
    assert classify_pair(force, displacement) == "reciprocal"


@pytest.mark.parametrize("names", [("P2",), ("P2", "P3"), ("P1", "P2", "P3", "P4")])
def test_position_controlled_motions_are_admissible_both_ways(names: tuple[str, ...]) -> None:
    """The convex sum of a union holds lines that A does not: an apex alone does not leave R^3 free."""
    control = control_of(figure_8(names))
    for row in control.position_controlled:
        assert union_element(row, control.displacements)
        assert union_element(-row, control.displacements)


def test_admissible_wishes_are_granted() -> None:
    control = control_of(figure_8(("P2", "P3", "P4")))
    cone = control.displacements.cones[0]
    wish = cone.spans.sum(axis=0)
    displacement, force = commanded_pair(control, wish, np.zeros(3))
    assert displacement == pytest.approx(wish)
    assert force == pytest.approx(np.zeros(3))


def test_admissible_pairs_do_no_positive_work() -> None:
    """(2-23): every force of F against every displacement of A."""
    control = control_of(figure_8(("P1", "P2", "P3", "P4")))
    forces = np.vstack([control.forces.spans, control.forces.lines, -control.forces.lines])
    for cone in control.displacements:
        assert np.all(np.vstack([cone.spans, cone.lines]) @ forces.T <= 1e-12)


def test_bidirectional_constraints_give_masons_subspaces() -> None:
    """A slider between two rails: it moves along x, the rails take fy and the moment (Mason, 1982)."""
    rails = [([0, 1], [0, 1]), ([1, 1], [0, 1]), ([0, -1], [0, -1]), ([1, -1], [0, -1])]
    control = control_of([Contact.on_facet(f"R{i}", "locator", p, n) for i, (p, n) in enumerate(rails)])
    assert control.bidirectional
    assert np.abs(control.position_controlled) == pytest.approx(np.array([[1.0, 0.0, 0.0]]))
    assert len(control.force_controlled) == 2
    assert control.force_controlled @ control.position_controlled.T == pytest.approx(np.zeros((2, 1)))


def test_unidirectional_constraints_are_not_subspaces() -> None:
    control = control_of(figure_8(("P1", "P2", "P3", "P4")))
    assert not control.bidirectional
    assert len(control.position_controlled) == 0
    assert len(control.force_controlled) == 2  # fy and the moment are pushed both ways by P1, P3, P4


def test_a_union_that_fills_a_subspace_only_together_is_not_one() -> None:
    """Two half-lines make a line; they are not a single cone with that line, and no cone of the two has it."""
    halves = ConeUnion.of(PolyhedralConvexCone.from_span([[sign, 0.0, 0.0]]) for sign in (1.0, -1.0))
    assert not hybrid_control(halves).bidirectional


@pytest.mark.parametrize(
    ("force", "kind"), [([0, 1, 0], "reciprocal"), ([1, 0, 0], "repelling"), ([-1, 5, 0], "contrary")]
)
def test_measured_pairs(force: list[float], kind: str) -> None:
    assert classify_pair(force, [2, 0, 0]) == kind


def test_noise_is_relative() -> None:
    assert classify_pair([1e-3, 1.0, 0], [1, 0, 0], noise=1e-2) == "reciprocal"
    assert classify_pair([1e-3, 1.0, 0], [1, 0, 0], noise=1e-4) == "repelling"
    assert classify_pair([0, 0, 0], [0, 0, 0]) == "reciprocal"


def test_vectors_that_do_not_fit() -> None:
    control = control_of(figure_8(("P2", "P3", "P4")))
    with pytest.raises(DimensionError):
        commanded_pair(control, np.zeros(6), np.zeros(3))
    with pytest.raises(DimensionError):
        classify_pair([1, 2, 3], [1, 2])

"""Numbers of quality with known answers, and what a controller may command of a grasped part."""

from __future__ import annotations

import numpy as np
import pytest

import fixture_design as fd
from fixture_design.analysis import commanded_pair
from fixture_design.contacts import Contact
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.grasp import hybrid_sets
from fixture_design.grasp.quality import epsilon, least_weight, quality
from fixture_design.layout import Layout


def test_wrenches_that_all_weigh_the_same_have_least_weight_one():
    cross = np.vstack([np.eye(6), -np.eye(6)])
    assert least_weight(cross) == pytest.approx(1.0)
    assert epsilon(cross) == pytest.approx(1 / np.sqrt(6))  # the cross-polytope's inscribed ball


def test_an_uneven_balance_has_the_weight_of_its_lightest():
    """1 and -3 balance as 3 : 1; the second's weight is 1/4, twice that of even ones 1/2."""
    assert least_weight(np.array([[1.0], [-3.0]])) == pytest.approx(0.5)


def test_what_does_not_balance_is_worth_nothing():
    one_way = np.array([[1.0, 0, 0, 0, 0, 0], [1, 1, 0, 0, 0, 0]])
    assert least_weight(one_way) == 0.0
    assert epsilon(one_way) == 0.0


def test_six_centred_normals_balance_and_close_nothing():
    """Rank 3: the least weight is 1, which other tools take for closed; epsilon is 0."""
    contacts = [Contact.on_facet(f"C{k}", "finger", n, n) for k, n in enumerate([*np.eye(3), *-np.eye(3)])]
    found = quality(contacts, np.zeros(3), 1.0)
    assert found.least_weight == pytest.approx(1.0)
    assert found.epsilon == 0.0


def _on_a_table() -> Layout:
    """A box that stands on a table, held from both sides."""
    table = [
        Contact.on_facet(f"T{k}", "locator", [x, y, 0.0], [0.0, 0, -1])
        for k, (x, y) in enumerate([(0.1, 0.1), (-0.1, 0.1), (0, -0.1)])
    ]
    fingers = [Contact.on_facet(f"F{k}", "finger", [0.1 * s, 0, 0.1], [s, 0.0, 0], 0.5) for k, s in enumerate((1, -1))]
    return Layout("box on a table", contacts=(*table, *fingers))


def test_a_part_on_a_table_slides_and_is_pressed():
    control = hybrid_sets(_on_a_table(), "locators")
    assert len(control.position_controlled) == 3  # along the table, two ways, and about its normal
    moved, pressed = commanded_pair(control, [0.01, 0, -0.01, 0, 0, 0], [0, 0, -5, 0, 0, 0])
    np.testing.assert_allclose(moved, [0.01, 0, 0, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(pressed, [0, 0, -5, 0, 0, 0], atol=1e-9)


def test_groups_that_are_not_there_or_empty_are_refused():
    with pytest.raises(UnknownNameError, match="no group is called 'tabel'"):
        hybrid_sets(_on_a_table(), "tabel")
    with pytest.raises(InputError, match="no contacts"):
        hybrid_sets(fd.Layout("air", contacts=_on_a_table().contacts[3:]), "locators")

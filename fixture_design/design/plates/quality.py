"""Quality: numbers to choose a fixture by. Brost and Goldberg leave the metric to the user; these are three."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Weights
from fixture_design.design.plates.closure import clamp_weights, planar_rows
from fixture_design.design.plates.fixtures import Fixtures
from fixture_design.design.plates.outline import Outline
from fixture_design.errors import InputError, UnknownNameError


def locating_error(fixtures: Fixtures) -> Weights:
    """How much larger than the locators' errors the part's can be: 1 / sigma_min of the locators' rows [-].

    For errors e of the locators along their normals, |e| = 1, the part moves by at most this, rotations multiplied by
    half the diagonal of the part's bounding box. Lower is better.
    """
    rows = contact_rows(fixtures)[:, :3]
    return 1 / np.linalg.svd(rows, compute_uv=False)[:, -1]


def reaction(fixtures: Fixtures) -> Weights:
    """The largest force at a locator while the clamp presses on its edge with a unit force [-]. Lower is better."""
    rows = contact_rows(fixtures)
    return -clamp_weights(rows[:, :3], rows[:, 3]).min(axis=1)


def contact_rows(fixtures: Fixtures) -> Float[np.ndarray, "k 4 3"]:
    """[n; x X n / length] of the four contacts, about the centre of the part's bounding box, in W's directions."""
    outline = Outline.of(fixtures.polygon)
    cos, sin = np.cos(fixtures.theta), np.sin(fixtures.theta)
    x, y = outline.center
    center = fixtures.translation + np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
    return planar_rows(fixtures.points - center[:, None], fixtures.normals, outline.length)


def best_fixture(fixtures: Fixtures, by: str = "margin") -> int:
    """Index of the best fixture; the first one among equals.

    Args:
        by: "margin" (largest), "locating_error" or "reaction" (smallest).

    Raises:
        InputError: there are no fixtures.  UnknownNameError: there is no such quality.
    """
    qualities = {
        "margin": lambda: -fixtures.margin,
        "locating_error": lambda: locating_error(fixtures),
        "reaction": lambda: reaction(fixtures),
    }
    if by not in qualities:
        raise UnknownNameError("quality of fixtures", by, qualities)
    if not len(fixtures):
        raise InputError("there is no fixture to choose from", expected="a plate that holds the part in some way")
    return int(np.argmin(qualities[by]()))

"""Colours that tell things apart do so for eyes that lack a kind of cones."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from fixture_design.contacts import ROLES
from fixture_design.layout import Answer
from fixture_design.viewing.palette import (
    ANSWER_COLORS,
    ANSWER_SIGNS,
    LOAD,
    MOTION,
    PART,
    PUSH,
    ROLE_COLORS,
    ROLE_INKS,
    rgb,
)

#: Linear RGB as people without one kind of cones see it. Source: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A
#: physiologically-based model for simulation of color vision deficiency", 2009, severity 1.
EYES = {
    "all cones": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
#: XYZ of linear sRGB, and of white. Source: IEC 61966-2-1.
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = TO_XYZ @ np.ones(3)
#: Differences of CIELAB: what is told apart beside each other is 2.3; here it must be told at a glance [-].
GLANCE = 12.0


def linear(color: str) -> np.ndarray:
    given = np.array(rgb(color))
    return np.where(given <= 0.04045, given / 12.92, ((given + 0.055) / 1.055) ** 2.4)


def lab(color: str, eyes: str) -> np.ndarray:
    xyz = TO_XYZ @ np.clip(np.asarray(EYES[eyes]) @ linear(color), 0, 1) / WHITE
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("eyes", EYES)
def test_roles_and_arrows_are_told_apart(eyes: str) -> None:
    colors = {**{role: ROLE_COLORS[role] for role in ROLES}, "push": PUSH, "load": LOAD, "motion": MOTION, "part": PART}
    for (one, first), (other, second) in combinations(colors.items(), 2):
        # pushes are told from the part, and the support from it, by shape where colours are near
        assert np.linalg.norm(lab(first, eyes) - lab(second, eyes)) > GLANCE, (one, other)


@pytest.mark.parametrize("eyes", EYES)
def test_yes_and_no_are_told_apart(eyes: str) -> None:
    yes, no = (lab(ANSWER_COLORS[answer], eyes) for answer in (Answer.YES, Answer.NO))
    assert np.linalg.norm(yes - no) > GLANCE
    assert len(set(ANSWER_SIGNS.values())) == len(ANSWER_SIGNS)


@pytest.mark.parametrize("role", ROLES)
def test_names_are_dark_enough_on_white(role: str) -> None:
    """4.5 to 1, as WCAG 2.1 wants it."""
    luminance = float(TO_XYZ[1] @ linear(ROLE_INKS[role]))  # type: ignore[index]
    assert 1.05 / (luminance + 0.05) >= 4.5

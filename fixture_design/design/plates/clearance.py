"""Clearance: tips and plungers touch the part where they should and nowhere else, and stay clear of each other.

What touches one edge and is further than its radius from all others is outside the part: the way from the touched
point to the tip's centre, and on along the plunger, crosses no edge.

"Further" is by more than a tie: where a tip would just touch a second edge, rounding would decide, and the contacts
would not be the four that were looked at.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from fixture_design.arrays import Indices, Mask
from fixture_design.design.plates.outline import Outline


def tips_clear(outline: Outline, centers: Float[np.ndarray, "k 2"], touched: Indices, radius: float) -> Mask:
    """Whether round tips are away from all edges but the one each touches.

    Args:
        centers: in P [m].  touched: edges of the outline.
    """
    return _all_but(_to_edges(outline, centers) > radius + outline.tie, touched)


def plungers_clear(
    outline: Outline,
    tips: Float[np.ndarray, "k 2"],
    bases: Float[np.ndarray, "k 2"],
    touched: Indices,
    radius: float,
) -> Mask:
    """Whether plungers, from the hole of their clamp to the tip, are away from all edges but the one each touches."""
    if not len(tips):
        return np.zeros(0, dtype=bool)
    least = radius + outline.tie
    corners = np.broadcast_to(outline.vertices, (len(tips), *outline.vertices.shape))
    # an edge's first corner and the next one's: each belongs to two edges
    corner_away = to_plungers(corners, tips, bases) > least
    away = corner_away & np.roll(corner_away, -1, axis=1)
    away &= (_to_edges(outline, bases) > least) & (_to_edges(outline, tips) > least)
    return _all_but(away & ~_crossing(outline, tips, bases), touched)


def to_plungers(
    points: Float[np.ndarray, "k m 2"], tips: Float[np.ndarray, "k 2"], bases: Float[np.ndarray, "k 2"]
) -> Float[np.ndarray, "k m"]:
    """Distance of points from the middle line of each plunger [m]; a plunger may have no length."""
    lines = (bases - tips)[:, None]
    square = np.maximum((lines**2).sum(axis=-1), np.finfo(np.float64).tiny)
    rest = points - tips[:, None]
    part = np.clip((rest * lines).sum(axis=-1) / square, 0.0, 1.0)
    rest = rest - part[..., None] * lines
    return np.hypot(rest[..., 0], rest[..., 1])


def _to_edges(outline: Outline, points: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k n"]:
    """Distance of points from every edge [m]."""
    tangents, starts = outline.tangents, outline.vertices
    along = points @ tangents.T - (tangents * starts).sum(axis=1)
    side = points @ outline.normals.T - (outline.normals * starts).sum(axis=1)
    beyond = along - np.clip(along, 0.0, outline.lengths)
    return np.hypot(beyond, side)


def _crossing(
    outline: Outline, tips: Float[np.ndarray, "k 2"], bases: Float[np.ndarray, "k 2"]
) -> Bool[np.ndarray, "k n"]:
    """Whether the middle line of a plunger crosses an edge; of use where no end is near the other."""
    level = (outline.normals * outline.vertices).sum(axis=1)
    astride = (tips @ outline.normals.T - level) * (bases @ outline.normals.T - level) < 0
    lines = bases - tips
    sides = lines[:, :1] * outline.vertices[:, 1] - lines[:, 1:] * outline.vertices[:, 0]
    sides -= (lines[:, 0] * tips[:, 1] - lines[:, 1] * tips[:, 0])[:, None]
    return astride & (sides * np.roll(sides, -1, axis=1) < 0)


def _all_but(passed: Bool[np.ndarray, "k n"], touched: Indices) -> Mask:
    passed[np.arange(len(passed)), touched] = True
    return np.asarray(passed.all(axis=1))

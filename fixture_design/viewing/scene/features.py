"""Key features: a bar through the point along the direction that matters, and the error that is possible there."""

from __future__ import annotations

from collections.abc import Iterator
from math import isinf

import numpy as np

from fixture_design.contacts import unit_normal
from fixture_design.errors import format_length
from fixture_design.layout import FeatureError, Layout, LocatingErrors, Verdict
from fixture_design.viewing.palette import BLACK, FEATURE, GREEN, VERMILLION
from fixture_design.viewing.scene.drawn_sizes import ASIDE, THICK, THIN, TOLERANCE
from fixture_design.viewing.scene.drawn_sizes import FEATURE as HALF
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.shapes import Arrow, Cylinder, Sphere
from fixture_design.viewing.scene.space import lifted

#: Errors are drawn to this many tolerances; larger ones are cut off.
_MOST = 3.0


def feature_things(layout: Layout, verdict: Verdict, size: float) -> Iterator[Thing | Label]:
    """Every key feature, its name with its error where that was asked for."""
    errors = {error.feature: error for error in _errors(verdict)}
    for number, feature in enumerate(layout.key_features):
        point, way = lifted(feature.point), lifted(unit_normal(feature.direction))
        half = HALF * size * way
        path = f"features/{number}"
        yield Thing(f"{path}/point", Sphere(point, 1.3 * THICK * size), FEATURE)
        yield Thing(f"{path}/direction", Cylinder(point - half, point + half, 0.5 * THICK * size), FEATURE)
        error = errors.get(feature.name)
        words = feature.name if error is None else _words(error)
        beyond = (TOLERANCE * (1.0 if error is None else max(1.0, _used(error))) + 1.5 * ASIDE) * size
        yield Label(path, words, point + beyond * way, BLACK)


def _words(error: FeatureError) -> str:
    """ "bore: 34 um of 50 um"; the rest stands beside the answer."""
    if isinf(error.worst):
        return f"{error.feature}: not located"
    return f"{error.feature}: {format_length(error.worst)} of {format_length(error.tolerance)}"


def _used(error: FeatureError) -> float:
    """How many tolerances long an error is drawn."""
    return _MOST if isinf(error.worst) else min(error.worst / error.tolerance, _MOST)


def _errors(verdict: Verdict) -> Iterator[FeatureError]:
    for group in verdict.groups.values():
        for finding in group.findings.values():
            if isinstance(finding.use, LocatingErrors):
                yield from finding.use.features


def error_things(path: str, evidence: LocatingErrors, size: float) -> Iterator[Thing]:
    """For each feature two arrows as long as its error, and discs where its tolerance ends: one length for all."""
    for number, feature in enumerate(evidence.features):
        point, way = lifted(feature.point), lifted(feature.direction)
        used = _used(feature)
        color = GREEN if feature.worst <= feature.tolerance else VERMILLION
        for sign in (-1.0, 1.0):
            step = sign * TOLERANCE * size * way
            ring = point + step
            thin = 0.5 * THIN * size * way
            tip = point + used * step
            if np.any(tip != point):
                yield Thing(f"{path}/error/{number}/{sign:+.0f}", Arrow(point, tip, 0.9 * THICK * size), color)
            yield Thing(
                f"{path}/allowed/{number}/{sign:+.0f}", Cylinder(ring - thin, ring + thin, 1.7 * THICK * size), BLACK
            )

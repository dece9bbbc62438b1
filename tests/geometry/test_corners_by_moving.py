"""Point tips at edges and apices of many non-convex parts, against moving the tip a little and looking where it is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.errors import UnsupportedError
from fixture_design.geometry import PartGeometry, contact_of, load_part
from fixture_design.geometry.winding import winding_number
from fixture_design.layout import Pose
from tests.geometry.parts import element, part, prism, unit, voxels, write

#: How far the tip is moved [m]: well below the size of facets, well above their rounding.
STEP = 1e-6
#: Motions this near to a facet's plane are left out: the parts are known no better [-].
NEAR = 1e-3


def touch(geometry: PartGeometry, at: np.ndarray) -> Contact:
    return contact_of(element(at), geometry, Pose.identity(3), 0.0, 1e-5)


def disagreements(geometry: PartGeometry, at: np.ndarray, motions: np.ndarray) -> tuple[int, int]:
    """How many motions were judged, and how many of them the clauses judge otherwise than the solid does."""
    contact = touch(geometry, at)
    clauses = [[unit(normal) for normal in clause] for clause in contact.clauses]
    judged = wrong = 0
    for motion in motions:
        products = [[float(normal @ motion) for normal in clause] for clause in clauses]
        if min(abs(product) for clause in products for product in clause) < NEAR:
            continue
        admissible = all(min(clause) <= 0 for clause in products)
        # the part moves by the motion, so the tip by its reverse in the part
        inside = winding_number(geometry.vertices, geometry.triangles, at - STEP * motion) > 0.5
        judged += 1
        wrong += admissible == inside
    return judged, wrong


def skewed_heap(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A random heap of cubes that hang together, sheared so that no facet is square to another."""
    cells = {(0, 0, 0)}
    while len(cells) < 9:
        cell = list(cells)[int(rng.integers(len(cells)))]
        step = np.eye(3, dtype=int)[int(rng.integers(3))] * int(rng.choice([-1, 1]))
        cells.add(tuple((np.array(cell) + step).tolist()))
    vertices, triangles = voxels(cells, 0.01)
    shear = np.eye(3) + 0.25 * rng.uniform(-1, 1, (3, 3))
    return vertices @ shear.T, triangles


def star(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A prism over a star-shaped polygon, with a top that slopes."""
    angles = np.sort(2 * np.pi * (np.arange(9) + rng.uniform(-0.3, 0.3, 9)) / 9)
    radii = 0.02 * rng.uniform(0.3, 1.0, 9)
    outline = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)]).tolist()
    vertices, triangles = prism(outline, 0.02)
    slope = rng.uniform(-0.3, 0.3, 2)
    vertices[:, 2] *= 1 + vertices[:, :2] @ slope / 0.02
    return vertices, triangles


@pytest.mark.parametrize("make", [skewed_heap, star])
@pytest.mark.parametrize("seed", range(4))
def test_clauses_are_what_moving_the_tip_finds(make, seed: int, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    geometry = load_part(replace(part(write(tmp_path, make(rng))), faceted=True))
    sides = np.sort(np.vstack([geometry.triangles[:, [0, 1]], geometry.triangles[:, [1, 2]]]), axis=1)
    edges = np.unique(sides, axis=0)
    on_edges = geometry.vertices[edges[rng.permutation(len(edges))[:20]]].mean(axis=1)
    places = np.vstack([geometry.vertices[rng.permutation(len(geometry.vertices))[:20]], on_edges])
    judged, refused = 0, 0
    for at in places:
        try:
            looked_at, wrong = disagreements(geometry, at, rng.normal(size=(60, 3)))
        except UnsupportedError:
            refused += 1
            continue
        assert wrong == 0, touch(geometry, at).feature
        judged += looked_at
    assert judged > 0.8 * 60 * len(places)
    assert refused <= 2

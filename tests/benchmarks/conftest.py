"""Cones and layouts of known size for the benchmarks. Run them with: pytest tests/benchmarks --benchmark-enable"""

from __future__ import annotations

import numpy as np

from fixture_design.contacts import Contact

SIZES = (4, 7, 12, 24, 60)


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def ellipsoid_contacts(count: int, space: str, seed: int = 1) -> tuple[Contact, ...]:
    """Contacts all around a smooth convex body, evenly enough that many of them close it."""
    plane = 2 if space == "planar" else 3
    rng = np.random.default_rng(seed)
    axes = np.array([0.05, 0.03, 0.02])[:plane]
    directions = unit(rng.normal(size=(count, plane)))
    points, normals = directions * axes, directions / axes
    return tuple(
        Contact.on_facet(f"C{i}", "locator", p, n) for i, (p, n) in enumerate(zip(points, normals, strict=True))
    )


def fan(count: int, dimension: int, seed: int = 1) -> np.ndarray:
    """Face vectors in one half-space, so that the cone has many rays."""
    rng = np.random.default_rng(seed)
    return unit(np.column_stack([rng.normal(size=(count, dimension - 1)), np.ones(count)]))

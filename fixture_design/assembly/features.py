"""Apices and facets of planar bodies, with their names: apex k is vertex k, facet k the edge that starts there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import count

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Mask
from fixture_design.assembly.assembly import Assembly, AssemblyBody
from fixture_design.errors import AssemblyError

Plane = Float[np.ndarray, "v 2"]


@dataclass(frozen=True, eq=False)
class PlanarFeatures:
    """The features of one side (the moving body, or all fixed ones), one row for each vertex of each polygon.

    Attributes:
        polygons: the vertices of each body, counter-clockwise, in its own frame (moving) or in W (fixed).
        starts, ends: of the facets, shape (v, 2); apex k is where facet k starts.
        convex: shape (v,); a reflex apex touches nothing but another apex's facets, and forms no pairs of its own.
        apex_names, facet_names: None for those that take no part.
    """

    polygons: tuple[np.ndarray, ...]
    starts: Plane
    ends: Plane
    convex: Mask
    apex_names: tuple[str | None, ...]
    facet_names: tuple[str | None, ...]

    @property
    def tangents(self) -> Plane:
        """Unit vectors along the facets."""
        along = self.ends - self.starts
        return along / np.linalg.norm(along, axis=1, keepdims=True)

    @property
    def normals(self) -> Plane:
        """Outward unit normals of the facets."""
        return self.tangents @ np.array([[0.0, -1.0], [1.0, 0.0]])


def planar_features(assembly: Assembly) -> tuple[PlanarFeatures, PlanarFeatures]:
    """The features of the moving body and of the fixed ones.

    Raises:
        AssemblyError: a polygon that crosses itself, encloses nothing or runs clockwise; an index that is no vertex; a
            name given twice.
    """
    bodies = (assembly.moving, *assembly.fixed)
    given = [name for body in bodies for name in (*body.apices, *body.facets)]
    for name in given:
        if given.count(name) > 1:
            raise AssemblyError(f"the name {name!r} is given twice", expected="another name")
    numbers = (_free("apex", given), _free("facet", given))
    return _features((assembly.moving,), numbers), _features(assembly.fixed, numbers)


def _free(word: str, given: list[str]) -> Iterator[str]:
    """ "apex 1", "apex 2", ..., leaving out names that are given."""
    return (name for number in count(1) if (name := f"{word} {number}") not in given)


def _features(bodies: tuple[AssemblyBody, ...], numbers: tuple[Iterator[str], Iterator[str]]) -> PlanarFeatures:
    polygons = tuple(_polygon(body) for body in bodies)
    names: list[list[str | None]] = [[], []]
    for body, polygon in zip(bodies, polygons, strict=True):
        for kind, (own, automatic) in enumerate(zip((body.apices, body.facets), numbers, strict=True)):
            names[kind] += _named(own, len(polygon)) if body.named else [next(automatic) for _ in polygon]
    starts = np.vstack(polygons)
    ends = np.vstack([np.roll(polygon, -1, axis=0) for polygon in polygons])
    before = np.vstack([polygon - np.roll(polygon, 1, axis=0) for polygon in polygons])
    after = ends - starts
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    return PlanarFeatures(polygons, starts, ends, turn > _STRAIGHT * lengths, tuple(names[0]), tuple(names[1]))


#: Sine of the turn below which two edges run on in one line [-]: decimals of a file leave 1e-15.
_STRAIGHT = 1e-9


def _named(given: Mapping[str, int], size: int) -> list[str | None]:
    names: list[str | None] = [None] * size
    for name, index in given.items():
        if not 0 <= index < size:
            raise AssemblyError(
                f"{name!r} is vertex {index} of a polygon with {size}", expected=f"a number from 0 to {size - 1}"
            )
        if names[index] is not None:
            raise AssemblyError(f"{names[index]!r} and {name!r} are one feature", expected="one name for it")
        names[index] = name
    return names


def _polygon(body: AssemblyBody) -> np.ndarray:
    from shapely.geometry import Polygon as ShapelyPolygon  # 30 ms of any start
    from shapely.validation import explain_validity

    polygon = np.asarray(body.polygon, dtype=np.float64)
    shape = ShapelyPolygon(polygon)
    if not shape.is_valid or shape.area <= 0:
        raise AssemblyError(f"a polygon is no simple one: {explain_validity(shape)}", found=f"{polygon.tolist()}"[:60])
    if not shape.exterior.is_ccw:
        raise AssemblyError("a polygon's vertices run clockwise", expected="them counter-clockwise")
    return polygon if body.pose is None else body.pose.points(polygon)

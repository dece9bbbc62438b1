"""The symmetries of an assembly, found from its features: apices to apices, edges to edges, facets to facets.

Facets with their borders are all of a body's surface, so that a motion that maps them to each other maps the solid to
itself. Every symmetry found is tried on random configurations: distances must be the same by other names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from fixture_design.arrays import Points, Vector
from fixture_design.assembly import rotations
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.polyhedron import Polyhedron
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.assembly.symmetry import Symmetries
from fixture_design.tolerances import APART, SOLVED

#: Images and features that differ by less are the same, relative to the size [-]: images of what touches must touch as
#: well as what was solved.
_SAME = SOLVED / 10

#: Random configurations on which symmetries are tried.
_TRIED = 8

#: The features of one side: kind and number of each, as in the names of pairs, and where they go.
Renaming = dict[str, str]


@dataclass(frozen=True, eq=False)
class _Motion:
    """x -> matrix x + shift, and what it makes of the features' names."""

    matrix: np.ndarray
    shift: Vector
    names: Renaming

    @property
    def mirrored(self) -> bool:
        return bool(np.linalg.det(self.matrix) < 0)


def symmetries_of(geometry: ContactGeometry) -> Symmetries:
    """The symmetries of both sides and the region; in the plane, and for shapes that it does not know, none."""
    none = Symmetries.none(len(geometry.names))
    if not isinstance(geometry, SpatialGeometry):
        return none
    size = _SAME * geometry.size
    numbers = (0, 0, 0), tuple(len(getattr(geometry.moving, key)) for key in ("vertices", "edges", "normals"))
    mine = [found for A in _rotations_of(geometry.moving, size)
            if (found := _motion((geometry.moving,), A, np.zeros(3), numbers[0], size)) is not None]  # fmt: skip
    theirs = [found for B, b in _of_the_region(geometry, size)
              if (found := _motion(geometry.fixed, B, b, numbers[1], size)) is not None]  # fmt: skip
    chosen, rows = [], []
    for a, b in product(mine, theirs):
        turning = geometry.region.turning
        if a.mirrored == b.mirrored and (turning == "free" or np.abs(a.matrix - b.matrix).max() <= _SAME):
            row = _permutation(geometry.names, a.names, b.names)
            if row is not None:
                chosen.append((a, b))
                rows.append(row)
    if len(chosen) < 2:
        return none
    signs = np.array([-1.0 if a.mirrored else 1.0 for a, _ in chosen])[:, None, None]
    A, B = (np.array([pair[k].matrix for pair in chosen]) for k in range(2))
    found = Symmetries(
        np.array(rows),
        rotations.inverse(rotations.from_matrices(signs * A)),
        rotations.from_matrices(signs * B),
        B,
        np.array([b.shift for _, b in chosen]),
        signs.ravel() < 0,
    )
    return found if _true(geometry, found) else none


def _true(geometry: SpatialGeometry, found: Symmetries) -> bool:
    """Whether all distances, what overlaps and what is inside stay the same at random configurations."""
    q = geometry.random(np.random.default_rng(0), _TRIED)
    near = APART * geometry.size
    distances, overlapping = geometry.distances(q), geometry.overlap(q) > near
    for element in range(len(found)):
        elements = np.full(len(q), element)
        image = found.moved(elements, q)
        same = np.abs(geometry.distances(image) - found.permuted(elements, distances)).max() <= near
        same &= ((geometry.overlap(image) > near) == overlapping).all()
        if not same or not geometry.inside(image).all():
            return False
    return True


def _rotations_of(body: Polyhedron, near: float) -> Iterator[np.ndarray]:
    """Orthogonal matrices that take three independent apices to three others, the identity first."""
    yield np.eye(3)
    points = body.vertices
    base = _independent(points)
    if base is None:
        return
    gram = base @ base.T
    lengths = np.linalg.norm(points, axis=1)
    alike = [np.flatnonzero(np.abs(lengths - np.linalg.norm(row)) <= near) for row in base]
    inverse = np.linalg.inv(base)
    for rows in product(*alike):
        images = points[list(rows)]
        if np.abs(images @ images.T - gram).max() <= near * lengths.max():
            matrix = _orthogonal((inverse @ images).T)
            if np.abs(matrix - np.eye(3)).max() > _SAME:
                yield matrix


def _orthogonal(matrix: np.ndarray) -> np.ndarray:
    """The nearest orthogonal one; numbers that are nearly whole, as in all symmetries of boxes, are whole."""
    left, _, right = np.linalg.svd(matrix)
    whole = np.round(left @ right)
    return whole + 0.0 if np.abs(whole - left @ right).max() <= _SAME else left @ right


def _independent(points: Points) -> np.ndarray | None:
    """Three points that are well independent, those first that few others can be images of."""
    lengths = np.round(np.linalg.norm(points, axis=1), 9)
    _, place, count = np.unique(lengths, return_inverse=True, return_counts=True)
    chosen: list[np.ndarray] = []
    for k in np.argsort(count[place.ravel()], kind="stable"):
        rows = np.array([*chosen, points[k]]) / max(lengths.max(), np.finfo(float).tiny)
        if np.linalg.svd(rows, compute_uv=False)[-1] > _INDEPENDENT:
            chosen.append(points[k])
        if len(chosen) == 3:
            return np.array(chosen)
    return None


#: Smallest singular value of points that span space, relative to the largest distance [-].
_INDEPENDENT = 0.05


def _of_the_region(geometry: SpatialGeometry, near: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The motions that map a box to itself, the identity first: axes in another order, and turned around."""
    low, high = geometry.region.low, geometry.region.high
    centre, half = (low + high) / 2, (high - low) / 2
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            if np.abs(half[list(order)] - half).max() <= near:
                B = np.eye(3)[list(order)] * np.array(signs)[:, None]
                yield B, np.where(np.abs(centre - B @ centre) <= near, 0.0, centre - B @ centre)


def _motion(
    bodies: tuple[Polyhedron, ...], matrix: np.ndarray, shift: np.ndarray, first: tuple[int, ...], near: float
) -> _Motion | None:
    """The motion with what it does to the features' names, if each body becomes one of them."""
    images = _images(bodies, matrix, shift, near)
    if images is None:
        return None
    names: Renaming = {}
    starts = np.cumsum([first] + [[len(b.vertices), len(b.edges), len(b.normals)] for b in bodies], axis=0)
    for own, (other, rows) in enumerate(images):
        for kind, word in enumerate(("apex", "edge", "facet")):
            for k, image in enumerate(rows[kind].tolist()):
                names[f"{word} {starts[own][kind] + k + 1}"] = f"{word} {starts[other][kind] + image + 1}"
    return _Motion(matrix, shift, names)


def _images(
    bodies: tuple[Polyhedron, ...], matrix: np.ndarray, shift: np.ndarray, near: float
) -> list[tuple[int, list[np.ndarray]]] | None:
    """Of each body which it becomes, and which features its own become."""
    left, images = list(range(len(bodies))), []
    for body in bodies:
        for other in left:
            rows = _onto(body, bodies[other], matrix, shift, near)
            if rows is not None:
                images.append((other, rows))
                left.remove(other)
                break
        else:
            return None
    return images


def _onto(
    body: Polyhedron, other: Polyhedron, matrix: np.ndarray, shift: np.ndarray, near: float
) -> list[np.ndarray] | None:
    def ends(segments: np.ndarray) -> np.ndarray:
        return segments.reshape(-1, 3) @ matrix.T + shift

    normals = body.normals @ matrix.T
    planes = np.column_stack([normals, body.offsets + normals @ shift]), np.column_stack([other.normals, other.offsets])
    middles = ends(body.edges).reshape(-1, 2, 3), other.edges
    lines = [np.column_stack([e.sum(axis=1), np.abs(e[:, 1] - e[:, 0]), out])
             for e, out in zip(middles, (body.outward @ matrix.T, other.outward), strict=True)]  # fmt: skip
    rows = [
        _matched(ends(body.vertices), other.vertices, near),
        _matched(lines[0], lines[1], 4 * near),
        _facets(body, other, planes, ends, near),
    ]
    known = [row for row in rows if row is not None]
    return known if len(known) == len(rows) else None


def _matched(images: np.ndarray, features: np.ndarray, near: float) -> np.ndarray | None:
    """Which row of the second table each of the first is; None if not each is one, and another."""
    if len(images) != len(features):
        return None
    if not len(images):
        return np.zeros(0, dtype=int)
    apart = np.abs(images[:, None] - features[None]).max(axis=-1)
    rows = apart.argmin(axis=1)
    return rows if apart.min(axis=1).max() <= near and len(set(rows.tolist())) == len(rows) else None


def _facets(
    body: Polyhedron,
    other: Polyhedron,
    planes: tuple[np.ndarray, np.ndarray],
    ends: Callable[[np.ndarray], np.ndarray],
    near: float,
) -> np.ndarray | None:
    """Facets in one plane are told apart by their borders."""
    if len(body.normals) != len(other.normals):
        return None
    left, found = set(range(len(other.normals))), []
    for plane, border in zip(planes[0], body.borders, strict=True):
        image = _unordered(ends(border).reshape(-1, 2, 3))
        here = [k for k in sorted(left) if np.abs(planes[1][k] - plane).max() <= max(near, _SAME)
                and _matched(image, _unordered(other.borders[k]), 4 * near) is not None]  # fmt: skip
        if not here:
            return None
        found.append(here[0])
        left.remove(here[0])
    return np.array(found)


def _unordered(segments: np.ndarray) -> np.ndarray:
    """Segments without their direction: mirrors turn it."""
    return np.column_stack([segments.sum(axis=1), np.abs(segments[:, 1] - segments[:, 0])])


def _permutation(names: tuple[str, ...], mine: Renaming, theirs: Renaming) -> np.ndarray | None:
    """Where each pair goes; None if one goes to none that is known."""
    places = {name: k for k, name in enumerate(names)}
    images = []
    for name in names:
        first, _, second = name.partition(" - ")
        image = places.get(f"{mine.get(first)} - {theirs.get(second)}")
        if image is None:
            return None
        images.append(image)
    return np.array(images)

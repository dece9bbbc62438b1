"""Forces that contacts may be loaded with, made here from plain geometry: nothing of the package but its graph.

A configuration of a state is a random one that its contact equations were solved for (`assembly`, tested there);
normals and levers are worked out here again, contact forces are random in their friction cones, noise is random too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.least_squares import solved
from fixture_design.assembly.sorting import sort_configurations


@dataclass(frozen=True)
class Measured:
    """A wrench and the state it was made in, planar, about the moving part's origin, fixed axes."""

    state: str
    wrench: np.ndarray
    q: np.ndarray


def configurations(graph: ContactStateGraph, state: ContactState, rng: np.random.Generator, count: int) -> np.ndarray:
    """Random ones in a state, from random starts; fewer where few arrive."""
    geometry = geometry_of(graph.assembly)
    pairs = np.array([geometry.names.index(name) for name in state.contacts])
    starts = geometry.random(rng, 6 * count)
    q, left = solved(geometry, starts, np.repeat(pairs[None], len(starts), axis=0))
    found = sort_configurations(geometry, q)
    touching = np.zeros(len(geometry.names), dtype=bool)
    touching[pairs] = True
    good = (left < 1e-9) & found.clear & (found.touching == touching).all(axis=1)
    return q[good][:count]


#: Figure 14 once more: apices and facets, (start, end) in the frame of their body; outward normals by hand.
MOVING_APICES = {"apex 3": (-1.0, 0.0), "apex 4": (1.0, 0.0)}
FIXED_APICES = {"apex 1": (-1.5, 0.0), "apex 2": (1.5, 0.0)}
#: Normals of the fixed facets point out of the fixed body, those of the moving ones out of the peg.
FIXED_NORMALS = {"facet 5": (0.0, 1.0), "facet 8": (0.0, 1.0), "facet 6": (1.0, 0.0), "facet 7": (-1.0, 0.0)}
MOVING_NORMALS = {"facet 2": (-1.0, 0.0), "facet 3": (0.0, -1.0), "facet 4": (1.0, 0.0)}


def contact_of(name: str, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The contact's point from the peg's origin, and the peg's outward normal there."""
    c, s = np.cos(q[2]), np.sin(q[2])
    R = np.array([[c, -s], [s, c]])
    mine, theirs = name.split(" - ")
    if mine in MOVING_APICES:
        return R @ np.array(MOVING_APICES[mine]), -np.array(FIXED_NORMALS[theirs])
    return np.array(FIXED_APICES[theirs]) - q[:2], R @ np.array(MOVING_NORMALS[mine])


def wrench_at(q: np.ndarray, contacts: tuple[str, ...], friction: float, rng: np.random.Generator) -> np.ndarray:
    """What is applied to the peg while random contact forces hold it: normal ones of any size, friction within mu."""
    total = np.zeros(3)
    for name in contacts:
        x, n = contact_of(name, q)
        force = rng.exponential() * (n + rng.uniform(-friction, friction) * np.array([-n[1], n[0]]))
        total += [*force, x[0] * force[1] - x[1] * force[0]]
    return total


def measured(
    graph: ContactStateGraph, rng: np.random.Generator, count: int, friction: float = 0.0, noise: float = 0.0
) -> list[Measured]:
    """Forces in every state with contacts and without coincident apices.

    Args:
        noise: standard deviation of the error's length, relative to the force's: three equal normal components [-].
    """
    found = []
    for state in graph.states:
        if not state.contacts or state.coincident:
            continue
        for q in configurations(graph, state, rng, count):
            wrench = wrench_at(q, state.contacts, friction, rng)
            error = rng.normal(size=3) * noise * np.linalg.norm(wrench) / np.sqrt(3)
            found.append(Measured(state.id, wrench + error, q))
    return found


@dataclass(frozen=True)
class TrueSets:
    """Which states a wrench may have been made in, to 2e-3 or so: the limit of what any classifier can tell.

    A facet on an apex makes a family of forces with two parameters, and these are solved for: the force's direction
    gives the angle, its moment the place on the facet. In all other states one parameter is left, and many
    configurations come near enough.

    Attributes:
        rows: for each of these the faces of the force cones at its configurations, shape (n, m, 3), unit; unused ones
            zero.
        within: how far outside of the nearest of them fresh forces of the state itself are at most [-].
    """

    geometry: ContactGeometry
    friction: float
    rows: dict[str, np.ndarray]
    within: dict[str, float]
    facets: dict[str, str]

    @classmethod
    def of(cls, graph: ContactStateGraph, rng: np.random.Generator, count: int, friction: float) -> TrueSets:
        rows, within, facets = {}, {}, {}
        for state in graph.states:
            if not state.contacts or state.coincident:
                continue
            if len(state.contacts) == 1 and state.contacts[0].startswith("facet"):
                facets[state.id] = state.contacts[0]
                continue
            q = configurations(graph, state, rng, count)
            rows[state.id] = np.array([_faces(rays_at(one, state.contacts, friction)) for one in q])
            fresh = configurations(graph, state, rng, 60)
            distances = [_nearest(rows[state.id], wrench_at(one, state.contacts, friction, rng)) for one in fresh]
            within[state.id] = max(*distances, 1e-9)
        return cls(geometry_of(graph.assembly), friction, rows, within, facets)

    def states(self, wrench: np.ndarray) -> set[str]:
        near = {name for name, rows in self.rows.items() if _nearest(rows, wrench) <= self.within[name]}
        return near | {name for name, contact in self.facets.items() if self._on_facet(contact, wrench)}

    def _on_facet(self, contact: str, wrench: np.ndarray) -> bool:
        """Whether some configuration with an apex on a facet of the peg, and some friction, makes the wrench."""
        facet, apex = contact.split(" - ")
        force, widest = wrench[:2], np.arctan(self.friction)
        angles = np.linspace(-widest, widest, 41 if self.friction else 1)
        own = np.arctan2(*MOVING_NORMALS[facet][::-1])
        thetas = np.arctan2(force[1], force[0]) + angles - own
        thetas = (thetas + np.pi) % (2 * np.pi) - np.pi
        start, along = FACET_LINES[facet]
        q = []
        for theta in thetas:
            c, s = np.cos(theta), np.sin(theta)
            R = np.array([[c, -s], [s, c]])
            there = R.T @ force  # the moment is (start + k along) x there
            k = (wrench[2] - _cross(start, there)) / _cross(along, there)
            if FACET_ENDS[facet][0] - 1e-6 <= k <= FACET_ENDS[facet][1] + 1e-6:
                q.append([*(np.array(FIXED_APICES[apex]) - R @ (np.array(start) + k * np.array(along))), theta])
        if not q:
            return False
        tried = np.array(q)
        return bool((self.geometry.inside(tried) & (self.geometry.overlap(tried) <= 1e-6)).any())


#: The facets of the peg: a point, a unit vector along, and from where to where.
FACET_LINES = {
    "facet 2": ((-1.0, 0.0), (0.0, 1.0)),
    "facet 3": ((0.0, 0.0), (1.0, 0.0)),
    "facet 4": ((1.0, 0.0), (0.0, 1.0)),
}
FACET_ENDS = {"facet 2": (0.0, 30.0), "facet 3": (-1.0, 1.0), "facet 4": (0.0, 30.0)}


def _cross(a: tuple[float, float], b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def rays_at(q: np.ndarray, contacts: tuple[str, ...], friction: float) -> np.ndarray:
    """Unit wrenches that span the force cone of a configuration, shape (k, 3)."""
    rays = []
    for name in contacts:
        x, n = contact_of(name, q)
        for slope in {-friction, friction}:
            force = n + slope * np.array([-n[1], n[0]])
            rays.append([*force, x[0] * force[1] - x[1] * force[0]])
    array = np.array(rays)
    return array / np.linalg.norm(array, axis=1, keepdims=True)


def _faces(rays: np.ndarray) -> np.ndarray:
    """Face vectors of the cone of one, two or four rays in R3, shape (8, 3), the rest zero: by hand, no conversion."""
    found = []
    if len(rays) == 1:
        across = np.linalg.svd(rays)[2][1:]
        found = [*across, *-across, -rays[0]]
    else:
        pairs = [(i, j) for i in range(len(rays)) for j in range(i + 1, len(rays))]
        for i, j in pairs:
            normal = np.cross(rays[i], rays[j])
            size = np.linalg.norm(normal)
            if size < 1e-9:
                continue
            for face in (normal / size, -normal / size):
                if (rays @ face <= 1e-9).all():
                    found.append(face)
        if len(found) == 2 and np.allclose(found[0], -found[1]):  # flat: a fan in a plane
            mean = rays.mean(axis=0)
            for ray in rays:
                side = np.cross(found[0], ray)
                side = side if side @ mean <= 0 else -side
                if (rays @ side <= 1e-9).all():
                    found.append(side)
    return np.vstack([np.array(found).reshape(-1, 3), np.zeros((8, 3))])[:8]


def _nearest(rows: np.ndarray, wrench: np.ndarray) -> float:
    return float((rows @ (wrench / np.linalg.norm(wrench))).max(axis=1).min())

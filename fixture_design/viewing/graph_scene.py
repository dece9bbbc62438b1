"""A contact-state graph in space as a scene: the fixed bodies, and of each state one configuration to look at."""

from __future__ import annotations

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph, geometry_of
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.tolerances import TOUCHING
from fixture_design.viewing.graph_solids import DrawnBody, drawn
from fixture_design.viewing.palette import BLUE, EDGES, PART, VERMILLION
from fixture_design.viewing.scene import Layer, Scene, Story, Thing
from fixture_design.viewing.scene.camera import camera_of
from fixture_design.viewing.scene.shapes import Lines, Mesh, Points3, Sphere

#: How much of what is behind the bodies shows: contacts are between them.
_FIXED_OPACITY, _MOVING_OPACITY = 0.35, 0.8

#: Radius of the dots at contacts, relative to the moving body [-].
_DOT = 0.02

#: States with no more contacts are listed with them.
_NAMED = 2


def graph_scene(graph: ContactStateGraph) -> Scene:
    """A story for each state: the moving body at its first sample, with dots where it touches.

    Raises:
        InputError: the bodies cannot be read.
    """
    geometry, moving = geometry_of(graph.assembly), drawn(graph.assembly.moving)
    fixed = [drawn(body) for body in graph.assembly.fixed]
    size = float(np.linalg.norm(np.ptp(moving.corners, axis=0))) / 2
    placed = [_placed(geometry, moving.corners, state.samples[0]) for state in graph.states]
    near = np.vstack(placed) if placed else np.vstack([body.corners for body in fixed])
    center = (near.min(axis=0) + near.max(axis=0)) / 2
    camera = camera_of("spatial", (), near, center)
    stories = tuple(_story(geometry, moving, state, number, size) for number, state in enumerate(graph.states))
    complete = "" if graph.complete else "; the search was interrupted, there may be more"
    return Scene(
        name=graph.assembly.name,
        center=center,
        size=size,
        things=tuple(thing for number, body in enumerate(fixed) for thing in _body(f"fixed/{number}", body)),
        labels=(),
        stories=stories,
        layers=(Layer("fixed", "fixed bodies", PART),),
        camera=camera,
        first=0 if stories else None,
        summary=f"{len(graph.states)} contact states, {len(graph.transitions)} direct transitions{complete}",
    )


def _placed(geometry: ContactGeometry, points: Points3, q: np.ndarray) -> Points3:
    return points @ geometry.rotations(q[None])[0].T + q[:3]


def _body(path: str, body: DrawnBody) -> tuple[Thing, Thing]:
    return Thing(f"{path}/solid", body.mesh, PART, _FIXED_OPACITY), Thing(f"{path}/edges", Lines(body.edges), EDGES)


def _story(geometry: ContactGeometry, moving: DrawnBody, state: ContactState, number: int, size: float) -> Story:
    q, path = state.samples[0], f"states/{number}"
    mesh = Mesh(_placed(geometry, moving.mesh.vertices, q), moving.mesh.triangles)
    edges = _placed(geometry, moving.edges.reshape(-1, 3), q).reshape(-1, 2, 3)
    touching = np.flatnonzero(geometry.distances(q[None])[0] <= TOUCHING * geometry.size)
    points = geometry.arms(q[None], touching[None])[0] + q[:3] if touching.size else np.zeros((0, 3))
    dots = [Thing(f"{path}/dots/{k}", Sphere(point, _DOT * size), VERMILLION) for k, point in enumerate(points)]
    count = len(state.contacts)
    words = "; ".join(state.contacts) or "no contact"
    return Story(
        path=path,
        group=f"{count or 'no'} contact{'s' if count > 1 else ''}",
        claim=state.id,
        answer=None,
        required=False,
        words=words,
        things=(
            Thing(f"{path}/solid", mesh, BLUE, _MOVING_OPACITY),
            Thing(f"{path}/edges", Lines(edges), EDGES),
            *dots,
        ),
        caption="two apices in one point" if state.coincident else "",
        said=words if count <= _NAMED else f"{count} contacts",
    )

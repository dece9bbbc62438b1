"""The scene of a layout and its verdict."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np

from fixture_design.contacts import ROLES
from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.palette import FEATURE, LOAD, PART, ROLE_COLORS
from fixture_design.viewing.scene.acting import load_things
from fixture_design.viewing.scene.camera import aimed, camera_of
from fixture_design.viewing.scene.contact_marks import contact_things
from fixture_design.viewing.scene.elements import element_things
from fixture_design.viewing.scene.features import feature_things
from fixture_design.viewing.scene.scene import Camera, Label, Layer, Scene, Story, Thing
from fixture_design.viewing.scene.shapes import Points3
from fixture_design.viewing.scene.solid import Solid, body_things, part_things, solid_of, where
from fixture_design.viewing.scene.stories import first_story, stories_of
from fixture_design.viewing.scene.tessellation import extent, hull_of, joined, triangles_of


def scene_of(
    layout: Layout,
    verdict: Verdict,
    solid: Solid | None = None,
    tell: Collection[tuple[str, str]] | None = None,
    camera: Camera | None = None,
) -> Scene:
    """Everything there is to see of a layout: the part, what touches it, what acts, and a story for each answer.

    Args:
        verdict: of ``layout``, as `verify` gave it; its contacts are drawn.
        solid: the part's, where it is made already (`solid_of`): that of the layout's part where it stands.
        tell: (group, claim) of the stories that are wanted with all there is to see; by default of all. What follows a
            slider has no time for those that nobody looks at.
        camera: that looks already, at this and at every story; by default one is placed that has all in view.

    Raises:
        InputError: the part or a body cannot be read.
    """
    solid = solid or solid_of(layout)
    center, size = where(solid, verdict)
    things, labels = _sorted(
        (
            *part_things(solid, verdict.contacts, size),
            *body_things(layout, size),
            *element_things(layout, verdict.contacts, size),
            *contact_things(layout, verdict.contacts, size),
            *load_things(layout, center, size),
            *feature_things(layout, verdict, size),
        )
    )
    surface = joined([triangles_of(thing.shape) for thing in things if thing.path.startswith("part/") and thing.solid])
    hull = hull_of(surface.vertices) if solid is None else solid.hull
    stories = stories_of(layout, verdict, surface, hull, center, size, tell)
    if camera is None:
        still = [thing.shape for thing in things if not thing.path.startswith(("loads", "normals", "cones"))]
        seen = hull_of(extent(still))
        camera = camera_of(layout.space, verdict.contacts, seen, center)
        stories = tuple(replace(story, camera=_camera(camera, story, seen, hull)) for story in stories)
    return Scene(
        name=layout.name,
        center=center,
        size=size,
        things=things,
        labels=labels,
        stories=stories,
        layers=tuple(_layers(layout, things)),
        camera=camera,
        satisfied=verdict.satisfied,
        first=first_story(stories),
        notes=verdict.notes,
    )


def _camera(camera: Camera, story: Story, seen: Points3, hull: Points3) -> Camera:
    """Has what the story shows in view too, and the part where it moves to unless that is far."""
    shown = [seen]
    if story.things:
        shown.append(extent([thing.shape for thing in story.things]))
    if story.animation is not None and not story.animation.far:
        shown.append(story.animation.poses[-1].points(hull))
    return aimed(camera, np.vstack(shown))


def _sorted(found: Iterable[Thing | Label]) -> tuple[tuple[Thing, ...], tuple[Label, ...]]:
    everything = list(found)
    things = tuple(each for each in everything if isinstance(each, Thing))
    return things, tuple(each for each in everything if isinstance(each, Label))


def _layers(layout: Layout, things: tuple[Thing, ...]) -> Iterable[Layer]:
    """The legend: only what is there."""
    feet = {"locator": "block at the foot", "clamp": "knob", "support": "cone", "finger": "ball at the foot"}
    known = [Layer("part", "part", PART)]
    known += [Layer(f"elements/{role}", f"{role} ({feet[role]})", ROLE_COLORS[role]) for role in ROLES]
    known += [
        Layer("bodies", "fixture bodies", ROLE_COLORS[layout.bodies[0].role] if layout.bodies else PART),
        Layer("contacts", "contact points", "#000000", "dot"),
        Layer("normals", "pushes on the part, along the inward normals", ROLE_COLORS["locator"], "arrow"),
        Layer("cones", "friction cones", ROLE_COLORS["locator"], "cone"),
        Layer("loads", "loads", LOAD, "arrow"),
        Layer("features", "key features", FEATURE, "dot"),
    ]
    there = {thing.path for thing in things}
    return [layer for layer in known if any(path.startswith(layer.path + "/") for path in there)]

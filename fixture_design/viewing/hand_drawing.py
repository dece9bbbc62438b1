"""A hand in a scene: its links, translucent, around the part that it holds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fixture_design.grasp.posture import Posture
from fixture_design.viewing.palette import SKY_BLUE
from fixture_design.viewing.scene.camera import aimed
from fixture_design.viewing.scene.scene import Layer, Scene, Story, Thing
from fixture_design.viewing.scene.shapes import Mesh, Points3
from fixture_design.viewing.scene.tessellation import extent, hull_of

#: How much of what is behind a hand shows: the contacts are.
_OPACITY = 0.45


def with_hand(scene: Scene, posture: Posture) -> Scene:
    """The scene of a grasp's layout with the hand that makes it, all of it in view."""
    things = tuple(hand_things(posture))
    shown = [thing.shape for thing in (*scene.things, *things) if not thing.path.startswith(("loads", "cones"))]
    seen = hull_of(extent(shown))
    return replace(
        scene,
        things=(*scene.things, *things),
        layers=(*scene.layers, Layer("hand", f"hand: {posture.model.name}", SKY_BLUE)),
        camera=aimed(scene.camera, seen),
        stories=tuple(_seen_with(story, seen) for story in scene.stories),
        first=_first(scene),
    )


def _first(scene: Scene) -> int | None:
    """Force closure, which is what grasps are for; where there is nothing to see of it, what was first."""
    for number, story in enumerate(scene.stories):
        if story.group == "all" and story.claim == "force_closure" and story.shown:
            return number
    return scene.first


def hand_things(posture: Posture) -> Iterator[Thing]:
    """The links in W."""
    poses = posture.links()
    for number, (name, link) in enumerate(posture.model.links.items()):
        vertices = poses[name].points(link.geometry.vertices)
        yield Thing(f"hand/{number}", Mesh(vertices, link.geometry.triangles.astype(np.int64)), SKY_BLUE, _OPACITY)


def _seen_with(story: Story, seen: Points3) -> Story:
    return story if story.camera is None else replace(story, camera=aimed(story.camera, seen))

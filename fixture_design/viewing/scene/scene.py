"""One description of a picture, whatever draws it: things in W with colours and paths, labels, motions, words.

A scene has *layers*, always there (the part, elements by role, contacts, loads), which a viewer may switch off; and
*stories*, of which one at a time is told: for each answer of the verdict what shows it. A path names a thing or a group
of things, as folders do: the path of a layer is the beginning of the paths of its things.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float

from fixture_design.layout import Answer, Pose
from fixture_design.viewing.scene.shapes import Lines, Points3, Shape, Vector3


@dataclass(frozen=True, eq=False)
class Thing:
    """Something to draw.

    Attributes:
        path: unique, made here and not of names from files: "elements/clamp/2/stem".
        color: "#rrggbb".  opacity: 1 hides what is behind.
    """

    path: str
    shape: Shape
    color: str
    opacity: float = 1.0

    @property
    def solid(self) -> bool:
        """Whether it has a surface, as all but lines do."""
        return not isinstance(self.shape, Lines)


@dataclass(frozen=True, eq=False)
class Label:
    """Words at a point in W; ``path``: of the layer or story with which they come and go."""

    path: str
    text: str
    point: Vector3
    color: str = "#000000"


@dataclass(frozen=True, eq=False)
class Animation:
    """A group that moves, there and back, for ever.

    Attributes:
        path: of what moves.
        poses: motions in W from where it stands, the identity first, to its farthest point; evenly in time.
        seconds: from the first to the last.
        both_ways: it goes as far the other way, with the inverse motions.
        far: it leaves the picture, which is not made to hold it.
    """

    path: str
    poses: tuple[Pose, ...]
    seconds: float
    both_ways: bool = False
    far: bool = False


@dataclass(frozen=True, eq=False)
class Story:
    """What shows one answer.

    Attributes:
        path: of its things.  group, claim, answer: of the verdict.  required: somebody asked for it.
        words: the evidence in words.  caption: what is drawn, and how much it is exaggerated.
        things: drawn while it is told.  animation: played meanwhile.
        without: layers that step aside meanwhile.
        camera: that has all of it in view.
        said: what stands in the place of the answer's word, where the story is of something else.
    """

    path: str
    group: str
    claim: str
    answer: Answer | None
    required: bool
    words: str
    caption: str = ""
    things: tuple[Thing, ...] = ()
    labels: tuple[Label, ...] = ()
    animation: Animation | None = None
    without: tuple[str, ...] = ()
    camera: Camera | None = None
    said: str | None = None

    @property
    def shown(self) -> bool:
        """Whether there is anything to see."""
        return bool(self.things) or self.animation is not None


@dataclass(frozen=True)
class Layer:
    """A line of the legend: ``text`` beside a mark in ``color``, for the things under ``path``.

    ``mark``: what they look like: "solid", "arrow" or "cone".  ``hidden``: at first.
    """

    path: str
    text: str
    color: str
    mark: str = "solid"
    hidden: bool = False


@dataclass(frozen=True, eq=False)
class Camera:
    """Looks from ``eye`` at ``target``, in W [m], z (in the plane y) up; ``fov``: its height [rad]."""

    eye: Vector3
    target: Vector3
    up: Vector3
    fov: float


@dataclass(frozen=True, eq=False)
class Scene:
    """A layout with its verdict, to look at.

    Attributes:
        center, size: where the part is, in W, and half its diagonal [m]; adapters draw (p - center) / size, so that
            parts of a millimetre and far from the origin are drawn as exactly as any.
        first: index into ``stories`` of the one to begin with; None without.
        camera: that has everything in view but what stories add.
        satisfied: as of the verdict.
        summary: what stands in its place, where the scene is of something else than a verdict.
    """

    name: str
    center: Vector3
    size: float
    things: tuple[Thing, ...]
    labels: tuple[Label, ...]
    stories: tuple[Story, ...]
    layers: tuple[Layer, ...]
    camera: Camera
    satisfied: Answer | None = None
    first: int | None = None
    notes: tuple[str, ...] = ()
    summary: str | None = None

    def to_view(self, points: Points3) -> Points3:
        """Points in W, shape (n, 3), as they are drawn: the part about the origin, its half diagonal 1."""
        return (points - self.center) / self.size

    def matrix(self, pose: Pose) -> Float[np.ndarray, "4 4"]:
        """A motion in W as a matrix in the coordinates that are drawn."""
        found = np.eye(4)
        found[:3, :3] = pose.rotation
        found[:3, 3] = self.to_view(pose.points(self.center[None]))[0]
        return found

    def told(self, story: Story | None) -> tuple[tuple[Thing, ...], tuple[Label, ...]]:
        """Things and labels that are seen while a story is told, as long as nobody switches a layer."""
        off = [layer.path for layer in self.layers if layer.hidden] + list(story.without if story else ())
        things = [thing for thing in self.things if not _under(thing.path, off)]
        labels = [label for label in self.labels if not _under(label.path, off)]
        return (*things, *(story.things if story else ())), (*labels, *(story.labels if story else ()))


def _under(path: str, layers: list[str]) -> bool:
    return any(path == layer or path.startswith(layer + "/") for layer in layers)


def changed_paths(before: tuple[Thing, ...], after: tuple[Thing, ...]) -> tuple[tuple[str, ...], frozenset[str]]:
    """Paths that are gone, and those that are new or look different: what has to be drawn again after a change."""
    old = {thing.path: thing for thing in before}
    new = frozenset(thing.path for thing in after if thing.path not in old or not _alike(old[thing.path], thing))
    kept = {thing.path for thing in after}
    return tuple(path for path in old if path not in kept), new


def _alike(first: Thing, second: Thing) -> bool:
    if (first.color, first.opacity, type(first.shape)) != (second.color, second.opacity, type(second.shape)):
        return False
    pairs = ((getattr(first.shape, each.name), getattr(second.shape, each.name)) for each in fields(first.shape))
    return first.shape is second.shape or all(one is other or np.array_equal(one, other) for one, other in pairs)

"""A scene for the viewer of the meshcat package: as commands for a page, or sent to a `meshcat.Visualizer`.

Everything is under `/scene` in the coordinates of the view: the part about the origin, half as long as 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from fixture_design.layout import Pose
from fixture_design.viewing.palette import GROUND, rgb
from fixture_design.viewing.rounds import rounds
from fixture_design.viewing.scene import Animation, Lines, Scene, Thing, triangles_of

if TYPE_CHECKING:
    from meshcat import Visualizer

#: What is there before anything is drawn, and not wanted.
_HIDDEN = ("Grid", "Axes")


def draw(scene: Scene, visualizer: Visualizer) -> None:
    """Draws a scene with its first story into a running viewer of the meshcat package, and plays its motion once."""
    from meshcat.animation import Animation as Clips  # noqa: PLC0415 - meshcat only where it draws
    from meshcat.commands import SetAnimation  # noqa: PLC0415 - as above

    story = None if scene.first is None else scene.stories[scene.first]
    for command in commands(scene, scene.told(story)[0]):
        visualizer.window.send(command)
    if story is not None and story.animation is not None:
        visualizer.window.send(SetAnimation(_clips(scene, story.animation, Clips())))


def commands(scene: Scene, things: tuple[Thing, ...]) -> Iterator[Any]:
    """The camera, the background and the things, as commands of `meshcat.commands`."""
    from meshcat.commands import SetObject, SetProperty  # noqa: PLC0415 - as above
    from meshcat.geometry import PerspectiveCamera  # noqa: PLC0415 - as above
    from meshcat.path import Path  # noqa: PLC0415 - as above

    for name in _HIDDEN:
        yield SetProperty("visible", False, Path((name,)))
    for end in ("top_color", "bottom_color"):
        yield SetProperty(end, list(rgb(GROUND)), Path(("Background",)))
    fov: Any = float(np.degrees(scene.camera.fov))
    near: Any = 0.02
    camera = PerspectiveCamera(fov=fov, aspect=1, near=near, far=200)
    camera.uuid = "camera"
    yield SetObject(camera, None, Path(("Cameras", "default", "rotated")))
    x, y, z = scene.to_view(scene.camera.eye[None])[0].tolist()
    # there the world is y up
    yield SetProperty("position", [x, z, -y], Path(("Cameras", "default", "rotated", "<object>")))
    for thing in things:
        shown = _object(scene, thing)
        # not the random ones: the same scene is the same page
        shown.uuid, shown.geometry.uuid, shown.material.uuid = (f"{thing.path}:{kind}" for kind in "ogm")
        yield SetObject(shown, None, Path(("scene", *thing.path.split("/"))))


def _object(scene: Scene, thing: Thing) -> Any:
    from meshcat import geometry  # noqa: PLC0415 - as above

    color = int(thing.color[1:], 16)
    if isinstance(thing.shape, Lines):
        points = scene.to_view(thing.shape.segments.reshape(-1, 3)).astype(np.float32)
        thin: Any = geometry.LineBasicMaterial(color=color)
        return geometry.LineSegments(geometry.PointsGeometry(points.T), thin)
    mesh = triangles_of(thing.shape)
    shape = geometry.TriangularMeshGeometry(scene.to_view(mesh.vertices), mesh.triangles)
    seen_through = thing.opacity < 1
    material = geometry.MeshPhongMaterial(
        color=color, opacity=thing.opacity, transparent=seen_through, flatShading=not mesh.smooth,
        depthWrite=not seen_through, shininess=12,
        # lines on a surface are in front of it
        polygonOffset=True, polygonOffsetFactor=1, polygonOffsetUnits=1,
    )  # fmt: skip
    return geometry.Mesh(shape, material)


def _clips(scene: Scene, animation: Animation, clips: Any) -> Any:
    from meshcat.animation import AnimationClip  # noqa: PLC0415 - as above
    from meshcat.path import Path  # noqa: PLC0415 - as above

    clip = AnimationClip(fps=1)  # frames are seconds
    for time, pose in rounds(animation):
        position, quaternion = _placed(scene, pose)
        clip.set_property(time, "position", "vector3", position)
        clip.set_property(time, "quaternion", "quaternion", quaternion)
    clips.clips[Path(("scene", *animation.path.split("/")))] = clip
    return clips


def tracks(scene: Scene, animation: Animation) -> list[dict[str, object]]:
    """Positions and quaternions over time, as three.js has them."""
    found = [(time, _placed(scene, pose)) for time, pose in rounds(animation)]
    return [
        {"name": f".{name}", "type": kind, "keys": [{"time": time, "value": placed[k]} for time, placed in found]}
        for k, (name, kind) in enumerate((("position", "vector3"), ("quaternion", "quaternion")))
    ]


def _placed(scene: Scene, pose: Pose) -> tuple[list[float], list[float]]:
    """Position and quaternion [x, y, z, w] in the coordinates of the view."""
    from meshcat.transformations import quaternion_from_matrix  # noqa: PLC0415 - as above

    matrix = scene.matrix(pose)
    w, x, y, z = quaternion_from_matrix(matrix).tolist()
    return matrix[:3, 3].tolist(), [x, y, z, w]

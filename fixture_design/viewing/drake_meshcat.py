"""A scene in Drake's Meshcat: the live session in a browser, bound to this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fixture_design.layout import Pose
from fixture_design.viewing.palette import GROUND, rgb
from fixture_design.viewing.scene import Label, Lines, Scene, Sphere, Story, Thing, changed_paths, triangles_of

if TYPE_CHECKING:
    from pydrake.geometry import Meshcat

#: Where everything is, below Drake's own root.
ROOT = "scene"

#: Below that, names at their points; the path of a label that is said rather than written somewhere.
LABELS, SAID = "labels", "said"

#: Width of thin lines [pixels].
_THIN = 1.5


def started(port: int | None = None) -> Meshcat:
    """A Meshcat that only this machine can reach; on the first free port from 7000 on where none is given.

    Raises:
        RuntimeError: the port is taken.
    """
    from pydrake.geometry import Meshcat, MeshcatParams  # noqa: PLC0415 - Drake only where it draws

    parameters: Any = MeshcatParams(host="localhost", port=port, show_stats_plot=False)
    meshcat: Any = Meshcat(parameters)
    for path in ("/Grid", "/Axes"):
        meshcat.SetProperty(path, "visible", False)
    for end in ("top_color", "bottom_color"):
        meshcat.SetProperty("/Background", end, list(rgb(GROUND)))
    return meshcat


def draw(
    meshcat: Meshcat, scene: Scene, story: Story | None = None, before: tuple[Thing, ...] | None = None
) -> tuple[Thing, ...]:
    """Draws a scene while a story is told (by default the first one), and plays its motion.

    Args:
        before: what the last call returned: then only what differs is sent, and the camera stays. Center and size of
            both scenes must be the same.

    Returns:
        the things that are there now.
    """
    board: Any = meshcat
    story = story or (None if scene.first is None else scene.stories[scene.first])
    things, labels = scene.told(story)
    things = (*things, *(_written(label, number) for number, label in enumerate(labels) if label.text.strip()))
    if before is None:
        board.Delete(ROOT)
        camera = scene.camera if story is None or story.camera is None else story.camera
        eye, target = scene.to_view(np.array([camera.eye, camera.target]))
        board.SetCamera(board.PerspectiveCamera(fov=float(np.degrees(camera.fov)), near=0.02, far=200.0))
        board.SetCameraPose(eye, target)
        drawn = things
    else:
        gone, new = changed_paths(before, things)
        for path in gone:
            board.Delete(f"{ROOT}/{path}")
        drawn = tuple(thing for thing in things if thing.path in new)
    for thing in drawn:
        _draw(board, scene, thing)
    _play(board, scene, story)
    return things


def _draw(board: Any, scene: Scene, thing: Thing) -> None:
    from pydrake.geometry import Rgba  # noqa: PLC0415 - as above
    from pydrake.math import RigidTransform  # noqa: PLC0415 - as above

    color = Rgba(*rgb(thing.color), thing.opacity)
    path = f"{ROOT}/{thing.path}"
    if thing.path.startswith(LABELS + "/") and isinstance(thing.shape, Sphere):
        board.SetTransform(path, RigidTransform(scene.to_view(thing.shape.center[None])[0]))
        return
    if isinstance(thing.shape, Lines):
        ends = scene.to_view(thing.shape.segments.reshape(-1, 3)).reshape(-1, 2, 3)
        board.SetLineSegments(path, ends[:, 0].T, ends[:, 1].T, _THIN, color)
        return
    mesh = triangles_of(thing.shape)
    board.SetTriangleMesh(path, scene.to_view(mesh.vertices).T, mesh.triangles.T.astype(np.int32), color)


def _written(label: Label, number: int) -> Thing:
    """A name, which this Meshcat cannot write: the session's page reads it from the path of a point."""
    where = SAID if label.path == SAID else str(number)
    return Thing(
        f"{LABELS}/{where}/{label.color[1:]}-{label.text.encode().hex()}", Sphere(label.point, 0.0), label.color
    )


def _play(board: Any, scene: Scene, story: Story | None) -> None:
    """The story's motion there and back, three times over; then the part stands where it is."""
    from pydrake.geometry import MeshcatAnimation  # noqa: PLC0415 - as above

    from fixture_design.viewing.rounds import rounds  # noqa: PLC0415 - as above

    animation: Any = MeshcatAnimation(frames_per_second=30.0)
    if story is None or story.animation is None:
        # what a story before this one has moved stands still, where it is
        board.SetAnimation(animation)
        board.SetTransform(f"{ROOT}/part", _transform(scene, Pose.identity(3)))
        return
    path = f"{ROOT}/{story.animation.path}"
    for time, pose in rounds(story.animation):
        animation.SetTransform(animation.frame(time), path, _transform(scene, pose))
    animation.set_repetitions(3)
    board.SetAnimation(animation)


def _transform(scene: Scene, pose: Pose) -> Any:
    from pydrake.math import RigidTransform, RotationMatrix  # noqa: PLC0415 - as above

    matrix: Any = scene.matrix(pose)
    return RigidTransform(RotationMatrix.ProjectToRotationMatrix(matrix[:3, :3]), matrix[:3, 3])

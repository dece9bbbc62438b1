"""A scene as PNG through Drake's offscreen renderer: no browser, no screen; it needs EGL."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from fixture_design.errors import UnsupportedError
from fixture_design.viewing.palette import GROUND, MOTION, rgb
from fixture_design.viewing.projection import Projection
from fixture_design.viewing.scene import Mesh, Scene, Story, Thing, facet_soup, joined, triangles_of

#: What of the moved part shows at its farthest place.
GHOST_OPACITY = 0.13

_ENGINE = "picture"


def render(
    scene: Scene, things: Sequence[Thing], story: Story | None, view: Projection
) -> tuple[np.ndarray, np.ndarray]:
    """Colours and depths of the solid things, and of a ghost of what the story moves, where it gets to.

    Args:
        view: the camera, and the size of the picture.

    Returns:
        shape (height, width, 3), bytes; and shape (height, width), infinite where nothing is [view's unit].

    Raises:
        UnsupportedError: there is no EGL, or no graphics driver behind it.
    """
    _require_egl()
    from pydrake.geometry import SceneGraph  # noqa: PLC0415 - Drake only where a picture is made

    graph: Any = SceneGraph()
    source = graph.RegisterSource("scene")
    for number, (mesh, color, opacity) in enumerate(_solids(scene, things, story, view)):
        graph.RegisterAnchoredGeometry(source, _instance(str(number), mesh, color, opacity))
    try:
        graph.AddRenderer(_ENGINE, _engine())
        return _images(graph, view)
    except (RuntimeError, SystemExit) as cause:
        raise UnsupportedError(f"Drake's renderer does not start: {cause}", expected=_NEEDED) from cause


_NEEDED = "EGL with a driver (Debian: libegl1 and libgl1-mesa-dri); an HTML page needs neither"


def _require_egl() -> None:
    """Without its library VTK ends the process."""
    if sys.platform != "linux":
        return
    try:
        ctypes.CDLL("libEGL.so.1")
    except OSError as cause:
        raise UnsupportedError("pictures are drawn through EGL, which is not here", expected=_NEEDED) from cause


def _solids(
    scene: Scene, things: Sequence[Thing], story: Story | None, view: Projection
) -> Iterable[tuple[Mesh, str, float]]:
    """Meshes in the coordinates of the view: opaque ones of a colour together, and the ghost."""
    opaque: dict[str, list[Mesh]] = {}
    for thing in things:
        if not thing.solid:
            continue
        mesh = _in_view(scene, thing)
        if thing.opacity == 1.0:
            opaque.setdefault(thing.color, []).append(mesh)
        else:
            yield _towards(view, mesh), thing.color, thing.opacity
    for color, meshes in opaque.items():
        for smooth in (False, True):
            same = [mesh for mesh in meshes if mesh.smooth == smooth]
            if same:
                yield joined(same), color, 1.0
    yield from _ghost(scene, things, story, view)


def _towards(view: Projection, mesh: Mesh) -> Mesh:
    """Without the triangles that are seen from behind: VTK sorts four translucent layers, not more."""
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.einsum("ij,ij->i", normals, view.eye - corners[:, 0]) > 0
    return Mesh(mesh.vertices, mesh.triangles[facing], mesh.smooth) if facing.any() else mesh


def _ghost(
    scene: Scene, things: Sequence[Thing], story: Story | None, view: Projection
) -> Iterable[tuple[Mesh, str, float]]:
    if story is None or story.animation is None:
        return
    far = scene.matrix(story.animation.poses[-1])
    for thing in things:
        if thing.path.startswith(story.animation.path + "/") and thing.solid:
            mesh = _in_view(scene, thing)
            moved = mesh.vertices @ far[:3, :3].T + far[:3, 3]
            yield _towards(view, Mesh(moved, mesh.triangles, mesh.smooth)), MOTION, GHOST_OPACITY


def _in_view(scene: Scene, thing: Thing) -> Mesh:
    mesh = triangles_of(thing.shape)
    return Mesh(scene.to_view(mesh.vertices), mesh.triangles, mesh.smooth)


def _instance(name: str, mesh: Mesh, color: str, opacity: float) -> Any:
    from pydrake.common import MemoryFile  # noqa: PLC0415 - as above
    from pydrake.geometry import (  # noqa: PLC0415 - as above
        GeometryInstance,
        InMemoryMesh,
        PerceptionProperties,
        RenderLabel,
        Rgba,
    )
    from pydrake.geometry import Mesh as DrakeMesh  # noqa: PLC0415 - as above
    from pydrake.math import RigidTransform  # noqa: PLC0415 - as above

    content: Any = _obj(mesh).encode()
    memory: Any = InMemoryMesh(mesh_file=MemoryFile(contents=content, extension=".obj", filename_hint=name))
    instance: Any = GeometryInstance(RigidTransform(), DrakeMesh(memory), name)
    properties: Any = PerceptionProperties()
    properties.AddProperty("phong", "diffuse", Rgba(*rgb(color), opacity))
    properties.AddProperty("label", "id", RenderLabel(1))
    instance.set_perception_properties(properties)
    return instance


def _obj(mesh: Mesh) -> str:
    """As OBJ with normals, which VTK asks for."""
    vertices, normals = facet_soup(mesh)
    lines = [f"v {x:.7g} {y:.7g} {z:.7g}" for x, y, z in vertices.tolist()]
    lines += [f"vn {x:.5g} {y:.5g} {z:.5g}" for x, y, z in normals.tolist()]
    lines += [f"f {k}//{k} {k + 1}//{k + 1} {k + 2}//{k + 2}" for k in range(1, len(vertices), 3)]
    return "\n".join(lines) + "\n"


def _engine() -> Any:
    from pydrake.geometry import LightParameter, MakeRenderEngineVtk, RenderEngineVtkParams  # noqa: PLC0415 - as above

    parameters: Any = RenderEngineVtkParams()
    parameters.default_clear_color = np.array(rgb(GROUND))
    # from the camera, and softly from above and below: no side of anything is black
    lights = ((0.72, [0.0, 0.0, 1.0]), (0.3, [-0.5, 1.0, 0.6]), (0.22, [0.6, -0.9, 0.5]))
    parameters.lights = [
        LightParameter(type="directional", frame="camera", intensity=intensity, direction=direction)
        for intensity, direction in lights
    ]
    return MakeRenderEngineVtk(parameters)


def _images(graph: Any, view: Projection) -> tuple[np.ndarray, np.ndarray]:
    from pydrake.geometry import (  # noqa: PLC0415 - as above
        ClippingRange,
        ColorRenderCamera,
        DepthRange,
        DepthRenderCamera,
        RenderCameraCore,
    )
    from pydrake.math import RigidTransform, RotationMatrix  # noqa: PLC0415 - as above
    from pydrake.systems.sensors import CameraInfo  # noqa: PLC0415 - as above

    near, far = view.clipping
    info: Any = CameraInfo(view.width, view.height, view.fov)
    core: Any = RenderCameraCore(_ENGINE, info, ClippingRange(near, far), RigidTransform())
    eye: Any = view.eye
    pose: Any = RigidTransform(RotationMatrix(view.axes.T), eye)
    query: Any = graph.get_query_output_port().Eval(graph.CreateDefaultContext())
    frame = graph.world_frame_id()
    color = query.RenderColorImage(ColorRenderCamera(core, False), frame, pose).data[:, :, :3]
    depth = query.RenderDepthImage(DepthRenderCamera(core, DepthRange(near, far)), frame, pose).data[:, :, 0]
    return np.array(color), np.array(depth)

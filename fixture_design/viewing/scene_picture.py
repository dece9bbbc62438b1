"""The picture: what the renderer drew, with edges, labels, the verdict and the legend on it."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np

from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.drake_picture import render
from fixture_design.viewing.label_places import placed_labels
from fixture_design.viewing.palette import GROUND, MOTION, rgb
from fixture_design.viewing.picture_panel import draw_panel, font
from fixture_design.viewing.projection import Projection
from fixture_design.viewing.scene import Lines, Scene, Story, Thing, scene_of

#: Pixels are rendered this many times finer each way, which smooths edges.
_FINER = 2
#: Part of the picture that the panel takes.
_PANEL = 0.3
#: A picture of usual size, in which letters have theirs; how much smaller and larger they may be.
_USUAL, _SMALLEST, _LARGEST, _LETTERS = (1280, 860), 0.6, 3.0, 14.0
#: Edges: opacity where seen and where hidden, samples a pixel, and how much nearer counts as in front [-].
_SEEN, _HIDDEN, _NEARER = 1.0, 0.22, 4e-3


def picture(layout: Layout, verdict: Verdict, width: int = 1280, height: int = 860) -> bytes:
    """A PNG of a layout with its verdict, as the preview shows it at first.

    Args:
        width, height: in pixels.

    Raises:
        InputError: the part cannot be read.  UnsupportedError: there is no EGL to draw with.
    """
    return scene_picture(scene_of(layout, verdict), width, height)


def scene_picture(scene: Scene, width: int = 1280, height: int = 860, story: int | None = None) -> bytes:
    """A PNG of a scene while one of its stories is told.

    Args:
        story: index into the scene's stories; by default the first one to tell.

    Raises:
        UnsupportedError: there is no EGL to draw with.
    """
    from PIL import Image, ImageDraw  # noqa: PLC0415 - only where a picture is made

    number = scene.first if story is None else story
    told = None if number is None else scene.stories[number]
    panel, scale = int(_PANEL * width), _scale(width, height)
    image = Image.new("RGB", (width, height), GROUND)
    image.paste(_drawing(scene, told, width - panel, height, scale), (0, 0))
    draw_panel(ImageDraw.Draw(image), scene, told, (width - panel, 0, width, height), scale)
    file = BytesIO()
    image.save(file, "PNG", optimize=True)
    return file.getvalue()


def _scale(width: int, height: int) -> float:
    """Of letters: as the picture, within what can be read."""
    return float(np.clip(min(width / _USUAL[0], height / _USUAL[1]), _SMALLEST, _LARGEST))


def _drawing(scene: Scene, story: Story | None, width: int, height: int, scale: float) -> Any:
    from PIL import Image, ImageDraw  # noqa: PLC0415 - as above

    things, labels = scene.told(story)
    camera = scene.camera if story is None or story.camera is None else story.camera
    fine = Projection.of(scene, camera, width * _FINER, height * _FINER)
    colors, depths = render(scene, things, story, fine)
    image = Image.fromarray(_with_edges(colors, depths, scene, things, story, fine)).resize(
        (width, height), Image.Resampling.LANCZOS
    )
    view, letters, draw = Projection.of(scene, camera, width, height), font(_LETTERS * scale), ImageDraw.Draw(image)
    sizes = [letters.getbbox(label.text)[2:] for label in labels]
    anchors = view.pixels(scene.to_view(np.array([label.point for label in labels]).reshape(-1, 3)))[0]
    places = placed_labels(anchors, np.array(sizes, dtype=np.float64).reshape(-1, 2), width, height)
    for label, anchor, place in zip(labels, anchors, places, strict=True):
        if place.led:
            draw.line([tuple(anchor), place.nearest(anchor)], fill="#777777", width=1)
        draw.text(
            (place.left, place.top), label.text, font=letters, fill=label.color, stroke_width=2, stroke_fill=GROUND
        )
    return image


def _with_edges(
    colors: np.ndarray,
    depths: np.ndarray,
    scene: Scene,
    things: tuple[Thing, ...],
    story: Story | None,
    view: Projection,
) -> np.ndarray:
    """Thin lines over the picture: dark where nothing is in front of them, faint where something is."""
    shades = colors.astype(np.float64)
    for thing in things:
        if isinstance(thing.shape, Lines):
            ends = scene.to_view(thing.shape.segments.reshape(-1, 3))
            _draw_lines(shades, depths, ends, thing.color, view)
            if story is not None and story.animation is not None and thing.path.startswith(story.animation.path + "/"):
                far = scene.matrix(story.animation.poses[-1])
                _draw_lines(shades, depths, ends @ far[:3, :3].T + far[:3, 3], MOTION, view)
    return np.clip(np.round(shades), 0, 255).astype(np.uint8)


def _draw_lines(shades: np.ndarray, depths: np.ndarray, ends: np.ndarray, color: str, view: Projection) -> None:
    pixels = view.pixels(ends)[0].reshape(-1, 2, 2)
    ends = ends.reshape(-1, 2, 3)
    counts = np.clip(np.ceil(np.linalg.norm(pixels[:, 1] - pixels[:, 0], axis=1) * 1.5), 2, 8000).astype(np.int64)
    owner = np.repeat(np.arange(len(ends)), counts)
    place = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)) / (counts[owner] - 1)
    points = ends[owner, 0] + place[:, None] * (ends[owner, 1] - ends[owner, 0])
    at, depth = view.pixels(points)
    column, row = np.round(at).astype(np.int64).T
    inside = (column >= 0) & (row >= 0) & (column < view.width - 1) & (row < view.height - 1)
    column, row, depth = column[inside], row[inside], depth[inside]
    alpha = np.where(depth <= depths[row, column] * (1 + _NEARER), _SEEN, _HIDDEN)
    ink = np.zeros(shades.shape[:2])
    for x, y in ((0, 0), (1, 0), (0, 1)):
        np.maximum.at(ink, (row + y, column + x), alpha)
    shades += ink[..., None] * (np.array(rgb(color)) * 255 - shades)

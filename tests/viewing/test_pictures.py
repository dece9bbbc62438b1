"""Pictures against kept ones, by what an eye sees: blurred, so that renderers may round edges as they like.

`python -m tests.viewing.test_pictures` draws the kept ones anew, after looking at what changed.
"""

from __future__ import annotations

import ctypes
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from fixture_design import read_layout, verify
from fixture_design.errors import UnsupportedError
from fixture_design.viewing.scene import Scene, scene_of
from fixture_design.viewing.scene_picture import scene_picture
from tests.viewing.test_scene import BRACKET, URDF, looked_at

HERE = Path(__file__).parent / "references"
#: Name of the kept picture, layout, group and claim whose story it tells.
KEPT = [
    ("bracket_held", BRACKET, "all", "form_closure"),
    ("bracket_free", BRACKET, "locators", "form_closure"),
    ("figure8", URDF / "figure8" / "polygon_p12345.layout.yaml", "all", "form_closure"),
]
SIZE = (600, 400)
#: Shades that kept pictures are rounded to [of 255], which makes the files small.
ROUNDED = 8

#: Pixels that are averaged each way, and the largest mean and largest single difference after that, of 255. Another
#: version of the renderer moves edges by a pixel and shades by a few parts; an element that is missing makes 100.
BLUR, MEAN, MOST = 8, 1.5, 40.0


def drawn(scene: Scene, group: str, claim: str) -> bytes:
    story = next(k for k, story in enumerate(scene.stories) if (story.group, story.claim) == (group, claim))
    try:
        return scene_picture(scene, *SIZE, story=story)
    except UnsupportedError as missing:
        pytest.skip(str(missing))


def blurred(png: bytes) -> np.ndarray:
    from PIL import Image

    pixels = np.asarray(Image.open(BytesIO(png)).convert("RGB"), dtype=np.float64)
    height, width = (side // BLUR for side in pixels.shape[:2])
    return pixels[: height * BLUR, : width * BLUR].reshape(height, BLUR, width, BLUR, 3).mean(axis=(1, 3))


def difference(first: bytes, second: bytes) -> tuple[float, float]:
    """Mean and largest difference of two pictures, blurred."""
    off = np.abs(blurred(first) - blurred(second))
    return float(off.mean()), float(off.max())


@pytest.mark.parametrize(("name", "path", "group", "claim"), KEPT, ids=[kept[0] for kept in KEPT])
def test_pictures_look_as_the_kept_ones(name: str, path: Path, group: str, claim: str) -> None:
    kept = (HERE / f"{name}.png").read_bytes()
    assert len(kept) < 60_000
    mean, most = difference(drawn(looked_at(path)[2], group, claim), kept)
    assert mean < MEAN
    assert most < MOST


def test_a_missing_element_is_noticed() -> None:
    from dataclasses import replace

    scene = looked_at(BRACKET)[2]
    without = replace(scene, things=tuple(t for t in scene.things if not t.path.startswith("elements/clamp/8")))
    _, most = difference(drawn(without, "all", "form_closure"), drawn(scene, "all", "form_closure"))
    assert most > 1.5 * MOST


def test_the_colours_are_those_of_the_legend() -> None:
    from PIL import Image

    from fixture_design.viewing.palette import ROLE_COLORS, rgb

    png = drawn(looked_at(BRACKET)[2], "all", "form_closure")
    pixels = np.asarray(Image.open(BytesIO(png)).convert("RGB"), dtype=np.float64)[:, : SIZE[0] - 220]
    for role in ("locator", "clamp"):
        color = np.array(rgb(ROLE_COLORS[role]))
        shades = pixels / 255 / max(color)
        hue = np.abs(shades / np.maximum(shades.max(axis=2, keepdims=True), 1e-9) - color / color.max()).max(axis=2)
        assert (hue < 0.06).sum() > 200, role


def test_without_egl_one_message_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise OSError(f"{name}: cannot open shared object file")

    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(ctypes, "CDLL", missing)
    with pytest.raises(UnsupportedError, match="EGL"):
        scene_picture(looked_at(BRACKET)[2], *SIZE)


if __name__ == "__main__":
    from PIL import Image

    HERE.mkdir(exist_ok=True)
    for kept_name, layout_path, of_group, of_claim in KEPT:
        layout = read_layout(layout_path)
        png = drawn(scene_of(layout, verify(layout)), of_group, of_claim)
        shades = np.asarray(Image.open(BytesIO(png)).convert("RGB"), dtype=np.int64)
        rounded = np.clip((shades + ROUNDED // 2) // ROUNDED * ROUNDED, 0, 255).astype(np.uint8)
        Image.fromarray(rounded).save(HERE / f"{kept_name}.png", optimize=True)

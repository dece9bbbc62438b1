"""The preview: one HTML file with the scene, its stories and the verdict, that loads nothing from anywhere.

The page brings the viewer of the meshcat package along and forbids the browser any connection
(Content-Security-Policy).
"""

from __future__ import annotations

import json
from base64 import b64encode
from importlib.resources import files
from itertools import groupby

import numpy as np

from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.legend import legend_mark, story_rows
from fixture_design.viewing.markup import Markup, bullets, joined, tag
from fixture_design.viewing.meshcat_commands import commands, tracks
from fixture_design.viewing.page_files import page_file
from fixture_design.viewing.palette import ANSWER_SIGNS, answer_sign
from fixture_design.viewing.scene import Camera, Label, Scene, Story, scene_of
from fixture_design.viewing.scene.camera import ASPECT
from fixture_design.viewing.summary import SUMMARY

_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "base-uri 'none'; form-action 'none'"
)


def preview_page(layout: Layout, verdict: Verdict) -> str:
    """The page of a layout.

    Args:
        verdict: of ``layout``, as `verify` gave it.

    Raises:
        InputError: the part or a body cannot be read.
    """
    return scene_page(scene_of(layout, verdict), planar=layout.space == "planar")


def scene_page(scene: Scene, planar: bool = False) -> str:
    """The page of a scene; everything that comes from files is escaped or data."""
    head = tag(
        "head", Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'),
        Markup('<meta name="viewport" content="width=device-width">'),
        tag("title", f"{scene.name}: fixture preview"), tag("style", Markup(page_file("page.css"))),
    )  # fmt: skip
    data = tag("script", Markup(_json(_data(scene, planar))), type="application/json", id="scene")
    scripts = joined([tag("script", Markup(_viewer())), data, tag("script", Markup(page_file("page.js")))])
    view = tag(
        "div", tag("div", id="meshcat-pane"), tag("canvas", id="names"),
        tag("div", "This browser cannot draw in three dimensions (WebGL).", id="trouble"), id="view",
    )  # fmt: skip
    return "<!DOCTYPE html>\n" + tag("html", head, tag("body", view, _panel(scene), scripts), lang="en") + "\n"


def _viewer() -> str:
    """The meshcat package's viewer with its licences."""
    folder = files("meshcat").joinpath("viewer", "dist")
    licences = folder.joinpath("main.min.js.LICENSE.txt").read_text(encoding="utf-8").replace("*/", "* /")
    script = folder.joinpath("main.min.js").read_text(encoding="utf-8")
    return f"/* meshcat, MIT licence, with\n{licences}*/\n{script}"


def _json(value: object) -> str:
    """JSON that cannot end its script element."""
    return json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _data(scene: Scene, planar: bool) -> dict[str, object]:
    import umsgpack  # noqa: PLC0415 - comes with meshcat

    told = tuple(thing for story in scene.stories for thing in story.things)
    packed = [umsgpack.packb(command.lower()) for command in commands(scene, (*scene.things, *told))]
    return {
        "commands": [b64encode(each).decode() for each in packed],
        "paths": [thing.path for thing in scene.things],
        "labels": [_label(scene, label) for label in scene.labels],
        "layers": [{"path": layer.path, "number": number} for number, layer in enumerate(scene.layers)],
        "stories": [_story(scene, story) for story in scene.stories],
        "camera": _camera(scene, scene.camera),
        "aspect": ASPECT,
        "first": scene.first,
        "planar": planar,
    }


def _label(scene: Scene, label: Label) -> dict[str, object]:
    point = np.round(scene.to_view(label.point[None])[0], 5).tolist()
    return {"path": label.path, "text": label.text, "point": point, "color": label.color}


def _camera(scene: Scene, camera: Camera) -> dict[str, object]:
    eye, target = np.round(scene.to_view(np.array([camera.eye, camera.target])), 6).tolist()
    return {"eye": eye, "target": target}


def _story(scene: Scene, story: Story) -> dict[str, object]:
    moving = story.animation
    return {
        "path": story.path,
        "camera": _camera(scene, story.camera or scene.camera),
        "drawn": bool(story.things),
        "without": list(story.without),
        "labels": [_label(scene, label) for label in story.labels],
        "animation": None if moving is None else {"path": moving.path, "tracks": tracks(scene, moving)},
    }


def _panel(scene: Scene) -> Markup:
    """Name, verdict, an answer a line, the legend."""
    word = str(scene.satisfied or "none")
    said = scene.summary or f"{ANSWER_SIGNS[scene.satisfied]} {SUMMARY[scene.satisfied]}"
    summary = tag("p", said, class_=f"summary {word}")
    buttons = (("overview", "everything"), ("motion", "stop or move"), ("home", "view as at first"))
    tools = tag("div", *(tag("button", text, id=name, type="button") for name, text in buttons), class_="tools")
    choose = "an answer to see what shows it" if scene.summary is None else "what to see"
    hint = tag("p", f"Choose {choose}. Drag to turn, wheel to come nearer.", class_="hint")
    groups = [
        _group(name, list(members))
        for name, members in groupby(enumerate(scene.stories), key=lambda pair: pair[1].group)
    ]
    notes = tag("div", tag("h2", "notes"), bullets(scene.notes), class_="notes") if scene.notes else Markup("")
    return tag("div", tag("h1", scene.name), summary, tools, hint, *groups, _legend(scene), notes, id="panel")


def _group(name: str, members: list[tuple[int, Story]]) -> Markup:
    return joined([tag("h2", name), *(_answer(number, story) for number, story in members)])


def _answer(number: int, story: Story) -> Markup:
    word = str(story.answer or "none") if story.required else "none"
    said = story.said or ("no contacts" if story.answer is None else str(story.answer))
    asked = " (required)" if story.required else ""
    words = tag("span", f"{story.claim.replace('_', ' ')}: {said}{asked}", class_="claim")
    details = [tag("small", text) for text in (story.words, story.caption) if text]
    sign = tag("b", answer_sign(story.answer, story.required), class_=word) if story.said is None else ""
    return tag(
        "button", sign, words, *details,
        class_="answer", type="button", data_story=number, aria_pressed="false", title=story.words,
    )  # fmt: skip


def _legend(scene: Scene) -> Markup:
    """Every layer with its mark, to be switched off; what the arrows of stories are."""
    rows = [
        tag("label", _checkbox(f"layer-{number}", not layer.hidden), legend_mark(layer.mark, layer.color), layer.text)
        for number, layer in enumerate(scene.layers)
    ]
    said = story_rows(scene.stories)
    rows += [tag("label", tag("span", style="width: 13px"), legend_mark(*row[:2]), row[2]) for row in said]
    return tag("div", *rows, class_="legend")


def _checkbox(name: str, checked: bool) -> Markup:
    return Markup(f'<input type="checkbox" id="{name}"{" checked" if checked else ""}>')

"""Previews as files: one page, small, that loads nothing and says what files say as words only."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from html import unescape
from pathlib import Path
from types import SimpleNamespace

import pytest
import umsgpack

import fixture_design as fd
from fixture_design import Contact, Layout
from fixture_design.errors import FileFormatError, InputError
from fixture_design.layout import Part, Pose
from fixture_design.viewing import preview_page
from fixture_design.viewing.meshcat_commands import draw
from fixture_design.viewing.scene import scene_of
from tests.geometry.parts import shared
from tests.viewing.test_scene import BRACKET, URDF, looked_at

PLANAR = URDF / "figure8" / "polygon_p12345.layout.yaml"
HOSTILE = "</script><script>window.stolen = 1</script><img src=x onerror=alert(1)>"
#: The largest page [bytes].
MOST = 3_000_000


def data_of(page: str) -> dict:
    """What the page's script reads."""
    found = re.search(r'<script type="application/json" id="scene">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def hostile() -> Layout:
    layout = fd.read_layout(BRACKET)
    first = replace(layout.elements[0], name=HOSTILE)
    features = (replace(layout.key_features[0], name=HOSTILE), *layout.key_features[1:])
    return replace(layout, name=HOSTILE, elements=(first, *layout.elements[1:]), key_features=features)


def test_words_from_files_stay_words() -> None:
    layout = hostile()
    page = preview_page(layout, fd.verify(layout))
    assert "<script>window" not in page
    assert "<img" not in page
    assert page.count("<script") == 3
    assert HOSTILE in [label["text"] for label in data_of(page)["labels"]]
    assert HOSTILE in unescape(page)


def test_the_page_forbids_every_connection() -> None:
    page = preview_page(*looked_at(BRACKET)[:2])
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert policy is not None
    assert policy[1].startswith("default-src 'none';")
    assert "http" not in policy[1]
    assert not re.search(r'(src|href)="(?!data:)', page)
    assert len(page.encode()) < MOST


def test_every_answer_is_on_the_page() -> None:
    _, verdict, scene = looked_at(BRACKET)
    page = preview_page(*looked_at(BRACKET)[:2])
    assert page.count("data-story=") == len(scene.stories)
    assert "all requirements hold" in page
    for group in verdict.groups.values():
        assert f"<h2>{group.name}</h2>" in page


def test_the_page_draws_the_things_of_the_scene() -> None:
    _, _, scene = looked_at(BRACKET)
    commands = [
        umsgpack.unpackb(b64decode(each)) for each in data_of(preview_page(*looked_at(BRACKET)[:2]))["commands"]
    ]
    drawn = {each["path"] for each in commands if each["type"] == "set_object"}
    wanted = [*scene.things, *(thing for story in scene.stories for thing in story.things)]
    assert {f"/scene/{thing.path}" for thing in wanted} <= {
        "/" + path.strip("/").removeprefix("meshcat/") for path in drawn
    }


def test_twenty_thousand_triangles_are_less_than_three_megabytes(tmp_path: Path) -> None:
    import trimesh

    trimesh.creation.icosphere(subdivisions=5, radius=0.05).export(tmp_path / "ball.stl")
    part = Part("ball", "mesh", tmp_path / "ball.stl", None, 1.0, Pose.identity(3))
    ends = [(x, y, z) for x, y, z in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    contacts = [Contact.on_facet(f"C{k}", "locator", [0.05 * v for v in n], n, 0.2) for k, n in enumerate(ends)]
    layout = Layout("ball", part=part, contacts=tuple(contacts))
    page = preview_page(layout, fd.verify(layout))
    assert 1_000_000 < len(page.encode()) < MOST


@pytest.mark.slow
def test_a_real_part_of_many_triangles() -> None:
    shared("airo-models/airo_models/grippers/fingertips/originals/robotiq_adapter.stl")
    layout = fd.read_layout(Path(__file__).parents[1] / "layouts" / "robotiq_adapter.layout.yaml")
    assert len(preview_page(layout, fd.verify(layout)).encode()) < MOST


def test_a_preview_begins_with_the_answer_that_is_asked_for() -> None:
    shown = fd.preview(BRACKET, show="locators:form_closure")
    first = data_of(shown.html)["first"]
    story = looked_at(BRACKET)[2].stories[first]
    assert (story.group, story.claim) == ("locators", "form_closure")


def test_a_preview_is_saved_and_shown_in_notebooks(tmp_path: Path) -> None:
    shown = fd.preview(PLANAR)
    shown.save(tmp_path / "out.html")
    assert (tmp_path / "out.html").read_text() == shown.html
    frame = shown._repr_html_()
    inside = re.search(r'srcdoc="([^"]*)"', frame)
    assert inside is not None
    assert data_of(unescape(inside[1])) == data_of(shown.html)


@pytest.mark.parametrize("name", ["bracket.obj", "bracket.urdf", "bracket.layout.yaml"])
def test_inputs_are_not_overwritten(tmp_path: Path, name: str) -> None:
    for file in ("bracket.obj", "bracket.urdf", "bracket.layout.yaml"):
        (tmp_path / file).write_bytes((BRACKET.parent / file).read_bytes())
    before = (tmp_path / name).read_bytes()
    with pytest.raises(FileFormatError, match="input"):
        fd.preview(tmp_path / "bracket.layout.yaml").save(tmp_path / name)
    assert (tmp_path / name).read_bytes() == before


@cache
def graph() -> fd.ContactStateGraph:
    return fd.state_graph(fd.read_assembly(URDF / "figure14" / "peg_in_hole.assembly.yaml"), samples=1)


def test_graphs_have_a_page_with_every_state(tmp_path: Path) -> None:
    found = graph()
    fd.write_graph(found, tmp_path / "graph.json")
    page = fd.preview(tmp_path / "graph.json").html
    assert "<script" not in page
    for state in found.states:
        assert f"<td>{state.id}</td>" in page
    assert fd.preview(found).picture().startswith(b"\x89PNG")


def test_a_design_without_a_layout_has_no_preview() -> None:
    with pytest.raises(InputError, match="slippery"):
        fd.preview(fd.DesignResult(fd.verify(fd.read_layout(PLANAR)).satisfied, None, reason="slippery"))  # type: ignore[arg-type]


def test_a_running_viewer_gets_the_same_commands() -> None:
    _, _, scene = looked_at(BRACKET)
    sent: list[dict] = []
    window = SimpleNamespace(send=lambda command: sent.append(command.lower()))
    draw(scene, SimpleNamespace(window=window))  # type: ignore[arg-type]
    assert scene.first is not None
    things = scene.told(scene.stories[scene.first])[0]
    assert len([each for each in sent if each["type"] == "set_object"]) == len(things) + 1  # and the camera


def test_drakes_viewer_draws_the_scene_on_this_machine_only() -> None:
    from fixture_design.viewing.drake_meshcat import draw as draw_live
    from fixture_design.viewing.drake_meshcat import started

    layout, _, scene = looked_at(BRACKET)
    meshcat = started()
    assert meshcat.web_url().startswith("http://localhost:")
    story = next(story for story in scene.stories if story.animation is not None)
    drawn = draw_live(meshcat, scene, story)
    for thing in scene.told(story)[0]:
        assert meshcat.HasPath(f"scene/{thing.path}")
    moved = replace(layout, elements=layout.elements[:-1], stages=())
    draw_live(meshcat, scene_of(moved, fd.verify(moved)), before=drawn)
    assert not meshcat.HasPath("scene/elements/clamp/8")
    assert meshcat.HasPath("scene/elements/clamp/7")


def test_preview_on_the_command_line(command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = command("preview", PLANAR, "-o", tmp_path / "out.html")
    assert (ran.code, ran.err) == (0, "")
    assert data_of((tmp_path / "out.html").read_text())["planar"] is True
    monkeypatch.chdir(tmp_path)
    assert command("preview", PLANAR).out == "polygon_p12345.html\n"
    assert (tmp_path / "polygon_p12345.html").is_file()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["preview", "missing.yaml"], "missing.yaml"),
        (["preview", PLANAR, "--png", "picture.gif"], "PNG"),
        (["preview", PLANAR, "--show", "all:nothing"], "all:form_closure"),
        (["preview", PLANAR, "-o", "no/such/folder.html"], "no/such/folder.html"),
        (["verify", PLANAR, BRACKET, "--html", "x.html"], "one layout"),
        (["verify", PLANAR, "--html", PLANAR], "input"),
    ],
)
def test_bad_input_is_one_message(
    command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = command(*arguments)
    assert ran.code == 2
    assert said in ran.err
    assert ran.err.count("\n") == 1


def test_verify_writes_the_preview_of_its_verdict(command: Callable, tmp_path: Path) -> None:
    free = URDF / "figure8" / "p1234.layout.yaml"
    ran = command("verify", free, "--html", tmp_path / "out.html")
    assert ran.code == 0
    assert "can move: along [1, 0]" in unescape((tmp_path / "out.html").read_text())

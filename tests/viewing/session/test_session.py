"""The session as a value and how it is steered: no browser, no Drake's Meshcat."""

from __future__ import annotations

import threading
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fixture_design as fd
from fixture_design.design.next_element import next_element
from fixture_design.errors import FileFormatError, InputError, UnknownNameError, UnsupportedError
from fixture_design.layout import Answer, Element, Layout, LineTip, PadTip, PinTip, PointTip, SphereTip, Stage, Verdict
from fixture_design.viewing.session import Session, Steering, begun
from fixture_design.viewing.session import session as steps
from fixture_design.viewing.session.files import free_names, recover, stem_of, target_of, written_anew
from fixture_design.viewing.session.lines import answer_lines, harmless
from fixture_design.viewing.session.panel import ELEMENT, Panel, Reading, U
from fixture_design.viewing.session.sliding import axes, slid
from fixture_design.viewing.session.tips import round_size

URDF = Path(__file__).resolve().parents[3] / "urdf"
BRACKET = URDF / "bracket" / "bracket.layout.yaml"
POLYGON = URDF / "figure8" / "polygon_p12345.layout.yaml"


@pytest.fixture
def bracket(tmp_path: Path) -> Steering:
    return begun(Steering, BRACKET, out=tmp_path / "b.yaml")


@pytest.fixture
def polygon(tmp_path: Path) -> Steering:
    return begun(Steering, POLYGON, out=tmp_path / "p.yaml")


def said(verdict: Verdict) -> dict[tuple[str, str], tuple[object, object]]:
    """Every answer with its margin."""
    return {
        (group.name, claim): (finding.answer, finding.margin)
        for group in verdict.groups.values()
        for claim, finding in group.findings.items()
    }


def at(layout: Layout, name: str) -> np.ndarray:
    return next(element.at for element in layout.elements if element.name == name)


def test_undo_and_redo_are_inverse(polygon: Steering) -> None:
    first = polygon.layout
    polygon.slide(0.1)
    polygon.remove()
    last = polygon.layout
    assert len(last.elements) == len(first.elements) - 1
    polygon.undo()
    polygon.undo()
    assert polygon.layout is first
    assert not polygon.session.unsaved
    polygon.undo()
    assert polygon.layout is first
    polygon.redo()
    polygon.redo()
    assert polygon.layout is last
    assert polygon.session.unsaved


def test_a_step_after_undo_forgets_what_was_undone(polygon: Steering) -> None:
    polygon.slide(0.1)
    polygon.undo()
    polygon.next_role()
    assert not polygon.session.after
    assert len(polygon.session.before) == 1


def test_a_slide_is_one_step_however_far_it_goes(polygon: Steering) -> None:
    for k in range(1, 6):
        polygon.slide(0.1 * k)
    assert len(polygon.session.before) == 1
    polygon.slide(0.0)
    assert at(polygon.layout, "P1") == pytest.approx(at(polygon.session.before[0], "P1"))


@cache
def flat() -> Steering:
    return begun(Steering, POLYGON)


@given(st.floats(-20, 20))
@settings(max_examples=60)
def test_on_a_polygon_it_stays_on_the_boundary(u: float) -> None:
    work = flat().work
    element = Element("E", "locator", np.array([3.0, 0.0]))
    moved = slid(element, work.ground, u, 0.0)
    distance, _ = work.geometry.nearest(work.part.pose.inverse().points(moved.at[None])[0])  # type: ignore[union-attr]
    assert abs(distance) < 1e-12
    around = float(np.linalg.norm(work.geometry.edges, axis=1).sum())  # type: ignore[union-attr]
    assert slid(element, work.ground, u + around, 0.0).at == pytest.approx(moved.at, abs=1e-9)


def test_u_goes_counter_clockwise_by_its_length() -> None:
    work = begun(Steering, POLYGON).work
    moved = slid(Element("E", "locator", np.array([3.0, -0.5])), work.ground, 0.25, 0.0)
    assert moved.at == pytest.approx([3.0, -0.25])


@pytest.fixture(scope="module")
def solid() -> Steering:
    return begun(Steering, BRACKET)


@given(st.sampled_from([f"L{k}" for k in range(1, 7)]), st.floats(-0.06, 0.06), st.floats(-0.06, 0.06))
@settings(max_examples=40)
def test_on_a_solid_it_stays_on_the_surface_and_comes_back(solid: Steering, name: str, u: float, v: float) -> None:
    element = next(e for e in solid.layout.elements if e.name == name)
    moved = slid(element, solid.work.ground, u, v)
    p_P = solid.work.part.pose.inverse().points(moved.at[None])[0]
    assert abs(solid.work.geometry.surface.at(p_P)[0]) < 1e-9  # type: ignore[union-attr]


def test_on_a_face_it_moves_along_the_axes_that_are_shown(solid: Steering) -> None:
    element = solid.layout.elements[0]
    first, second = axes(solid.work.ground, element.at)
    assert abs(first @ second) < 1e-12
    moved = slid(element, solid.work.ground, 1e-3, -5e-4)
    assert moved.at - element.at == pytest.approx(1e-3 * first - 5e-4 * second, abs=1e-12)


def test_a_pad_is_turned_over_an_edge(solid: Steering) -> None:
    """From the base of the bracket over an edge: its direction lies in the new facet, and keeps its length."""
    start = solid.layout.elements[0].at
    pad = Element("P", "locator", start, PadTip(1e-3, 1e-3, axes(solid.work.ground, start)[0]))
    before = solid.work.verify(replace(solid.layout, elements=(pad,), stages=(), require={})).contacts[0].normals[0]
    for u in np.linspace(0.0, 0.15, 40):
        moved = slid(pad, solid.work.ground, float(u), 0.0)
        first, second = axes(solid.work.ground, moved.at)
        normal = np.cross(first, second)
        if abs(normal @ before) < 0.1 * np.linalg.norm(before):
            break
    else:
        pytest.fail("it never came over an edge")
    assert isinstance(moved.tip, PadTip)
    assert abs(moved.tip.along @ normal) < 1e-9
    assert np.linalg.norm(moved.tip.along) == pytest.approx(1.0)


def test_pins_stay(solid: Steering) -> None:
    pin = Element("P", "locator", np.zeros(3), PinTip(0.008, 1e-5, "round"), axis=np.array([0.0, 0.0, 1.0]))
    with pytest.raises(UnsupportedError, match="hole"):
        slid(pin, solid.work.ground, 1e-3, 0.0)


def test_what_is_live_is_what_verify_says(bracket: Steering, tmp_path: Path) -> None:
    bracket.slide(1e-3, -1e-3)
    bracket.choose(8)
    bracket.slide(-1e-3)
    bracket.remove()
    bracket.undo()
    bracket.save()
    verdict = fd.verify(fd.read_layout(tmp_path / "b.yaml"))
    assert said(bracket.verdict) == said(verdict)
    assert answer_lines(bracket.verdict) == answer_lines(verdict)
    assert bracket.verdict.notes == verdict.notes


def test_what_geometry_refuses_is_not_done(bracket: Steering) -> None:
    before, verdict = bracket.session, bracket.verdict
    bracket.slide(float("nan"))
    assert "length" in bracket.message
    assert bracket.session is before
    off = replace(bracket.layout.elements[0], at=np.array([0.054, 0.006, -1e-3]))
    bracket._try(lambda session: steps.put(session, steps.with_element(session.layout, off)))
    assert "1 mm off the surface" in bracket.message
    assert bracket.session is before
    assert bracket.verdict is verdict


def test_an_element_that_a_stage_names_is_not_removed(polygon: Steering) -> None:
    stage = Stage("first", ("P1",))
    polygon._try(lambda session: steps.put(session, replace(session.layout, stages=(stage,))))
    before = polygon.layout
    polygon.remove()
    assert "no role, element or contact is called 'P1'" in polygon.message
    assert polygon.layout is before


def test_only_clamps_have_a_preload(bracket: Steering) -> None:
    number = next(k for k, e in enumerate(bracket.layout.elements, 1) if e.preload is not None)
    bracket.choose(number)
    bracket.next_role()
    element = bracket.session.element
    assert element is not None
    assert element.role == "finger"
    assert (element.preload, element.limits) == (None, None)


def test_tips_go_round(polygon: Steering) -> None:
    polygon.choose(2)
    polygon.slide(0.05)
    kinds = []
    for _ in range(3):
        polygon.next_tip()
        assert polygon.session.element is not None
        kinds.append(type(polygon.session.element.tip))
    assert set(kinds) == {SphereTip, LineTip, PointTip}


def test_removed_elements_leave_their_neighbour_chosen(polygon: Steering) -> None:
    count = len(polygon.layout.elements)
    polygon.choose(count)
    polygon.remove()
    assert polygon.session.chosen == polygon.layout.elements[-1].name
    for _ in range(count):
        polygon.remove()
    assert polygon.session.chosen is None
    assert not polygon.layout.elements
    assert {answer for answer, _ in said(polygon.verdict).values()} == {None}
    with pytest.raises(UnknownNameError):
        steps.chosen(polygon.session, "P1")


def test_from_a_bare_part_to_a_layout_that_holds() -> None:
    steering = begun(Steering, URDF / "bracket" / "bracket.urdf")
    assert steering.verdict.satisfied is not Answer.YES
    for _ in range(6):
        steering.add()
        assert "unnoticed before it" in steering.message
    assert [element.role for element in steering.layout.elements] == ["locator"] * 6
    found = steering.verdict.groups["locators"].findings
    assert found["deterministic"].answer is Answer.YES
    assert found["strongly_accessible"].answer is Answer.YES
    for _ in range(4):
        if steering.verdict.groups["all"].findings["form_closure"].answer is Answer.YES:
            break
        steering.add()
    assert steering.verdict.groups["all"].findings["form_closure"].answer is Answer.YES
    margin = steering.verdict.groups["all"].findings["form_closure"].margin
    steering.add()
    assert "margin is largest" in steering.message
    assert steering.verdict.groups["all"].findings["form_closure"].margin >= margin  # type: ignore[operator]


def test_what_is_added_stops_a_free_motion(polygon: Steering) -> None:
    for _ in range(2):
        polygon.remove()
    best = next_element(polygon.layout, polygon.work)
    assert best.motion is not None
    after = steps.added(polygon.session, best.name, best.role, best.at).layout
    (contact,) = [c for c in polygon.work.contacts(after) if c.name == best.name]
    normal = contact.normals[0]
    row = np.array([*normal, contact.point[0] * normal[1] - contact.point[1] * normal[0]])
    assert abs(row @ best.motion) > 1e-6
    assert best.name not in {element.name for element in polygon.layout.elements}


def test_make_valid_is_the_fewest_changes_and_one_step(polygon: Steering) -> None:
    layout = polygon.layout
    polygon.remove()
    polygon.remove()
    polygon.remove()
    broken = polygon.layout
    assert polygon.verdict.satisfied is not Answer.YES or not polygon.verdict.requirements
    polygon.make_valid()
    polygon.add()
    assert "cancel" in polygon.message or not polygon.busy
    polygon.wait()
    assert polygon.layout is not broken, polygon.message
    polygon.undo()
    assert polygon.layout is broken
    assert layout is polygon.session.before[0]


def test_cancel_changes_nothing(bracket: Steering) -> None:
    bracket.remove()
    before = bracket.layout
    bracket.make_valid()
    bracket.cancel()
    bracket.wait()
    assert bracket.layout is before
    assert "cancelled" in bracket.message


def test_save_and_copies(bracket: Steering, tmp_path: Path) -> None:
    bracket.remove()
    assert bracket.session.unsaved
    bracket.save()
    assert not bracket.session.unsaved
    assert bracket.leave() is None
    first = (tmp_path / "b.yaml").read_bytes()
    bracket.remove()
    bracket.save_copy()
    assert bracket.target == tmp_path / "b.edited.yaml"
    assert (tmp_path / "b.yaml").read_bytes() == first
    assert len(fd.read_layout(bracket.target).elements) == len(bracket.layout.elements)


def test_two_sessions_of_one_layout_do_not_overwrite_each_other(tmp_path: Path) -> None:
    source = tmp_path / "p.layout.yaml"
    fd.write_layout(fd.read_layout(POLYGON), source)
    first, second = begun(Steering, source), begun(Steering, source)
    assert first.target == second.target == tmp_path / "p.edited.yaml"
    first.remove()
    first.save()
    written = first.target.read_bytes()
    second.slide(0.1)
    second.save()
    assert "changed on disk" in second.message
    assert "save a copy" in second.message
    assert second.session.unsaved
    assert first.target.read_bytes() == written
    second.save_copy()
    assert second.target == tmp_path / "p.edited-2.yaml"
    assert not second.session.unsaved
    first.undo()
    first.save()
    assert len(fd.read_layout(first.target).elements) == 5
    assert len(fd.read_layout(second.target).elements) == 5


def test_a_layout_edited_meanwhile_is_not_overwritten(tmp_path: Path) -> None:
    source = tmp_path / "p.layout.yaml"
    fd.write_layout(fd.read_layout(POLYGON), source)
    session = begun(Steering, source, out=source)
    session.remove()
    session.save()
    assert not session.session.unsaved
    source.write_text(source.read_text() + "# by hand\n")
    session.undo()
    session.save()
    assert "changed on disk" in session.message
    assert source.read_text().endswith("# by hand\n")
    source.unlink()
    session.save()
    assert "changed on disk" in session.message
    assert session.session.unsaved


def test_a_name_that_somebody_takes_meanwhile_is_left_to_them(bracket: Steering, tmp_path: Path) -> None:
    names = [tmp_path / "x.yaml", tmp_path / "y.yaml"]
    names[0].write_text("theirs")
    assert written_anew(bracket.layout, iter(names)) == names[1]
    assert names[0].read_text() == "theirs"
    names[0].unlink()
    names[0].symlink_to(tmp_path / "z.yaml")
    names[1].unlink()
    assert written_anew(bracket.layout, iter(names)) == names[1]
    assert not (tmp_path / "z.yaml").exists()


def test_looking_for_a_place_is_said_and_impatient_clicks_are_one(
    bracket: Steering, monkeypatch: pytest.MonkeyPatch
) -> None:
    go, real = threading.Event(), next_element

    def slow(*given: object) -> object:
        assert go.wait(30)
        return real(*given)  # type: ignore[arg-type]

    monkeypatch.setattr("fixture_design.viewing.session.steering.next_element", slow)
    before = bracket.layout
    add = bracket.actions["add at the best place"]
    add()
    assert bracket.message == "looking for the best place"
    version = bracket.version
    for _ in range(9):
        add()
        bracket.poll()
    assert (bracket.message, bracket.version) == ("looking for the best place", version)
    bracket.remove()
    assert bracket.layout is before
    assert "wait, or `cancel`" in bracket.message
    go.set()
    bracket.wait()
    assert len(bracket.layout.elements) == len(before.elements) + 1
    go.clear()
    add()
    bracket.cancel()
    go.set()
    bracket.wait()
    assert len(bracket.layout.elements) == len(before.elements) + 1
    assert "cancelled" in bracket.message


def test_what_cannot_be_saved_is_said_and_not_lost(bracket: Steering, tmp_path: Path) -> None:
    bracket.remove()
    bracket.save(tmp_path / "none" / "x.yaml")
    assert bracket.message.startswith("not saved")
    assert bracket.session.unsaved
    path = bracket.leave()
    assert path == tmp_path / "b.recovered.yaml"
    assert len(fd.read_layout(path).elements) == len(bracket.layout.elements)


def test_recovery_replaces_nothing_and_finds_a_place(
    bracket: Steering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "b.recovered.yaml").write_text("older")
    assert recover(bracket.layout, tmp_path / "b.yaml") == tmp_path / "b.recovered-2.yaml"
    assert (tmp_path / "b.recovered.yaml").read_text() == "older"
    monkeypatch.chdir(tmp_path)
    assert recover(bracket.layout, tmp_path / "gone" / "b.yaml") == tmp_path / "b.recovered-3.yaml"
    monkeypatch.setattr("fixture_design.viewing.session.files._folders", lambda target: iter([tmp_path / "gone"]))
    assert recover(bracket.layout, tmp_path / "b.yaml") is None
    assert "schema: fixture_design/layout/1" in capsys.readouterr().err


def test_names_of_files(tmp_path: Path) -> None:
    assert stem_of(Path("a/bracket.layout.yaml")) == "bracket"
    assert stem_of(Path("bracket.edited-2.yaml")) == "bracket.edited-2"
    (tmp_path / "b.edited.yaml").touch()
    assert next(free_names(tmp_path, "b", "edited")).name == "b.edited-2.yaml"
    source = tmp_path / "b.layout.yaml"
    assert target_of(source, None, ()) == tmp_path / "b.edited-2.yaml"
    assert target_of(tmp_path / "part.stl", None, ()) == tmp_path / "part.layout.yaml"
    assert target_of(source, source, ()) == source
    (tmp_path / "part.yaml").touch()
    for wrong in (tmp_path / "part.stl", tmp_path / "no" / "x.yaml", tmp_path / "part.yaml"):
        with pytest.raises(FileFormatError):
            target_of(source, wrong, (tmp_path / "part.yaml",))


def test_what_is_no_session(tmp_path: Path) -> None:
    with pytest.raises(UnsupportedError, match="without a part"):
        begun(Steering, URDF / "figure8" / "p1234.layout.yaml")
    with pytest.raises(FileFormatError, match="scale"):
        begun(Steering, BRACKET, scale=2.0)
    with pytest.raises(InputError):
        begun(Steering, tmp_path / "none.stl")


def test_without_a_browser_it_is_a_layout_with_operations(tmp_path: Path) -> None:
    session = fd.interactive(POLYGON, out=tmp_path / "x.yaml", browser=False)
    session.slide(0.1)
    session.save()
    layout = session.stop()
    assert layout is session.layout
    assert at(fd.read_layout(tmp_path / "x.yaml"), "P1") == pytest.approx(at(layout, "P1"), abs=0)


def test_names_cannot_become_code() -> None:
    assert not set(harmless("'\"`\\<>&$\n\0")) & set("'\"`\\<>&$\n\0")


def test_sizes_are_round() -> None:
    assert round_size(0.034) == pytest.approx(0.02)
    assert round_size(1.7e-4) == pytest.approx(1e-4)
    assert round_size(1.0) == pytest.approx(0.5) or round_size(1.0) == pytest.approx(1.0)


class Board:
    """As much of Drake's Meshcat as a panel needs; keeps what is in it, in order."""

    def __init__(self) -> None:
        self.sliders: dict[str, float] = {}
        self.buttons: dict[str, int] = {}

    def AddSlider(self, name: str, low: float, high: float, step: float, value: float) -> None:
        assert name not in self.sliders
        self.sliders[name] = value

    def DeleteSlider(self, name: str, strict: bool = True) -> None:
        self.sliders.pop(name, None)

    def SetSliderValue(self, name: str, value: float) -> None:
        self.sliders[name] = value

    def GetSliderValue(self, name: str) -> float:
        return self.sliders[name]

    def AddButton(self, name: str) -> None:
        assert name not in self.buttons
        self.buttons[name] = 0

    def DeleteButton(self, name: str) -> None:
        del self.buttons[name]

    def GetButtonClicks(self, name: str) -> int:
        return self.buttons[name]


def test_the_panel_keeps_its_order_and_counts_clicks() -> None:
    from fixture_design.viewing.session.lines import Line

    board = Board()
    panel = Panel(board, ["add", "quit"], 0.05, 1e-4, flat=False)
    panel.show(1, 3)
    panel.write([Line("a"), Line("b", ("all", "form_closure")), Line("b"), Line("c")])
    assert list(board.buttons) == ["add", "quit", "a", "b", "b ", "c"]
    panel.write([Line("a"), Line("x"), Line("c")])
    assert list(board.buttons) == ["add", "quit", "a", "x", "c"]
    board.buttons["add"] += 2
    assert panel.clicked() == ["add", "add"]
    assert panel.clicked() == []
    assert panel.asked() is None
    board.buttons["x"] += 1
    assert panel.asked() is None  # it is about no answer
    panel.write([Line("a"), Line("x"), Line("c", ("all", "form_closure"))])
    board.buttons["c"] += 1
    assert panel.asked() == Line("c", ("all", "form_closure"))
    assert panel.asked() is None
    panel.write([Line("a"), Line("c", ("all", "form_closure"))])
    board.buttons["c"] += 1
    assert panel.asked() == Line("c", ("all", "form_closure"))
    panel.show(2, 2)
    panel.write([Line("a")])
    assert list(board.buttons) == ["add", "quit", "a"]
    assert panel.clicked() == []
    reading = panel.read()
    assert reading is not None
    assert (reading.number, reading.u) == (2, 0.0)
    board.sliders[ELEMENT], board.sliders[U] = 1.0, 3.0  # by the user, while 2 is being shown
    panel.show(2, 2, Reading(2, 1e-3, 0.0))
    assert (board.sliders[ELEMENT], board.sliders[U]) == (1.0, 0.0)
    panel.show(1, 0)
    assert panel.read() is None
    assert not board.sliders


def test_a_session_begins_with_nothing_to_lose() -> None:
    layout = fd.read_layout(POLYGON)
    session = Session.of(layout)
    assert session.chosen == layout.elements[0].name
    assert not session.unsaved
    assert steps.undone(session) is session
    assert steps.redone(session) is session

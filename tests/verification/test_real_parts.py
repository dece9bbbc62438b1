"""Two real parts in 3-2-1 layouts made by hand: from mesh to verdict, and what happens if something is wrong."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fixture_design.cli.main import main
from fixture_design.cli.verdict_table import print_verdict
from fixture_design.errors import OffSurfaceError
from fixture_design.geometry import PartGeometry, contacts_of_elements, load_part
from fixture_design.io import read_layout
from fixture_design.layout import Answer, Layout, PointTip, Singular, Verdict
from fixture_design.verification import check, verify

FOLDER = Path(__file__).resolve().parents[1] / "layouts"
FILES = {name: FOLDER / f"{name}.layout.yaml" for name in ("featuretype", "robotiq_adapter")}

X, Y, Z = np.eye(3)
#: The outward normals of the faces that L1 to L6 and K1 to K3 stand on.
NORMALS = {
    "featuretype": [-Z, -Z, -Z, -Y, -Y, -X, Z, Y, X],
    "robotiq_adapter": [-Y, -Y, -Y, -X, -X, -Z, Y, X, Z],
}
NAMES = ["L1", "L2", "L3", "L4", "L5", "L6", "K1", "K2", "K3"]

#: What margins are at least: the 6th singular value of the locators, form closure, force closure.
MARGINS = {"featuretype": (0.38, 0.06, 0.1), "robotiq_adapter": (0.5, 0.06, 0.11)}


@pytest.fixture(params=FILES)
def name(request: pytest.FixtureRequest, shared: Path) -> str:
    file = read_layout(FILES[request.param]).part.file
    if not file.resolve().is_relative_to(shared.resolve()) or not file.is_file():
        pytest.skip(f"{file.name} is not in the folder `shared`")
    return request.param


@cache
def geometry_of(name: str) -> PartGeometry:
    return load_part(read_layout(FILES[name]).part)


@cache
def verdict_of(name: str) -> Verdict:
    return verify(read_layout(FILES[name]))


@pytest.fixture
def layout(name: str) -> Layout:
    return read_layout(FILES[name])


@pytest.fixture
def verdict(name: str) -> Verdict:
    return verdict_of(name)


def without(layout: Layout, verdict: Verdict, *names: str) -> Verdict:
    """The verdict on the other contacts; they are where they were, so that the part need not be asked again."""
    kept = tuple(contact for contact in verdict.contacts if contact.name not in names)
    return verify(replace(layout, part=None, elements=(), contacts=kept))


def test_requirements_hold_and_the_checker_confirms(name: str, verdict: Verdict) -> None:
    assert verdict.satisfied is Answer.YES
    assert len(verdict.requirements) == 4
    assert verdict.notes == ()
    assert check(verdict) == []
    located, held = verdict.groups["locators"].findings, verdict.groups["all"].findings
    singular_value, form, force = MARGINS[name]
    assert located["deterministic"].margin > singular_value
    assert located["strongly_accessible"].margin > 0.5
    assert held["form_closure"].margin > form
    assert held["force_closure"].margin > force


def test_elements_stand_on_plane_faces(name: str, layout: Layout, verdict: Verdict) -> None:
    assert [contact.name for contact in verdict.contacts] == NAMES
    for contact, element, normal in zip(verdict.contacts, layout.elements, NORMALS[name], strict=True):
        assert abs(contact.distance) < 1e-6 * 2 * verdict.length
        np.testing.assert_allclose(contact.point, element.at, rtol=0, atol=1e-6 * verdict.length)
        [found] = contact.normals
        np.testing.assert_allclose(found / np.linalg.norm(found), normal, rtol=0, atol=1e-12)
        assert (contact.provenance.kind, contact.provenance.normal_error) == ("exact", 0.0)
        assert contact.feature.startswith("facet ")
        assert contact.friction == 0.15


def test_locators_share_three_faces(verdict: Verdict) -> None:
    feature = {contact.name: contact.feature for contact in verdict.contacts}
    assert feature["L1"] == feature["L2"] == feature["L3"]
    assert feature["L4"] == feature["L5"]
    assert len(set(feature.values())) == 6


def test_a_point_tip_gives_the_same_verdict(layout: Layout, verdict: Verdict) -> None:
    points = replace(layout, elements=tuple(replace(element, tip=PointTip()) for element in layout.elements))
    for group, found in verify(points).groups.items():
        for question, finding in found.findings.items():
            known = verdict.groups[group].findings[question]
            assert finding.answer is known.answer
            assert finding.margin == pytest.approx(known.margin, rel=1e-9)


def test_through_the_command(name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("sys.argv", ["fixture-design", "verify", "--json", str(FILES[name])])
    with pytest.raises(SystemExit) as left:
        main()
    said = capsys.readouterr()
    assert (left.value.code, said.err) == (0, "")
    record = json.loads(said.out)
    assert (record["name"], record["satisfied"]) == (name, "yes")
    assert [contact["name"] for contact in record["contacts"]] == NAMES
    assert record["run"]["length"] == pytest.approx({"featuretype": 0.0731, "robotiq_adapter": 0.0341}[name], abs=1e-4)


@pytest.mark.parametrize("removed", [["K1", "K2", "K3"], ["K1"], ["K2"], ["K3"]], ids="+".join)
def test_with_a_clamp_less_it_is_not_form_closed(layout: Layout, verdict: Verdict, removed: list[str]) -> None:
    verdict = without(layout, verdict, *removed)
    assert verdict.groups["all"].findings["form_closure"].answer is Answer.NO
    assert verdict.groups["locators"].findings["deterministic"].answer is Answer.YES
    assert verdict.satisfied is Answer.NO
    assert check(verdict) == []


@pytest.mark.parametrize("removed", ["L1", "L2", "L3", "L4", "L5", "L6"])
def test_with_a_locator_less_the_position_is_not_determined(layout: Layout, verdict: Verdict, removed: str) -> None:
    fewer = without(layout, verdict, removed)
    finding = fewer.groups["locators"].findings["deterministic"]
    assert finding.answer is Answer.NO
    assert isinstance(finding.evidence, Singular)
    assert finding.evidence.rank == 5
    motion = finding.evidence.motion / np.abs(finding.evidence.motion).max()
    for contact in verdict.contacts:
        if contact.role == "locator":
            [normal] = contact.normals
            unit = normal / np.linalg.norm(normal)
            speed = unit @ (motion[:3] + np.cross(motion[3:], contact.point))
            # the five that are left do not notice the motion; the one that is missing would
            assert (abs(speed) > 1e-3) == (contact.name == removed)
    assert check(fewer) == []


def test_the_motion_that_is_not_noticed_is_named(
    layout: Layout, verdict: Verdict, capsys: pytest.CaptureFixture[str]
) -> None:
    print_verdict(without(layout, verdict, "L6"))
    last = {"featuretype": "1, 0, 0", "robotiq_adapter": "0, 0, 1"}[layout.name]
    said = capsys.readouterr().out
    assert any(f"rank 5; not noticed: along [{way}]" in said for way in (last, last.replace("1", "-1")))


@pytest.mark.parametrize("element", ["L1", "L4", "L6", "K2"])
def test_an_element_off_the_surface_is_refused_with_its_distance(layout: Layout, name: str, element: str) -> None:
    normals = dict(zip(NAMES, NORMALS[name], strict=True))
    for distance, words in ((3e-4, "300 um"), (1.1e-5, "11 um"), (0.0042, "4.2 mm")):
        moved = replace(
            layout,
            elements=tuple(
                replace(other, at=other.at + distance * normals[element]) if other.name == element else other
                for other in layout.elements
            ),
        )
        with pytest.raises(OffSurfaceError, match=f"element '{element}' is {words} off the surface") as caught:
            contacts_of_elements(moved, geometry_of(name))
        assert caught.value.distance == pytest.approx(distance, abs=1e-8)
        assert caught.value.source == layout.source


@pytest.mark.parametrize("outside", [True, False])
def test_raising_the_gap_accepts_what_is_off(layout: Layout, name: str, outside: bool) -> None:
    offset = 3e-4 if outside else -3e-4
    first, *others = layout.elements
    moved = replace(
        layout, elements=(replace(first, at=first.at + offset * NORMALS[name][0]), *others), surface_gap=4e-4
    )
    contact = contacts_of_elements(moved, geometry_of(name)).contacts[0]
    assert contact.distance == pytest.approx(offset, abs=1e-8)
    np.testing.assert_allclose(contact.point, first.at, rtol=0, atol=1e-8)  # on the surface all the same


@pytest.mark.parametrize("factor", [1e3, 1e-3])
def test_a_mesh_in_the_wrong_unit_is_hinted_at_and_changes_no_verdict(name: str, factor: float) -> None:
    layout, verdict = read_layout(FILES[name]), verdict_of(name)
    elements = tuple(
        replace(element, at=element.at * factor, tip=replace(element.tip, radius=element.tip.radius * factor))
        for element in layout.elements
    )
    part = replace(layout.part, scale=layout.part.scale * factor)
    wrong = verify(replace(layout, part=part, elements=elements))
    [note] = wrong.notes
    assert note.startswith(f"{part.file.name}: the part is ")
    assert "check `scale`" in note
    assert wrong.satisfied is Answer.YES
    for question, finding in wrong.groups["all"].findings.items():
        assert finding.margin == pytest.approx(verdict.groups["all"].findings[question].margin, rel=1e-6)

"""Laws of the scene: it shows what the verdict holds, in proportion, all of it and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design import Contact, Layout, Verdict, read_layout, verify
from fixture_design.contacts import unit_normal, velocity
from fixture_design.layout import Answer, Balance, Element, LoadsHeld, Motion, PinTip, Pose, StraightWays
from fixture_design.viewing.label_places import placed_labels
from fixture_design.viewing.palette import ANSWER_COLORS, ROLE_COLORS, rgb
from fixture_design.viewing.projection import Projection
from fixture_design.viewing.rounds import rounds
from fixture_design.viewing.scene import (
    Arrow,
    Box,
    Cylinder,
    Mesh,
    Scene,
    Sphere,
    Story,
    Thing,
    changed_paths,
    scene_of,
    triangles_of,
)
from fixture_design.viewing.scene.arrows import bent_arrow
from fixture_design.viewing.scene.elements import element_things
from fixture_design.viewing.scene.motions import screw_pose
from fixture_design.viewing.scene.space import Twist, lifted
from fixture_design.viewing.scene.tessellation import extent

URDF = Path(__file__).resolve().parents[2] / "urdf"
BRACKET = URDF / "bracket" / "bracket.layout.yaml"
LAYOUTS = sorted([BRACKET, URDF / "vblock" / "vblock.layout.yaml", *(URDF / "figure8").glob("*.layout.yaml")])

numbers = st.floats(-2, 2)
twists = st.builds(
    lambda a, b: Twist(np.array(a), np.array(b)), st.tuples(*[numbers] * 3), st.tuples(*[numbers] * 3)
)  # fmt: skip


@cache
def looked_at(path: Path) -> tuple[Layout, Verdict, Scene]:
    layout = read_layout(path)
    verdict = verify(layout)
    return layout, verdict, scene_of(layout, verdict)


def story_of(scene: Scene, group: str, claim: str) -> Story:
    return next(story for story in scene.stories if (story.group, story.claim) == (group, claim))


def pushes(story: Story) -> list[tuple[np.ndarray, np.ndarray]]:
    """Where each push starts, and what it is."""
    arrows = [thing.shape for thing in story.things if "/push/" in thing.path]
    assert all(isinstance(arrow, Arrow) for arrow in arrows)
    return [(arrow.start, arrow.end - arrow.start) for arrow in arrows]  # type: ignore[union-attr]


def push_at(story: Story, point: np.ndarray) -> np.ndarray:
    """The only push that starts there."""
    (found,) = (push for start, push in pushes(story) if np.allclose(start, point))
    return found


@pytest.mark.parametrize("claim", ["form_closure", "strongly_accessible"])
def test_arrows_are_as_long_as_the_weights(claim: str) -> None:
    _, verdict, scene = looked_at(BRACKET)
    weights = verdict.groups["all"].findings[claim].evidence[0].weights  # type: ignore[index]
    story = story_of(scene, "all", claim)
    lengths = []
    for contact in verdict.contacts:
        (weight,) = weights[contact.name]
        arrow = push_at(story, contact.point)
        lengths.append(np.linalg.norm(arrow) / weight)
        assert arrow @ contact.normals[0] < 0  # into the part
    assert lengths == pytest.approx([lengths[0]] * len(lengths))


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_pushes_that_close_balance(path: Path) -> None:
    _, verdict, scene = looked_at(path)
    closed = [s for s in scene.stories if s.claim in ("form_closure", "force_closure") and s.answer is Answer.YES]
    for story in closed:
        force = sum(push for _, push in pushes(story))
        moment = sum(np.cross(at - scene.center, push) for at, push in pushes(story))
        assert np.abs(force).max() < 1e-8 * scene.size
        assert np.abs(moment).max() < 1e-8 * scene.size**2
    assert bool(closed) == any(
        finding.answer is Answer.YES
        for group in verdict.groups.values()
        for claim, finding in group.findings.items()
        if claim in ("form_closure", "force_closure")
    )


def test_forces_that_carry_a_load_are_all_drawn_in_one_scale() -> None:
    _, verdict, scene = looked_at(BRACKET)
    use = verdict.groups["clamped"].findings["holds_loads"].use
    assert isinstance(use, LoadsHeld)
    proof = use.loads[use.worst].proof
    assert isinstance(proof, Balance)
    story = story_of(scene, "clamped", "holds_loads")
    scales = []
    for contact in verdict.contacts:
        force = proof.forces[contact.name].forces.sum(axis=0)
        arrow = push_at(story, contact.point)
        scales.append(np.linalg.norm(arrow) / np.linalg.norm(force))
        assert arrow / np.linalg.norm(arrow) == pytest.approx(force / np.linalg.norm(force))
    load = next(thing.shape for thing in story.things if thing.path.endswith("/acting/1/force"))
    assert isinstance(load, Arrow)
    scales.append(load.length / np.linalg.norm(use.loads[use.worst].wrench[:3]))
    assert scales == pytest.approx([scales[0]] * len(scales))


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_the_part_moves_as_the_evidence_says(path: Path) -> None:
    _, verdict, scene = looked_at(path)
    looked = 0
    for story in scene.stories:
        finding = verdict.groups[story.group].findings[story.claim]
        if not isinstance(finding.evidence, Motion):
            continue
        assert story.animation is not None
        motion, start = finding.evidence.motion, story.animation.poses[1]
        inside = [contact for contact in verdict.contacts if contact.name in verdict.groups[story.group].contacts]
        for contact in inside:
            moved = start.points(lifted(contact.point)[None])[0] - lifted(contact.point)
            wanted = lifted(velocity(motion, contact.point))
            scale = np.linalg.norm(moved) / max(float(np.linalg.norm(wanted)), 1e-300)
            # a step of a twelfth of what is shown turns by at most 0.03: that much it may be off its tangent
            assert moved == pytest.approx(scale * wanted, abs=0.03 * scene.size)
        for contact, clause in ((c, clause) for c in inside for clause in c.clauses):
            shown = screw_pose(Twist.of_motion(motion), 1e-6 * scene.size / np.linalg.norm(motion))
            step = shown.points(lifted(contact.point)[None])[0] - lifted(contact.point)
            assert min(float(lifted(unit_normal(normal)) @ step) for normal in clause) <= 1e-9 * scene.size
        looked += 1
    assert looked or not any(story.claim == "form_closure" and story.answer is Answer.NO for story in scene.stories)


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_every_contact_is_drawn_once_with_all_its_normals(path: Path) -> None:
    _, verdict, scene = looked_at(path)
    points = [thing.shape for thing in scene.things if thing.path.startswith("contacts/")]
    assert len(points) == len(verdict.contacts)
    for contact, ball in zip(verdict.contacts, points, strict=True):
        assert isinstance(ball, Sphere)
        assert ball.center == pytest.approx(lifted(contact.point))
    normals = [normal for contact in verdict.contacts for normal in contact.normals]
    arrows = [thing.shape for thing in scene.things if thing.path.startswith("normals/")]
    for normal, arrow in zip(normals, arrows, strict=True):
        assert isinstance(arrow, Arrow)
        assert (arrow.end - arrow.start) / arrow.length == pytest.approx(-lifted(unit_normal(normal)))
    cones = [thing for thing in scene.things if thing.path.startswith("cones/")]
    assert len(cones) == sum(len(contact.normals) for contact in verdict.contacts if contact.friction > 0)


def test_the_cone_opens_as_far_as_friction_holds() -> None:
    _, verdict, scene = looked_at(BRACKET)
    cone = next(thing.shape for thing in scene.things if thing.path.startswith("cones/"))
    assert isinstance(cone, Cylinder)
    assert cone.end_radius == pytest.approx(verdict.contacts[0].friction * np.linalg.norm(cone.end - cone.start))


def test_nothing_is_shown_of_a_group_without_contacts() -> None:
    contacts = [Contact.on_facet(f"K{k}", "clamp", [x, y], [x, y]) for k, (x, y) in enumerate([(1, 0), (-1, 0)])]
    layout = Layout("clamps only", space="planar", contacts=tuple(contacts))
    verdict = verify(layout)
    scene = scene_of(layout, verdict)
    empty = [story for story in scene.stories if story.group == "locators"]
    assert empty
    assert not any(story.shown or story.labels for story in empty)
    assert scene.first is not None
    assert scene.stories[scene.first].group == "all"


def test_who_is_not_in_the_group_steps_aside() -> None:
    layout, _, scene = looked_at(BRACKET)
    things, labels = scene.told(story_of(scene, "locators", "form_closure"))
    assert {label.text for label in labels} == {e.name for e in layout.elements if e.role == "locator"}
    assert not any(thing.path.startswith("elements/clamp") for thing in things)
    assert sum(thing.path.startswith("contacts/") for thing in things) == 6


def test_the_smallest_push_comes_from_outside_along_the_motion() -> None:
    _, verdict, scene = looked_at(BRACKET)
    story = story_of(scene, "locators", "form_closure")
    push = next(thing.shape for thing in story.things if thing.path.endswith("/disturbance"))
    motion = verdict.groups["locators"].findings["form_closure"].evidence
    assert isinstance(push, Arrow)
    assert isinstance(motion, Motion)
    way = push.end - push.start
    moves = velocity(motion.motion, push.end)
    assert way / push.length == pytest.approx(moves / np.linalg.norm(moves))
    part = next(thing.shape for thing in scene.things if thing.path == "part/solid")
    assert isinstance(part, Mesh)
    corners = part.vertices[part.triangles]
    hit = int(np.argmin(np.linalg.norm(corners.mean(axis=1) - push.end, axis=1)))
    normal = np.cross(corners[hit, 1] - corners[hit, 0], corners[hit, 2] - corners[hit, 0])
    assert normal @ way < 0


def test_the_way_out_has_its_true_length() -> None:
    _, verdict, scene = looked_at(BRACKET)
    use = verdict.groups["placed"].findings["loadable"].use
    assert isinstance(use, StraightWays)
    story = story_of(scene, "placed", "loadable")
    assert story.animation is not None
    assert use.length is not None
    assert use.direction is not None
    last = story.animation.poses[-1].translation
    assert np.linalg.norm(last) == pytest.approx(min(use.length, 2 * scene.size))
    assert last / np.linalg.norm(last) == pytest.approx(use.direction)
    things, _ = scene.told(story)
    assert not any(thing.path.startswith("elements/clamp") for thing in things)  # they are open


def test_the_scene_moves_with_the_layout() -> None:
    layout, _, scene = looked_at(BRACKET)
    by = np.array([3.0, -40.0, 7.0])
    assert layout.part is not None
    part = replace(layout.part, pose=Pose(layout.part.pose.rotation, layout.part.pose.translation + by))
    moved = replace(
        layout, part=part, stages=(), loads=(), key_features=(),
        elements=tuple(replace(element, at=element.at + by) for element in layout.elements),
    )  # fmt: skip
    there = scene_of(moved, verify(moved))
    assert there.to_view(there.camera.eye[None]) == pytest.approx(scene.to_view(scene.camera.eye[None]), abs=2e-3)
    here = {thing.path: thing for thing in scene.things}
    for thing in there.things:
        if thing.path.startswith(("part/solid", "elements", "contacts")):
            seen = there.to_view(triangles_of(thing.shape).vertices)
            assert seen == pytest.approx(scene.to_view(triangles_of(here[thing.path].shape).vertices), abs=1e-9)


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_paths_are_unique_and_everything_is_in_a_layer_or_story(path: Path) -> None:
    _, _, scene = looked_at(path)
    paths = [thing.path for thing in scene.things] + [thing.path for s in scene.stories for thing in s.things]
    assert len(set(paths)) == len(paths)
    layers = tuple(layer.path + "/" for layer in scene.layers)
    assert all(thing.path.startswith(layers) for thing in scene.things)
    assert all(thing.path.startswith(story.path + "/") for story in scene.stories for thing in story.things)


def test_planar_layouts_are_thin_plates_about_their_plane() -> None:
    _, _, scene = looked_at(URDF / "figure8" / "polygon_p12345.layout.yaml")
    part = next(thing.shape for thing in scene.things if thing.path == "part/solid")
    assert isinstance(part, Mesh)
    assert part.vertices[:, 2].max() == -part.vertices[:, 2].min()
    assert 0 < part.vertices[:, 2].max() < 0.1 * scene.size
    assert volume(part) > 0


def test_only_what_changed_is_drawn_again() -> None:
    layout, _, scene = looked_at(BRACKET)
    moved = replace(layout.elements[6], at=layout.elements[6].at + np.array([0.002, 0.0, 0.0]))
    changed = replace(layout, elements=(*layout.elements[:6], moved, *layout.elements[7:]), stages=())
    after = scene_of(changed, verify(changed))
    gone, new = changed_paths(scene.things, after.things)
    assert gone == ()
    assert {path for path in new if not path.startswith(("contacts/6", "normals/6", "cones/6"))} == {
        f"elements/clamp/6/{k}" for k in range(3)
    }
    assert changed_paths(scene.things, scene.things) == ((), frozenset())


def weak() -> Layout:
    """The bracket with clamps that do not hold its load, and a tolerance that is not kept."""
    layout = read_layout(BRACKET)
    elements = [e if e.preload is None else replace(e, preload=e.preload / 50) for e in layout.elements]
    features = (replace(layout.key_features[1], tolerance=1e-5),)
    pull = (layout.loads[0], replace(layout.loads[1], force=np.array([20.0, 60.0, 40.0])))
    return replace(layout, elements=tuple(elements), key_features=features, loads=pull)


def boxed() -> Layout:
    """The bracket with locators on all sides: it does not come out."""
    lid = Contact.on_facet("lid", "locator", [0.01, 0.02, 0.03], [0.0, 0.0, 1.0])
    sides = [([0.03, 0.04, 0.005], [0.0, 1.0, 0.0]), ([0.06, 0.02, 0.005], [1.0, 0.0, 0.0])]
    walls = [Contact.on_facet(f"wall{k}", "locator", point, normal) for k, (point, normal) in enumerate(sides)]
    return replace(read_layout(BRACKET), contacts=(lid, *walls))


FAILING = {"weak": (weak, {"holds_loads", "accurate"}), "boxed": (boxed, {"strongly_accessible", "loadable"})}


@pytest.mark.parametrize("name", FAILING)
def test_what_fails_is_shown_first(name: str) -> None:
    make, wanted = FAILING[name]
    layout = make()
    verdict = verify(layout)
    scene = scene_of(layout, verdict)
    assert wanted <= {each.require for each in verdict.requirements if each.answer is Answer.NO}
    assert scene.first is not None
    assert scene.stories[scene.first].required
    assert scene.stories[scene.first].answer is Answer.NO
    assert_denials_are_seen(scene)


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_for_every_no_there_is_something_to_see(path: Path) -> None:
    assert_denials_are_seen(looked_at(path)[2])


def assert_denials_are_seen(scene: Scene) -> None:
    for story in scene.stories:
        if story.answer is Answer.NO:
            assert story.things, (story.group, story.claim)
            if story.claim in ("form_closure", "force_closure", "holds_loads", "deterministic"):
                assert story.animation is not None
            if story.claim in ("form_closure", "force_closure"):
                assert any(thing.path.endswith("/disturbance") for thing in story.things)


def test_only_the_stories_that_are_wanted_are_told() -> None:
    layout, verdict, scene = looked_at(BRACKET)
    one = scene_of(layout, verdict, tell={("all", "form_closure")})
    assert [story.path for story in one.stories if story.shown] == [story_of(scene, "all", "form_closure").path]
    assert [story.answer for story in one.stories] == [story.answer for story in scene.stories]


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_cameras_have_everything_in_view(path: Path) -> None:
    _, _, scene = looked_at(path)
    for story in (None, *scene.stories):
        camera = scene.camera if story is None or story.camera is None else story.camera
        view = Projection.of(scene, camera, 1000, 800)
        things = [t.shape for t in scene.told(story)[0] if not t.path.startswith(("loads", "normals", "cones"))]
        pixels, depths = view.pixels(scene.to_view(extent(things)))
        assert depths.min() > view.clipping[0]
        assert pixels.min() >= 0
        assert (pixels <= [1000, 800]).all()


@given(twists, st.floats(-1, 1), st.floats(-1, 1))
def test_screws_add_up(twist: Twist, first: float, second: float) -> None:
    point = np.array([[0.3, -0.2, 0.5]])
    one = screw_pose(twist, second).points(screw_pose(twist, first).points(point))
    assert one == pytest.approx(screw_pose(twist, first + second).points(point), abs=1e-9)


@given(twists)
def test_a_screw_begins_with_its_displacement(twist: Twist) -> None:
    point, step = np.array([0.3, -0.2, 0.5]), 1e-6
    moved = screw_pose(twist, step).points(point[None])[0] - point
    assert moved / step == pytest.approx(twist.at(point), abs=1e-4)


def volume(mesh: Mesh) -> float:
    """Of what the triangles enclose: negative where they are inside out."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles] - mesh.vertices.mean(axis=0), 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


_A, _B = np.array([0.1, 0.2, -0.3]), np.array([1.1, -0.4, 0.5])
_LENGTH = float(np.linalg.norm(_B - _A))


@pytest.mark.parametrize(
    ("shape", "wanted"),
    [
        (Sphere(_A, 0.5), 4 / 3 * np.pi * 0.125),
        (Cylinder(_A, _B, 0.2), np.pi * 0.04 * _LENGTH),
        (Cylinder(_A, _B, 0.2, 0.0), np.pi * 0.04 * _LENGTH / 3),
        (Cylinder(_A, _B, 0.0, 0.2), np.pi * 0.04 * _LENGTH / 3),
        (Box(_A, np.eye(3), np.array([1.0, 2.0, 3.0])), 6.0),
        (bent_arrow(_A, np.array([0.0, 0.0, 1.0]), 1.0, 0.05, 0.0), np.pi * 0.05**2 * 1.5 * np.pi),
    ],
)
def test_surfaces_are_closed_and_face_outwards(shape: Sphere | Cylinder | Box | Mesh, wanted: float) -> None:
    mesh = triangles_of(shape)
    assert volume(mesh) == pytest.approx(wanted, rel=0.08)


@pytest.mark.parametrize("length", [1.0, 0.01])
def test_an_arrow_ends_at_its_tip(length: float) -> None:
    arrow = Arrow(np.zeros(3), np.array([0.0, 0.0, length]), 0.02)
    mesh = triangles_of(arrow)
    assert mesh.vertices[:, 2].max() == pytest.approx(length)
    assert mesh.vertices[:, 2].min() == 0
    assert volume(mesh) > 0


@pytest.mark.parametrize("both_ways", [False, True])
def test_motions_go_there_and_back_in_order(both_ways: bool) -> None:
    _, _, scene = looked_at(BRACKET)
    moving = story_of(scene, "locators", "form_closure").animation
    assert moving is not None
    found = rounds(replace(moving, both_ways=both_ways))
    times = [time for time, _ in found]
    assert all(one < other for one, other in pairwise(times))
    for end in (found[0], found[-1]):
        assert end[1].translation == pytest.approx(np.zeros(3))
    farthest = max(np.linalg.norm(pose.translation) for _, pose in found)
    assert farthest == pytest.approx(np.linalg.norm(moving.poses[-1].translation), rel=0.2)


def apart(places: Sequence[object]) -> bool:
    boxes = [(p.left, p.top, p.right, p.bottom) for p in places]  # type: ignore[attr-defined]
    return all(
        a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
        for k, a in enumerate(boxes)
        for b in boxes[:k]
    )  # fmt: skip


@given(st.lists(st.tuples(st.floats(150, 650), st.floats(150, 450)), min_size=1, max_size=12))
def test_labels_do_not_cover_each_other(anchors: list[tuple[float, float]]) -> None:
    sizes = np.tile([24.0, 14.0], (len(anchors), 1))
    places = placed_labels(np.array(anchors), sizes, 800, 600)
    assert apart(places)
    assert all(p.left >= 0 and p.right <= 800 and p.top >= 0 and p.bottom <= 600 for p in places)


#: How cones of the eye that lack one kind see red, green and blue light (Vienot, Brettel and Mollon, 1999).
_LACKING = {
    "long": np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]]),
    "middle": np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]]),
}


@pytest.mark.parametrize("lacking", _LACKING)
def test_colours_of_roles_are_told_apart_by_all_eyes(lacking: str) -> None:
    linear = {role: _LACKING[lacking] @ np.array(rgb(color)) ** 2.2 for role, color in ROLE_COLORS.items()}
    seen = {role: np.clip(value, 0, 1) ** (1 / 2.2) for role, value in linear.items()}
    for (one, first), (other, second) in combinations(seen.items(), 2):
        assert np.linalg.norm(first - second) > 0.2, (one, other)
    assert len(set(ANSWER_COLORS.values())) == len(ANSWER_COLORS)


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_a_pin_stands_behind_its_end(up: float) -> None:
    """`axis` points from its foot to its end, as in the URDF."""
    axis = np.array([0.0, 0.0, up])
    pin = Element("P", "locator", np.zeros(3), PinTip(0.008, 2e-5, "round"), axis=axis)
    wall = [Contact(f"P#{k + 1}", "locator", 0.004 * x, ((-x,),)) for k, x in enumerate(np.eye(3)[:2])]
    things = [t for t in element_things(Layout("pinned", elements=(pin,)), wall, 0.05) if isinstance(t, Thing)]
    heights = up * np.vstack([extent([thing.shape]) for thing in things])[:, 2]
    assert -heights.min() > 2 * heights.max() > 0  # the foot is further away than the end

"""Elements that fit: no stem or body in the part, in another one, or in the part's way out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yourdfpy

from fixture_design.arrays import Mask, Point, Points
from fixture_design.design import CandidateRules, DesignResult, Task, design
from fixture_design.design.standing import Standing, segment_distances
from fixture_design.errors import GeometryError
from fixture_design.geometry import load_part
from fixture_design.io import write_urdf
from fixture_design.layout import Answer, Part, PointTip, Pose, Stem, StemSizes, stem_of
from tests.design.fakes import Fake, box, candidates, task
from tests.geometry.parts import part, prism, shared, write

#: Volumes below this part of the fixture's are touching facets [-].
CUT = 1e-9
#: Solids are measured in millimetres: smaller ones are nothing to trimesh.
MM = 1000.0


def test_distances_between_segments_are_those_of_many_points_on_them() -> None:
    rng = np.random.default_rng(3)
    start, way = rng.normal(size=3), rng.normal(size=3)
    starts, ways = rng.normal(size=(40, 3)), rng.normal(size=(40, 3))
    ways[0], starts[1] = 2 * way, start  # parallel; with a point in common
    found = segment_distances(start, way, starts, ways)
    along = np.linspace(0, 1, 201)
    first = start + along[:, None] * way
    for k in range(len(starts)):
        second = starts[k] + along[:, None] * ways[k]
        least = np.linalg.norm(first[:, None] - second[None], axis=2).min()
        step = (np.linalg.norm(way) + np.linalg.norm(ways[k])) / 400
        assert found[k] <= least + 1e-12
        assert found[k] >= least - step


def test_stems_collide_where_sampled_capsules_overlap() -> None:
    spots = candidates(box(20, 2))
    stem = Stem(0.002, 0.002, 0.01, 0.006, 0.01)
    stands = Standing.of(spots.places, spots.normals[:, 0], [stem] * (len(spots) - 1) + [None])
    heights = [np.linspace(c.low, c.high, 60) for c in stem.columns]
    radii = [stem.radius, stem.body_radius]
    points, normals = spots.places, spots.normals[:, 0]
    for index in range(0, len(spots) - 1, 7):
        for other in range(len(spots) - 1):
            if other == index:
                continue
            gaps = [
                np.linalg.norm(
                    (points[index] + a[:, None] * normals[index])[:, None]
                    - (points[other] + b[:, None] * normals[other])[None],
                    axis=2,
                ).min() - r - q
                for a, r in zip(heights, radii, strict=True)
                for b, q in zip(heights, radii, strict=True)
            ]  # fmt: skip
            if abs(min(gaps)) > 3e-4:
                assert bool(stands.beside(index)[other]) == bool(min(gaps) > 0)
    assert stands.beside(0)[-1]


@pytest.mark.parametrize("words", [("deterministic", "strongly_accessible"), ("deterministic",)])
def test_no_two_stems_of_a_design_collide(words: tuple[str, ...]) -> None:
    wide = StemSizes(radius=0.002, length=0.006, body_radius=0.012, body_length=0.02)
    spots = box(30, 1)
    free = design(task(spots, require={"locators": words[:2], "all": ("form_closure",)}), Fake(spots))
    asked = task(spots, require={"locators": words[:2], "all": ("form_closure",)}, candidates=CandidateRules(stem=wide))
    result = design(asked, Fake(spots))
    assert result.satisfied is Answer.YES
    assert crossing(free, wide)  # or the test would show nothing
    assert not crossing(result, wide)
    assert len(result.layout.elements) == len(free.layout.elements)  # type: ignore[union-attr]


def crossing(result: DesignResult, sizes: StemSizes) -> list[tuple[str, str]]:
    """Names of elements whose bodies, as spheres along their axes, overlap."""
    assert result.verdict is not None
    stem = stem_of(PointTip(), result.verdict.length, sizes)
    found = []
    spheres = []
    for contact in result.verdict.contacts:
        for column in stem.columns:
            heights = np.linspace(column.low, column.high, 50)
            spheres.append((contact.name, contact.point + heights[:, None] * contact.normals[0], column.radius))
    for k, (name, line, radius) in enumerate(spheres):
        for other, others, wide in spheres[k + 1 :]:
            if name != other and np.linalg.norm(line[:, None] - others[None], axis=2).min() < (radius + wide) * 0.999:
                found.append((name, other))
    return found


@dataclass(frozen=True, eq=False)
class Walled(Fake):
    """A part that runs into elements on some faces on its way out, as far as it is told."""

    walls: tuple[str, ...] = ()

    def fits(self, points: Points, normals: Points, stem: Stem, out: Point | None = None) -> Mask:
        near = np.argmin(np.linalg.norm(self.given.points[:, None] - points[None], axis=2), axis=0)
        hit = np.array([self.given.features[index] in self.walls for index in near.tolist()])
        left = points[:, 0] < 0
        return ~(hit & left) if out is not None else np.ones(len(points), dtype=bool)


def test_locators_that_the_part_would_run_into_are_left_out_and_told() -> None:
    spots = box(8)
    first = design(task(spots), Fake(spots))
    walls = tuple(sorted({spots.features[k] for k in range(len(spots.points))}))
    result = design(task(spots), Walled(spots, walls=walls))
    assert first.layout is not None
    assert result.layout is not None
    assert any(e.at[0] < 0 for e in first.layout.elements if e.role == "locator")
    assert result.satisfied is Answer.YES
    assert all(e.at[0] >= 0 for e in result.layout.elements if e.role == "locator")
    assert any(step.why == "in the way" for step in result.steps)
    assert any("way out" in note for note in result.notes)
    assert result.bound is not None
    assert first.bound is not None
    assert result.bound.elements == first.bound.elements  # of the problem without walls: still a bound


@dataclass(frozen=True, eq=False)
class Tight(Fake):
    def fits(self, points: Points, normals: Points, stem: Stem, out: Point | None = None) -> Mask:
        return np.zeros(len(points), dtype=bool)


def test_no_room_at_all_is_an_error() -> None:
    with pytest.raises(GeometryError, match="has room"):
        design(task(box(4)), Tight(box(4)))


def common(first: trimesh.Trimesh, second: trimesh.Trimesh) -> float:
    """The volume that two solids have in common, by that of the first one."""
    return abs(trimesh.boolean.intersection([first, second], engine="manifold").volume / first.volume)


def overlaps(result: DesignResult, part: trimesh.Trimesh, folder: Path) -> tuple[float, float]:
    """Of the exported URDF: the largest volume of a stem or body in the part, and in that of another element."""
    assert result.layout is not None
    assert result.verdict is not None
    write_urdf(result.layout, result.verdict, folder / "out.urdf")
    robot = yourdfpy.URDF.load(str(folder / "out.urdf"), load_meshes=False, build_scene_graph=True)
    solids = []
    for name, link in robot.link_map.items():
        columns = []
        for collision in link.collisions:
            if collision.geometry.cylinder is not None:
                shape = trimesh.creation.cylinder(
                    MM * collision.geometry.cylinder.radius * 0.999, MM * collision.geometry.cylinder.length
                )
                pose = robot.get_transform(name, "fixture") @ collision.origin
                pose[:3, 3] *= MM
                shape.apply_transform(pose)
                columns.append(shape)
        if columns:
            solids.append(columns)
    assert len(solids) == len(result.layout.elements)

    into = max(common(column, part) for columns in solids for column in columns)
    each = max(common(a, b) for k, one in enumerate(solids) for other in solids[k + 1 :] for a in one for b in other)
    return into, each


@pytest.mark.parametrize(("file", "scale"), [("featuretype.STL", 0.0254), ("plate_holes.STL", 0.001)])
def test_stems_of_a_real_part_stand_free_and_the_part_passes_them(file: str, scale: float, tmp_path: Path) -> None:
    path = shared(f"trimesh/models/{file}")
    result = design(Task(path.stem, Part(path.stem, "mesh", path, None, scale, Pose.identity(3))))
    assert result.satisfied is Answer.YES
    geometry = load_part(part(path, scale))
    solid = trimesh.Trimesh(MM * geometry.vertices, geometry.triangles)
    into, each = overlaps(result, solid, tmp_path)
    assert into < CUT
    assert each < CUT
    assert result.verdict is not None
    use = result.verdict.groups["locators"].findings["loadable"].use
    stem = stem_of(PointTip(), result.verdict.length)
    locators = [c for c in result.verdict.contacts if c.role == "locator"]
    for way in np.linspace(0.02, 2.5, 20) * result.verdict.length:
        moved = trimesh.Trimesh(MM * (geometry.vertices + way * use.direction), geometry.triangles)  # type: ignore[union-attr]
        for contact in locators:
            for column in stem.columns:
                ends = [MM * (contact.point + h * contact.normals[0]) for h in (column.low, column.high)]
                cylinder = trimesh.creation.cylinder(MM * column.radius * 0.99, segment=ends, sections=64)
                assert common(cylinder, moved) < CUT


def test_a_narrow_slot_gets_no_elements(tmp_path: Path) -> None:
    outline = [[0, 0], [0.1, 0], [0.1, 0.06], [0.054, 0.06], [0.054, 0.02], [0.046, 0.02], [0.046, 0.06], [0, 0.06]]
    file = write(tmp_path, prism(outline, 0.05), "slot.stl")
    result = design(Task("slot", Part("slot", "mesh", file, None, 1.0, Pose.identity(3))))
    assert result.satisfied is Answer.YES
    assert result.layout is not None
    inside = [e.name for e in result.layout.elements if 0.045 < e.at[0] < 0.055 and 0.015 < e.at[1] < 0.0599]
    assert inside == []
    assert any("left out" in note for note in result.notes)

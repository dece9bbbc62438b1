"""Every public part and pair that lies beside the repository: what becomes of it, and whether its surface is kept."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import GeometryError, InputError, UnsupportedError
from fixture_design.geometry import PartGeometry, load_part
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.piece import area_vectors
from fixture_design.layout import Part, Pose
from tests.geometry.parts import SHARED, shared

MM, INCH = 0.001, 0.0254

#: Points a part, and the largest distance of one from the surface that it was taken from, in sizes of the part.
POINTS, NEAR = 200, 1e-6

TRIMESH = "trimesh/models/"
AIRO = "airo-models/airo_models/"
FINGERTIPS = AIRO + "grippers/fingertips/originals/"
ROBOTIQ = AIRO + "grippers/robotiq_2f_85/meshes/"
KELO = AIRO + "mobile_platforms/kelo_robile/meshes/"
METAWORLD = "metaworld/metaworld/assets/objects/meshes/"
FACTORY = "IsaacGymEnvs/assets/factory/"
INSERTION = FACTORY + "mesh/factory_insertion/factory_"
INDUSTREAL = "IsaacGymEnvs/assets/industreal/"
ALLEGRO = "example-robot-data/example-robot-data/robots/allegro_hand_description/"
FINGER = "example-robot-data/example-robot-data/robots/finger_edu_description/"
BARRETT = "dex-urdf/robots/hands/barrett_hand/"
WSG = "drake_models/wsg_50_description/meshes/"

#: File, scale to metres, and a word of the note that says what was mended ("" for none).
LOADED = [
    (TRIMESH + "featuretype.STL", INCH, ""),
    (TRIMESH + "featuretype.STEP", 1.0, ""),
    (TRIMESH + "angle_block.STL", INCH, ""),
    (TRIMESH + "plate_holes.STL", MM, ""),
    (TRIMESH + "round.stl", MM, ""),
    (TRIMESH + "octagonal_pocket.stl", 1.0, ""),
    (TRIMESH + "7_8ths_cube.stl", MM, ""),
    (TRIMESH + "fixed_top.ply", MM, ""),
    (TRIMESH + "torus.STL", INCH, ""),
    (TRIMESH + "counterX.3MF", MM, ""),
    (TRIMESH + "groups.obj", MM, ""),
    (FINGERTIPS + "backing.stl", MM, ""),
    (FINGERTIPS + "robotiq_adapter.stl", MM, ""),
    (FINGERTIPS + "pcb_top_cover3.STL", MM, ""),
    (KELO + "lid.obj", 1.0, ""),
    (KELO + "general_brick_housing.obj", 1.0, "3 triangles without area"),
    (METAWORLD + "hammer/nail.stl", 1.0, ""),
    (METAWORLD + "buttonbox/stopbot.stl", 1.0, ""),
    (METAWORLD + "faucet/faucetbase.stl", 1.0, ""),
    (METAWORLD + "assembly_peg/assembly_peg_ring.stl", 1.0, ""),
    (METAWORLD + "assembly_peg/assembly_peg_rod.stl", 1.0, ""),
    (METAWORLD + "assembly_peg/assembly_peg_handle.stl", 1.0, ""),
    (METAWORLD + "peg_block/block_inner.stl", 1.0, ""),
    (METAWORLD + "peg_block/block_outer.stl", 1.0, ""),
    *((f"{INSERTION}round_peg_{size}mm_{fit}.obj", 1.0, "") for size in (8, 16) for fit in ("loose", "tight")),
    *((f"{INSERTION}round_hole_{size}mm_subdiv_3x.obj", 1.0, "28 vertices") for size in (8, 16)),
    *((f"{INSERTION}rectangular_peg_8mm_{fit}_subdiv_3x.obj", 1.0, "") for fit in ("loose", "tight")),
    (INSERTION + "rectangular_hole_8mm_subdiv_3x.obj", 1.0, "56 vertices"),
    *((f"{FACTORY}urdf/factory_round_peg_{size}mm_{fit}.urdf", 1.0, "")
      for size in (8, 16) for fit in ("loose", "tight")),
    *((f"{FACTORY}urdf/factory_round_hole_{size}mm.urdf", 1.0, "28 vertices") for size in (8, 16)),
    *((f"{FACTORY}urdf/factory_rectangular_peg_8mm_{fit}.urdf", 1.0, "") for fit in ("loose", "tight")),
    (FACTORY + "urdf/factory_rectangular_hole_8mm.urdf", 1.0, "56 vertices"),
    (INDUSTREAL + "mesh/industreal_gears/industreal_gear_base.obj", 1.0, ""),
    (INDUSTREAL + "mesh/industreal_gears/industreal_gear_small.obj", 1.0, "10 triangles without area"),
    (INDUSTREAL + "urdf/industreal_gear_base.urdf", 1.0, ""),
    (INDUSTREAL + "urdf/industreal_gear_small.urdf", 1.0, "10 triangles without area"),
    *((f"{ROBOTIQ}visual/robotiq_arg2f_85_{name}.obj", MM, "")
      for name in ("outer_knuckle", "outer_finger", "inner_knuckle", "inner_finger")),
    (ROBOTIQ + "visual/robotiq_arg2f_85_base_link.obj", 1.0, ""),
    *((f"{ROBOTIQ}collision/robotiq_arg2f_85_{name}.obj", MM, "")
      for name in ("outer_knuckle", "outer_finger", "inner_knuckle", "inner_finger")),
    (ROBOTIQ + "collision/robotiq_arg2f_base_link.obj", 1.0, ""),
    *((f"{ALLEGRO}meshes/{name}.STL", 1.0, "")
      for name in ("base_link", "link_0.0", "link_1.0", "link_2.0", "link_3.0", "link_3.0_tip", "link_12.0_right",
                   "link_13.0", "link_14.0", "link_15.0", "link_15.0_tip")),
    (WSG + "wsg_body.gltf", 1.0, ""),
    (WSG + "finger_with_tip.gltf", 1.0, ""),
    *((f"{BARRETT}meshes/visual/{name}.obj", 1.0, "") for name in ("prox_link", "med_link", "dist_link")),
    (BARRETT + "meshes/visual/base_link.obj", 1.0, "6 triangles without area"),
    *((f"{BARRETT}meshes/collision/{name}_cylinder.obj", 1.0, "") for name in ("prox_link", "base_link")),
    *((f"{FINGER}meshes/{name}.stl", 1.0, "")
      for name in ("upper_link", "middle_link", "lower_link", "base_top", "base_side_left", "base_front", "base_back")),
]  # fmt: skip

#: File, and why it is refused.
REFUSED: list[tuple[str, float, type[InputError], str]] = [
    (FINGERTIPS + "camera_arduino_holder.stl", MM, GeometryError, "6 open edges: the surface is not closed"),
    (AIRO + "grippers/robotiq_2f_85/urdf/robotiq_2f_85.urdf", 1.0, UnsupportedError, "rigid; found type 'revolute'"),
    (ALLEGRO + "urdf/allegro_right_hand.urdf", 1.0, UnsupportedError, "rigid; found type 'revolute'"),
    (BARRETT + "bhand_model.urdf", 1.0, UnsupportedError, "rigid; found type 'revolute'"),
    (FINGER + "robots/finger_edu.urdf", 1.0, UnsupportedError, "rigid; found type 'revolute'"),
]

KINDS = {".urdf": "urdf", ".step": "step"}
ENDINGS = (".stl", ".obj", ".dae", ".ply", ".gltf", ".glb", ".3mf", ".step", ".urdf")


def load(path: str, scale: float) -> PartGeometry:
    file = shared(path)
    if file.suffix == ".STEP" and importlib.util.find_spec("cascadio") is None:
        pytest.skip("the extra `step` is not installed")
    kind = KINDS.get(file.suffix.lower(), "mesh")
    return load_part(Part(file.stem, kind, file, None, scale, Pose.identity(3)))


def test_no_part_is_forgotten() -> None:
    if not SHARED.is_dir():
        pytest.skip("no shared data beside the repository")
    there = {str(file.relative_to(SHARED)) for file in SHARED.rglob("*") if file.suffix.lower() in ENDINGS}
    assert there == {path for path, *_ in LOADED} | {path for path, *_ in REFUSED}


@pytest.mark.parametrize(("path", "scale", "mended"), LOADED, ids=[Path(path).name for path, *_ in LOADED])
def test_loaded_and_points_of_its_surface_are_on_it(path: str, scale: float, mended: str) -> None:
    geometry = load(path, scale)
    assert 1e-3 < 2 * geometry.half_diagonal < 1
    notes = " ".join(geometry.read_notes)
    assert mended in notes if mended else not notes
    # every triangle is of one facet, and the surface is closed
    members = np.sort(np.concatenate([facet.triangles for facet in geometry.facets]))
    np.testing.assert_array_equal(members, np.arange(len(geometry.triangles)))
    areas = area_vectors(geometry.vertices, geometry.triangles)
    assert np.abs(areas.sum(axis=0)).max() < 1e-12 * np.abs(areas).sum()
    within = NEAR * 2 * geometry.half_diagonal
    for triangle, point in sampled(geometry):
        distance, nearest = geometry.surface.at(point)
        assert abs(distance) < within
        touched = touched_triangles(geometry, nearest, within)
        assert geometry.facet_of_triangle[triangle] in geometry.facet_of_triangle[touched]


def sampled(geometry: PartGeometry) -> list[tuple[int, np.ndarray]]:
    """Points spread evenly over the surface, each with its triangle."""
    rng = np.random.default_rng(7)
    corners = geometry.vertices[geometry.triangles]
    areas = np.linalg.norm(area_vectors(geometry.vertices, geometry.triangles), axis=1)
    chosen = rng.choice(len(areas), POINTS, p=areas / areas.sum())
    weights = rng.dirichlet(np.ones(3), POINTS)
    return list(zip(chosen.tolist(), np.einsum("nk,nkj->nj", weights, corners[chosen]), strict=True))


@pytest.mark.parametrize(("path", "scale", "error", "reason"), REFUSED, ids=[Path(path).name for path, *_ in REFUSED])
def test_refused_with_the_reason(path: str, scale: float, error: type[InputError], reason: str) -> None:
    with pytest.raises(error) as caught:
        load(path, scale)
    assert reason in str(caught.value)
    assert Path(path).name in str(caught.value)

"""Parts and hands for the tests of grasps: primitives, known exactly; the repository's own hands; those beside it."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fixture_design.geometry import PartGeometry, load_part
from fixture_design.grasp import HandModel, load_hand
from fixture_design.io import read_hand
from fixture_design.layout import Part, Pose

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "data"

JAW = ROOT / "robots" / "parallel_jaw" / "parallel_jaw.urdf"
THREE = ROOT / "robots" / "three_finger" / "three_finger.urdf"

#: Public hands that lie beside the repository.
PUBLIC = {
    "allegro": "example-robot-data/example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf",
    "barrett": "dex-urdf/robots/hands/barrett_hand/bhand_model.urdf",
    "robotiq": "airo-models/airo_models/grippers/robotiq_2f_85/urdf/robotiq_2f_85.urdf",
    "wsg": "drake_models/wsg_50_description/sdf/schunk_wsg_50.sdf",
    "wsg with tip": "drake_models/wsg_50_description/sdf/schunk_wsg_50_with_tip.sdf",
    "finger_edu": "example-robot-data/example-robot-data/robots/finger_edu_description/robots/finger_edu.urdf",
}

SHAPES = {
    "cube": '<box size="0.06 0.06 0.06"/>',
    "cylinder": '<cylinder radius="0.02" length="0.08"/>',
    "sphere": '<sphere radius="0.03"/>',
    "small": '<box size="0.03 0.03 0.03"/>',
    "flat": '<box size="0.06 0.04 0.012"/>',
    "huge": '<box size="60 60 60"/>',
    "large": '<box size="0.15 0.15 0.15"/>',
}


@cache
def model_of(file: Path) -> HandModel:
    return load_hand(read_hand(file))


def public_hand(name: str) -> HandModel:
    file = SHARED / PUBLIC[name]
    if not file.is_file():
        pytest.skip(f"{file.name} does not lie beside the repository")
    return model_of(file)


@cache
def _folder() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="grasped_parts_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def primitive(name: str) -> tuple[Part, PartGeometry]:
    """A primitive part at the origin; made once, since balls have many triangles."""
    file = _folder() / f"{name}.urdf"
    link = f'<link name="part"><collision><geometry>{SHAPES[name]}</geometry></collision></link>'
    file.write_text(f'<robot name="{name}">{link}</robot>')
    part = Part(name, "urdf", file, None, 1.0, Pose.identity(3))
    return part, load_part(part)


def at(*xyz: float, rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Pose:
    return Pose.from_xyz_rpy(np.array(xyz), np.array(rpy))

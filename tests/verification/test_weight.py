"""The part's weight: from the layout, from its file, or not known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design import read_layout, verify
from fixture_design.layout import Answer, Layout
from fixture_design.verification import contacts_of
from fixture_design.verification.weight import Weight, weight_of
from tests.geometry.parts import box, part, write

BRACKET = Path(__file__).resolve().parents[2] / "urdf" / "bracket" / "bracket.layout.yaml"


def test_a_urdf_file_knows_it() -> None:
    layout = read_layout(BRACKET)
    weight = weight_of(layout, contacts_of(layout).geometry)
    assert isinstance(weight, Weight)
    np.testing.assert_allclose(weight.force, [0, 0, -9.81 * 0.103605085])
    x, y, _ = weight.center
    np.testing.assert_allclose(weight.wrench[3:], [y * weight.force[2], -x * weight.force[2], 0])


def with_mesh(folder: Path, mass: float | None) -> Layout:
    made = replace(part(write(folder, box(0.06, 0.04, 0.02))), mass=mass)
    layout = read_layout(BRACKET)
    lower = [replace(e, at=e.at - [0.03, 0.02, 0.01]) for e in layout.elements if e.name in ("L1", "L2", "L3")]
    return replace(layout, part=made, elements=tuple(lower), require={"locators": ("holds_loads",)})


def test_a_mesh_with_a_mass_has_the_centre_of_its_shape(tmp_path: Path) -> None:
    verdict = verify(with_mesh(tmp_path, 1.0))
    assert verdict.groups["locators"].findings["holds_loads"].answer is Answer.YES
    assert any("no `center`" in note for note in verdict.notes)


def test_a_mesh_alone_does_not(tmp_path: Path) -> None:
    finding = verify(with_mesh(tmp_path, None)).groups["locators"].findings["holds_loads"]
    assert finding.answer is Answer.UNDECIDED
    assert "how heavy" in (finding.reason or "")


@pytest.mark.parametrize("gravity", [None, np.zeros(3)])
def test_without_gravity_there_is_none(gravity: np.ndarray | None) -> None:
    layout = replace(read_layout(BRACKET), gravity=gravity)
    weight = weight_of(layout, contacts_of(layout).geometry)
    assert isinstance(weight, Weight)
    assert not weight.wrench.any()

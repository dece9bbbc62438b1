"""Round surfaces count from the first where a task says so: a clamp in a bore stops what two on flats do."""

from __future__ import annotations

from pathlib import Path

import pytest
import shapely
import trimesh

from fixture_design.design import design
from fixture_design.errors import FileFormatError
from fixture_design.io import read_task
from tests.design.test_parts import counts


@pytest.mark.parametrize(("round_too", "clamps"), [(False, 3), (True, 2)])
def test_a_block_with_a_bore(tmp_path: Path, round_too: bool, clamps: int) -> None:
    area = shapely.box(0, 0, 60, 40).difference(shapely.Point(20, 20).buffer(9, quad_segs=24))
    trimesh.creation.extrude_polygon(area, 20).export(tmp_path / "block.stl")
    task = tmp_path / "block.task.yaml"
    task.write_text(
        "schema: fixture_design/task/1\npart: {mesh: block.stl, scale: 0.001}\n"
        f"candidates: {{round: {str(round_too).lower()}}}\n"
    )
    result = design(read_task(task))
    assert counts(result) == (6, clamps)
    assert result.bound is not None
    assert result.bound.proven
    assert any("`candidates: {round: true}`" in note for note in result.notes) != round_too


def test_the_key_is_read_as_a_truth_value(tmp_path: Path) -> None:
    task = tmp_path / "a.task.yaml"
    task.write_text("schema: fixture_design/task/1\npart: {mesh: block.stl}\ncandidates: {round: yes please}\n")
    with pytest.raises(FileFormatError, match=r"candidates\.round"):
        read_task(task)

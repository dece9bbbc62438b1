"""Straight ways out: all of them are found, and they are ways out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.design.straight import cells, different


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 9),
    p=st.sampled_from([2, 3]),
    degenerate=st.booleans(),
    tilt=st.sampled_from([0.0, 3e-4, 1e-3, 1e-2]),
    asked=st.booleans(),
)
def test_no_direction_leaves_more_than_some_cell(
    seed: int, count: int, p: int, degenerate: bool, tilt: float, asked: bool
) -> None:
    """Some normals are nearly along or square to others, where cells are thin beside wide ones."""
    rng = np.random.default_rng(seed)
    drawn = rng.integers(-1, 2, (count, p)).astype(float) if degenerate else rng.normal(size=(count, p))
    drawn = drawn[drawn.any(axis=1)]
    if not len(drawn):
        return
    tilted = rng.random(len(drawn)) < 0.4
    normals, _ = different(unit(unit(drawn) + tilt * tilted[:, None] * rng.normal(size=drawn.shape)))
    out = np.eye(p)[rng.integers(p)] if asked else None
    found, complete = cells(normals, out)
    assert complete
    for cell in found:
        assert (normals[cell.leaves] @ cell.direction < 0).all()
    around = unit(rng.normal(size=(400, p)) * (1 if out is None else 0.02) + (0 if out is None else out))
    for direction in around:
        leaves = normals @ direction < (-1e-2 if out is None else -5e-3)
        if out is not None:  # beside the way that is asked for
            leaves &= normals @ out <= 0
        assert any((leaves <= cell.leaves).all() for cell in found) or not leaves.any()


def test_a_face_nearly_square_to_the_way_out_hides_no_cell() -> None:
    chamfers = unit(np.array([[-1.0, 1, 1], [1, 1, 0]]))
    square = np.vstack([np.eye(3), -np.eye(3), chamfers])
    nearly = np.vstack([square, [0, np.cos(3e-4), np.sin(3e-4)]])
    up = np.array([0.0, 0, 1])
    assert [int(cell.leaves.sum()) for cell in cells(square, up)[0]] == [4, 4, 4, 3]
    assert [int(cell.leaves[:-1].sum()) for cell in cells(nearly, up)[0]] == [4, 4, 4, 3]


def test_a_box_has_eight_and_four_of_them_touch_the_way_up() -> None:
    normals = np.vstack([np.eye(3), -np.eye(3)])
    assert len(cells(normals)[0]) == 8
    up = cells(normals, np.array([0.0, 0, 1]))[0]
    assert len(up) == 4
    for cell in up:
        assert (normals[cell.leaves] @ [0, 0, 1] <= 0).all()


def test_normals_in_the_way_of_the_direction_are_not_left() -> None:
    normals = unit(np.array([[0.0, 0, 1], [1, 0, 1], [1, 0, 0], [0, 0, -1]]))
    for cell in cells(normals, np.array([0.0, 0, 1]))[0]:
        assert not cell.leaves[:2].any()


def test_many_normals_are_only_tried() -> None:
    normals = unit(np.random.default_rng(0).normal(size=(50, 3)))
    found, complete = cells(normals)
    assert not complete
    assert all((normals[cell.leaves] @ cell.direction < 0).all() for cell in found)


def test_equal_normals_are_one() -> None:
    kept, which = different(np.array([[0.0, 0, 1], [0, 1, 0], [0, 0, 1]]))
    assert len(kept) == 2
    assert which.tolist() == [0, 1, 0]
    assert kept[which[2]].tolist() == pytest.approx([0, 0, 1])

"""Which assemblies have round surfaces, and whether these form contact pairs: a turned body among drilled blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fixture_design.assembly.assembly import Assembly, AssemblyBody
from fixture_design.assembly.body_parts import part_of
from fixture_design.assembly.drilled_block import DrilledBlock, drilled_block
from fixture_design.assembly.polyhedron import MOST_STRIPS, strips
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.turned_body import TurnedBody, turned_body
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry

#: A surface of fewer facets than this is a prism's rather than a cylinder's: 15 degrees from strip to strip.
FEWEST_AROUND = 24


def round_bodies(assembly: Assembly) -> tuple[TurnedBody, tuple[DrilledBlock, ...]] | None:
    """The moving body and the fixed ones by their round surfaces; None where there are none, or not for sure.

    Bodies that are no turned body and no blocks are taken by their plane facets, if these are not too many.

    Raises:
        UnsupportedError: they are too many.
    """
    bodies = [assembly.moving, *assembly.fixed]
    parts = [None if body.box is not None else part_of(body) for body in bodies]
    if not any(part is not None and is_round(part) for part in parts):
        return None
    found = [_recognised(body, part, k == 0) for k, (body, part) in enumerate(zip(bodies, parts, strict=True))]
    reasons = [(part, word) for part, word in zip(parts, found, strict=True) if isinstance(word, str)]
    if reasons:
        if all(part is None or strips(part) <= MOST_STRIPS for part in parts):
            return None
        raise _refused([part for part in parts if part is not None and is_round(part)], reasons)
    moving, *fixed = found
    assert isinstance(moving, TurnedBody)
    return moving, tuple(block for block in fixed if isinstance(block, DrilledBlock))


def is_round(part: PartGeometry) -> bool:
    """Whether some surface is round for sure: of so many facets that no prism is meant."""
    return any(len(surface.facets) >= FEWEST_AROUND for surface in part.smooth_surfaces)


def _recognised(body: AssemblyBody, part: PartGeometry | None, moves: bool) -> TurnedBody | DrilledBlock | str:
    pose = body.pose or Pose.identity(3)
    if part is None:
        assert body.box is not None
        if moves:
            return "the moving body is a box"
        points = (np.array(list(np.ndindex(2, 2, 2)), dtype=np.float64) - 0.5) * body.box
        return DrilledBlock.solid(Polytope.hull_of(pose.points(points)))
    if moves and not is_round(part):
        return "the moving body is not round"
    return turned_body(part, pose) if moves else drilled_block(part, pose)


def _refused(rounds: list[PartGeometry], reasons: list[tuple[PartGeometry | None, str]]) -> UnsupportedError:
    names = "; ".join(f"{part.name!r} has round surfaces ({_names(part)})" for part in rounds)
    why = "; ".join(f"{part.name!r}: {reason}" if part is not None else reason for part, reason in reasons)
    return UnsupportedError(
        f"{names}, which form no contact pairs here",
        found=why,
        expected="a moving convex solid of revolution of cylinders and cones, and fixed convex blocks with cylindrical "
        f"holes; or at most {MOST_STRIPS} facets that stand for round surfaces, which are then taken as plane ones",
    )


def _names(part: PartGeometry) -> str:
    return ", ".join(surface.name for surface in part.smooth_surfaces)

"""Candidates from spots on the surface: what a tip touches there.

A tip that touches in a point has one row, wherever the surface is smooth. A pad or a line has a row for each corner of
where it lies on its face, as the verdict will find it, and no place where it would not lie flat or would cut the part.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.arrays import Point, cross_products, read_only
from fixture_design.design.candidates import Candidates, Make, Spots
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.errors import GeometryError
from fixture_design.layout import Element, LineTip, PadTip, Tip
from fixture_design.tolerances import ALONG_NORMAL


def candidates_of(task: Task, ways: Ways, spots: Spots) -> tuple[Candidates, tuple[str, ...]]:
    """A candidate for each spot and tip, and notes of how many there could not be.

    Raises:
        GeometryError: no tip has any place.
    """
    found: Candidates | None = None
    notes: list[str] = []
    for tip in (task.candidates.tip, *task.candidates.more_tips):
        some = _with_tip(task, ways, spots, tip)
        count = 0 if some is None else len(some)
        if count < len(spots.points):
            kind = type(tip).__name__.removesuffix("Tip").lower()
            notes.append(f"{len(spots.points) - count} candidates were left out: no {kind} lies flat there")
        if some is not None:
            found = some if found is None else found.and_also(some)
    if found is None:
        raise GeometryError(f"no tip lies flat on any of {len(spots.points)} candidates", expected="smaller tips")
    return found, tuple(notes)


def _with_tip(task: Task, ways: Ways, spots: Spots, tip: Tip) -> Candidates | None:
    if not isinstance(tip, PadTip | LineTip):
        return Candidates.of(spots, ways.scale(), task.friction, Make(tip))
    elements = [
        Element("candidate", "locator", read_only(point), _turned(tip, normal))
        for point, normal in zip(spots.points, spots.normals, strict=True)
    ]
    contacts = ways.touching(elements)
    found = [(element, own) for element, own in zip(elements, contacts, strict=True) if own]
    return Candidates.touching(found, ways.scale(), task.friction) if found else None


def _turned(tip: PadTip | LineTip, normal: Point) -> PadTip | LineTip:
    """The tip; on a face square to its direction it has that of the next axis, so that it lies in the face too."""
    along = np.asarray(tip.along, dtype=np.float64)
    if len(along) == 2 or np.linalg.norm(cross_products(along, normal)) > ALONG_NORMAL * np.linalg.norm(along):
        return tip
    return replace(tip, along=read_only(np.roll(along, 1)))

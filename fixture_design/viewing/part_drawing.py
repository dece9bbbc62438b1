"""What the sheet needs of the part beside the verdict: its edges in W, its weight in words, the files it comes from."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version

import numpy as np

from fixture_design.arrays import Ends
from fixture_design.contacts import Scale
from fixture_design.geometry import PartGeometry, Polygon, load_geometry, sharp_edges
from fixture_design.geometry.input_files import InputFile, input_files
from fixture_design.layout import Layout
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.weight import weight_of


@dataclass(frozen=True, eq=False)
class PartDrawing:
    """``segments``: shape (e, 2, p) in W [m], None without a part; ``weight``: a sentence; ``drake``: its version."""

    segments: Ends | None
    weight: str
    files: tuple[InputFile, ...]
    drake: str


def drawing_of(layout: Layout) -> PartDrawing:
    """Reads the part once more: a verdict does not hold its geometry.

    Raises:
        InputError: the part or a file of the layout cannot be read.
    """
    geometry = None if layout.part is None else load_geometry(layout.part)
    return PartDrawing(edges_of(layout, geometry), _weight(layout, geometry), input_files(layout), version("drake"))


def edges_of(layout: Layout, geometry: PartGeometry | Polygon | None) -> Ends | None:
    """The edges that are drawn of a layout's part, in W, shape (e, 2, p) [m]; None without a part."""
    if layout.part is None or geometry is None:
        return None
    if isinstance(geometry, Polygon):
        ends = np.stack([geometry.vertices, np.roll(geometry.vertices, -1, axis=0)], axis=1)
    else:
        ends = sharp_edges(geometry)
    return layout.part.pose.points(ends.reshape(-1, ends.shape[2])).reshape(ends.shape)


def _weight(layout: Layout, geometry: PartGeometry | Polygon | None) -> str:
    if layout.gravity is None:
        return "Gravity is left out."
    found = FoundContacts((), Scale(np.zeros(len(layout.gravity)), 1.0), (), geometry)
    weight = weight_of(layout, found.geometry)
    if isinstance(weight, str):
        return f"{weight[0].upper()}{weight[1:]}: it is left out."
    mass = float(np.linalg.norm(weight.force) / np.linalg.norm(layout.gravity)) if np.any(layout.gravity) else 0.0
    center = ", ".join(f"{value * 1e3:.4g}" for value in weight.center)
    assumed = "" if weight.note is None else f" ({weight.note})"
    gravity = ", ".join(f"{value:g}" for value in layout.gravity)
    return f"The part weighs {mass:.6g} kg, its centre of mass at ({center}) mm{assumed}; gravity ({gravity}) m/s^2."

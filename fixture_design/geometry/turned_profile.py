"""The profile of a turned surface: rings seen in the half plane through the axis, joined by bands.

Bands in one line are a cylinder or a cone, bands around one circle a torus or a sphere. The others are chords of a
profile that is not known: barrels, ogives and vases. Their normals lie in the half plane, so that the spin about the
axis is known to be free, but in it they are off by up to the angles at which the bands meet.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.geometry.rings import ring_errors
from fixture_design.geometry.smooth_surface import RoundShape
from fixture_design.geometry.turned_bands import Band, Rings
from fixture_design.tolerances import COPLANAR_ANGLE, SMOOTH_ANGLE, STRIP_WIDTH_RATIO

#: Rings on one circle of the half plane, at least: three bevels between two flats have four.
_FEWEST_ON_ARC = 5
#: A line is tangent to an arc if it is off by at most this part of the angle between chord and line [-].
_TANGENT = 0.2

#: A cone that widens by less than this part of its height is a cylinder [-].
_NO_SLOPE = 1e-6
#: A circle's centre may be this many tolerances beyond the axis, and is on it where this part of its radius off [-].
_BEYOND_AXIS, _ON_AXIS = 10.0, 1e-6

#: What is beyond the end of a row of bands.
Beyond = Callable[[int, int], tuple[float, float, bool] | None]
#: Places in the half plane: distance from the axis, height.
_Places = Float[np.ndarray, "n 2"]


@dataclass(frozen=True, eq=False)
class Piece:
    """Bands that are one surface.

    Attributes:
        bands: numbers of the bands.
        shape: through their rings.
        error: how far off its normals may be in the half plane, since its profile is not known [rad].
        curved: whether its profile is, known or not.
    """

    bands: list[int]
    shape: RoundShape
    error: float
    curved: bool


@dataclass(eq=False)
class _Line:
    """Rings in one line, in the order in which the material is on the left, and the bands between them."""

    rings: list[int]
    bands: list[int]


@dataclass(frozen=True, eq=False)
class _Measure:
    """The length of a line [m]; to each neighbour the angle [rad], and its length or width [m].

    Facets beyond the ends of a row have negative numbers; ``beside_strip``: one of these is a strip of a curved
    surface.
    """

    length: float
    beside: Mapping[int, tuple[float, float]]
    beside_strip: bool


def pieces_of(rings: Rings, bands: list[Band], tolerance: float, beyond: Beyond) -> list[Piece]:
    """The surfaces that the bands about an axis stand for.

    Args:
        tolerance: how far a ring may be off a line or circle [m].
        beyond: of a ring at the end of a row of bands and the last of these, the angle [rad] at which a facet beyond it
            meets the band smoothly, its width [m], and whether it is a strip; None if there is no such facet.
    """
    places = np.column_stack([rings.reach, rings.height])
    found = []
    for lines, closed in _chains(bands, places, tolerance):
        count = len(lines)
        curved = _errors(_measures(lines, closed, places, set(), beyond))
        arcs = _arcs(lines, [index in curved for index in range(count)], closed, places, tolerance)
        tangent: set[tuple[int, int]] = set()
        for members, center, _ in arcs:
            shape = _arc_shape(rings, center, places[lines[members[0]].rings[0]])
            found.append(Piece([band for member in members for band in lines[member].bands], shape, 0.0, True))
            tangent |= _tangents(lines, members, center, closed, places)
        taken = {member for members, _, _ in arcs for member in members}
        errors = _errors(_measures(lines, closed, places, tangent, beyond))
        for index, line in enumerate(lines):
            if index not in taken:
                shape = _line_shape(rings, places[line.rings[0]], places[line.rings[-1]], tolerance)
                found.append(Piece(line.bands, shape, errors.get(index, 0.0), index in errors))
    return found


def _errors(measures: Sequence[_Measure]) -> dict[int, float]:
    """The lines that are chords of a curved profile, and how far off their normals may be [rad].

    As with facets (`smoothness`), these meet two others smoothly and are not much longer than one of them; and so does
    one of these two, since a chamfer alone has smooth neighbours too.
    """
    smooth = [{o for o, (angle, _) in line.beside.items() if abs(angle) < SMOOTH_ANGLE} for line in measures]
    narrow = [
        bool(smooth[i]) and line.length <= STRIP_WIDTH_RATIO * max(line.beside[o][1] for o in smooth[i])
        for i, line in enumerate(measures)
    ]
    inner = {i for i in range(len(measures)) if len(smooth[i]) == 2 and narrow[i]}
    chords = {i for i in inner if inner & smooth[i] or measures[i].beside_strip}
    ends = {i for i in range(len(measures)) if len(smooth[i]) == 1 and narrow[i] and chords & smooth[i]}
    found = {i: max(abs(measures[i].beside[o][0]) for o in smooth[i]) for i in chords | ends}
    angles = [{o: angle for o, (angle, _) in line.beside.items() if o >= 0} for line in measures]
    coarse = ring_errors(angles, [line.length for line in measures])
    return found | {i: max(error, found.get(i, 0.0)) for i, error in coarse.items()}


def _chains(bands: list[Band], places: _Places, tolerance: float) -> list[tuple[list[_Line], bool]]:
    """Bands in a row, those in one line joined; and whether the row is closed. Where several meet in a ring it ends."""
    edges: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, band in enumerate(bands):
        edges[band.ends].append(number)
    leaving, arriving = defaultdict(list), defaultdict(list)
    for one, other in edges:
        leaving[one].append((one, other))
        arriving[other].append((one, other))

    def linked(ring: int) -> bool:
        return len(leaving[ring]) == 1 and len(arriving[ring]) == 1

    starts = [edge for edge in sorted(edges) if not linked(edge[0])]
    left = set(edges)
    found = []
    for start in [*starts, *sorted(edges)]:
        if start not in left:
            continue
        row, edge = [], start
        while edge in left:
            left.discard(edge)
            row.append(edge)
            if not linked(edge[1]):
                break
            edge = leaving[edge[1]][0]
        closed = row[-1][1] == row[0][0] and linked(row[0][0])
        lines = [_Line(list(edge), list(edges[edge])) for edge in row]
        if closed:
            # begin at a corner, so that no line is cut in two
            corner = next((i for i in range(len(lines)) if not _in_line(lines[i - 1], lines[i], places, tolerance)), 0)
            lines = lines[corner:] + lines[:corner]
        joined = [lines[0]]
        for line in lines[1:]:
            if _in_line(joined[-1], line, places, tolerance):
                joined[-1] = _Line(joined[-1].rings + line.rings[1:], joined[-1].bands + line.bands)
            else:
                joined.append(line)
        found.append((joined, closed and len(joined) > 1))
    return found


def _in_line(one: _Line, other: _Line, places: _Places, tolerance: float) -> bool:
    first, last = places[one.rings[0]], places[other.rings[-1]]
    along = last - first
    length = float(np.hypot(*along))
    if not length or abs(_turn(one, other, places)) > COPLANAR_ANGLE + 4 * tolerance * (
        1 / _length(one, places) + 1 / _length(other, places)
    ):
        return False
    away = places[one.rings + other.rings] - first
    return bool(np.abs(away[:, 0] * along[1] - away[:, 1] * along[0]).max() <= 2 * tolerance * length)


def _length(line: _Line, places: _Places) -> float:
    return float(np.hypot(*(places[line.rings[-1]] - places[line.rings[0]])))


def _turn(one: _Line, other: _Line, places: _Places) -> float:
    """The angle from one line to the next, positive on convex edges [rad]."""
    (ux, uy), (vx, vy) = (places[line.rings[-1]] - places[line.rings[0]] for line in (one, other))
    return float(np.arctan2(ux * vy - uy * vx, ux * vx + uy * vy))


def _measures(
    lines: list[_Line], closed: bool, places: _Places, tangent: set[tuple[int, int]], beyond: Beyond
) -> list[_Measure]:
    """Lines among their neighbours, but for those that they are tangent to."""
    count = len(lines)
    found = []
    for index, line in enumerate(lines):
        beside, strip = {}, False
        for step, ring, band in ((-1, line.rings[0], line.bands[0]), (1, line.rings[-1], line.bands[-1])):
            other = (index + step) % count if closed else index + step
            if 0 <= other < count:
                if other != index and (index, other) not in tangent:
                    pair = (lines[other], line) if step < 0 else (line, lines[other])
                    beside[other] = (_turn(*pair, places), _length(lines[other], places))
            elif (facet := beyond(ring, band)) is not None:
                beside[-1 if step < 0 else -2] = facet[:2]
                strip |= facet[2]
        found.append(_Measure(_length(line, places), beside, strip))
    return found


def _arcs(
    lines: list[_Line], curved: list[bool], closed: bool, places: _Places, tolerance: float
) -> list[tuple[list[int], Float[np.ndarray, 2], float]]:
    """Rows of curved lines whose rings are on one circle, the longest that there are."""
    count = len(lines)
    order = list(range(count)) * (2 if closed and all(curved) else 1)
    found, place = [], 0
    if closed and not all(curved):
        first = curved.index(False)
        order = list(range(first, count)) + list(range(first))
    taken: set[int] = set()
    while place < len(order):
        best = None
        for end in range(place + _FEWEST_ON_ARC - 1, min(len(order), place + count) + 1):
            members = order[place:end]
            if not all(curved[member] and member not in taken for member in members):
                break
            fit = _circle(
                places[[lines[members[0]].rings[0], *(r for m in members for r in lines[m].rings[1:])]], tolerance
            )
            if fit is None:
                break
            best = (members, *fit)
        if best is None:
            place += 1
        else:
            found.append(best)
            taken |= set(best[0])
            place += len(best[0])
    return found


def _circle(places: _Places, tolerance: float) -> tuple[Float[np.ndarray, 2], float] | None:
    """Centre and radius of the circle through places in the half plane; its centre on the axis or clear of it."""
    middle = places.mean(axis=0)
    rows = np.column_stack([2 * (places - middle), np.ones(len(places))])
    solution = np.linalg.lstsq(rows, np.sum((places - middle) ** 2, axis=1), rcond=None)[0]
    center = solution[:2] + middle
    reach = np.hypot(*(places - center).T)
    if np.ptp(reach) > 2 * tolerance or center[0] < -_BEYOND_AXIS * tolerance:
        return None
    if places[:, 0].min() == 0 and abs(center[0]) > _BEYOND_AXIS * tolerance:
        return None
    return center, float(reach.mean())


def _tangents(
    lines: list[_Line], members: list[int], center: Float[np.ndarray, 2], closed: bool, places: _Places
) -> set[tuple[int, int]]:
    """Pairs of a line and the end of an arc that it is tangent to."""
    count, found = len(lines), set()
    for member, beside, ring in (
        (members[0], members[0] - 1, lines[members[0]].rings[0]),
        (members[-1], members[-1] + 1, lines[members[-1]].rings[-1]),
    ):
        other = beside % count if closed else beside
        if not 0 <= other < count or other in members:
            continue
        along, radial = places[lines[other].rings[-1]] - places[lines[other].rings[0]], places[ring] - center
        off = abs(float(along @ radial)) / float(np.hypot(*along) * np.hypot(*radial))
        pair = (lines[other], lines[member]) if other < member else (lines[member], lines[other])
        turn = abs(_turn(*pair, places))
        if turn < SMOOTH_ANGLE and off <= _TANGENT * turn:
            found.add((other, member))
    return found


def _arc_shape(rings: Rings, center: Float[np.ndarray, 2], place: Float[np.ndarray, 2]) -> RoundShape:
    axis, radius = rings.axis, float(np.hypot(*(place - center)))
    point = axis.point + center[1] * axis.direction
    # where rings are as good as on a ball they are on one
    if center[0] <= _ON_AXIS * radius:
        return RoundShape("sphere", point, axis.direction, radius)
    return RoundShape("torus", point, axis.direction, radius, float(center[0]))


def _line_shape(rings: Rings, first: Float[np.ndarray, 2], last: Float[np.ndarray, 2], tolerance: float) -> RoundShape:
    """The cylinder or cone through two rings; a plane across the axis is a cone with a right angle."""
    axis, (out, rise) = rings.axis, (last - first).tolist()
    if abs(out) <= min(max(_NO_SLOPE * abs(rise), 2 * tolerance), abs(rise)):
        return RoundShape("cylinder", axis.point, axis.direction, float(first[0] + last[0]) / 2)
    apex = axis.point + (first[1] - first[0] * rise / out) * axis.direction
    sense = 1.0 if out * rise >= 0 else -1.0
    return RoundShape("cone", apex, sense * axis.direction, float(np.arctan2(abs(out), abs(rise))))

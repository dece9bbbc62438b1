"""The measurement set S_i of a state: a union of polyhedral convex cones, and by how much it is widened (4-10), (4-37).

The convex sum of neighbours lies neither inside nor outside the union over the configurations between, since span
vectors curve in q ((4-33), (4-35) hold to first order only). So a set states how far out of it the sets of denser
samples are, and is widened by that: s is accepted if a . s <= bound |s| for all unit face vectors a of one cone. The
widened set holds every vector of the cones, turned by an angle with sine up to the bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Vector
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, convert_both
from fixture_design.recognition.merging import merged
from fixture_design.recognition.sample_cones import SampleCones
from fixture_design.recognition.signals import Signals
from fixture_design.tolerances import DEFAULT

#: Samples alone; those between neighbours too; one cone for all of them (as Table 6 has it).
Interpolation = Literal["none", "neighbours", "hull"]


#: Digits to which face vectors of equal cones agree.
_DIGITS = 9


@dataclass(frozen=True)
class Widening:
    """By how much a set is widened: sines of angles [-].

    Attributes:
        force, displacement: bounds of the two blocks from denser samples.
    """

    force: float = 0.0
    displacement: float = 0.0


@dataclass(frozen=True, eq=False)
class MeasurementSet:
    """S_i, in the coordinates of signals.

    Attributes:
        cones: in face form, unit face vectors; equalities may be kept apart.  widening: see the module.
    """

    cones: ConeUnion
    widening: Widening = Widening()

    def __len__(self) -> int:
        return len(self.cones)

    def contains(self, signal: ArrayLike, noise: float = 0.0) -> bool:
        """Whether a signal, unit or with unit blocks, is in the set, widened. `Classifier` asks many sets at once."""
        return self.outside(np.asarray(signal, dtype=np.float64)) <= max(self._bounds()) + noise + DEFAULT.tie

    def outside(self, signal: Vector) -> float:
        """The least over the cones of the largest a . s: how far outside a signal is; negative inside."""
        return min(float((oriented_rows(cone) @ signal).max(initial=-1.0)) for cone in self.cones)

    def widened(self, widening: Widening) -> MeasurementSet:
        return replace(self, widening=widening)

    def _bounds(self) -> tuple[float, float]:
        return self.widening.force, self.widening.displacement


def oriented_rows(cone: PolyhedralConvexCone) -> Rows:
    """Face vectors a with a . s <= 0 for all s of the cone, each equality as two of them."""
    return np.vstack([cone.faces, cone.equalities, -cone.equalities])


def measurement_set(
    samples: SampleCones, groups: Sequence[Sequence[int]], signals: Signals, *, simplify: bool = True
) -> MeasurementSet:
    """S_i of groups of neighbouring samples: the convex sum of the F(q) of each group (4-37), simplified (4.6.2).

    Displacement sets are not summed: the sum of two half-spaces is the whole space. They are the union over samples
    (4-11), and, measured together with forces, the products of a group's force set with the A(q) of its samples.

    Args:
        groups: indices of samples; (k,) alone is the set of one sample.  simplify: whether to merge by Theorem 10.
    """
    if signals.measure == "displacement":
        chosen = sorted({k for group in groups for k in group})
        return _union([_from_faces(faces) for k in chosen for faces in samples.displacements[k]], simplify)
    forces = [force_cone([samples.forces[k] for k in group], signals.force_size) for group in groups]
    if signals.measure == "force":
        return _union(forces, simplify)
    known = [tuple(_from_faces(faces) for faces in alternatives) for alternatives in samples.displacements]
    pairs = [_product(force, known[k][n]) for force, group in zip(forces, groups, strict=True)
             for k in group for n in range(len(known[k]))]  # fmt: skip
    return _union(_distinct(pairs), False)


def _union(cones: Sequence[PolyhedralConvexCone], simplify: bool) -> MeasurementSet:
    return MeasurementSet(ConeUnion.of(merged(cones) if simplify else cones))


def _distinct(cones: Sequence[PolyhedralConvexCone]) -> list[PolyhedralConvexCone]:
    """Each cone once, by its digits; Theorem 10 seldom finds anything in products, and takes long."""
    return list({np.round(oriented_rows(cone), _DIGITS).tobytes(): cone for cone in cones}.values())


def force_cone(spans: Sequence[Rows], dimension: int) -> PolyhedralConvexCone:
    """The convex sum of cones by their span vectors, both forms irreducible."""
    return convert_both(PolyhedralConvexCone.from_span(np.vstack(spans), dimension=dimension))


def _from_faces(faces: Rows) -> PolyhedralConvexCone:
    return convert_both(PolyhedralConvexCone.from_faces(faces, dimension=faces.shape[1]))


def _product(force: PolyhedralConvexCone, displacement: PolyhedralConvexCone) -> PolyhedralConvexCone:
    """{[p; dq] : p in F, dq in A}: in both forms the vectors of either block, with zeros in the other."""
    n, m = force.dimension, displacement.dimension
    left = [np.pad(rows, ((0, 0), (0, m))) for rows in (force.faces, force.equalities, force.spans, force.lines)]
    right = [
        np.pad(rows, ((0, 0), (n, 0)))
        for rows in (displacement.faces, displacement.equalities, displacement.spans, displacement.lines)
    ]
    faces, equalities, spans, lines = (np.vstack(pair) for pair in zip(left, right, strict=True))
    as_faces = PolyhedralConvexCone.from_faces(faces, equalities, dimension=n + m)
    return replace(as_faces, span_form=PolyhedralConvexCone.from_span(spans, lines, dimension=n + m).span_form)

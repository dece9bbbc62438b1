"""What the method asks of the geometry of two parts, in the plane or in space: a Protocol that either fills.

Everything is asked of many configurations at once. d is 3 in the plane and 6 in space, a configuration has c = 3 or 7
numbers, P is the number of contact pairs.
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from fixture_design.arrays import Mask, Vector
from fixture_design.assembly.contact_rows import ContactRows
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.errors import AssemblyError, UnsupportedError

#: More contact pairs than this are refused: the search would take hours.
MOST_PAIRS = 4000


def refuse_too_many(pairs: int) -> None:
    """Raises UnsupportedError where the search would not end in any useful time."""
    if pairs > MOST_PAIRS:
        raise UnsupportedError(f"{pairs} contact pairs are too many", expected=f"at most {MOST_PAIRS}: simpler bodies")


@runtime_checkable
class ContactGeometry(Protocol):
    """Contact pairs of two parts, their distance functions, and which configurations are admissible.

    Attributes:
        names: of the pairs, "apex 3 - facet 5", the moving part's feature first.
        takes_part: shape (P,): whether both features are among those that states are made of.
        dimension: d.
        size: largest extent of what may meet [m]; tolerances are relative to it.
        radius: what an angle is multiplied with to compare it to lengths [m].
        free: shape (d,), displacements that the region's rotation leaves.
    """

    @property
    def dimension(self) -> int: ...

    @property
    def size(self) -> float: ...

    @property
    def radius(self) -> float: ...

    @property
    def free(self) -> Mask: ...

    @property
    def names(self) -> tuple[str, ...]: ...

    @property
    def takes_part(self) -> Mask: ...

    @property
    def turns(self) -> slice:
        """The components of a displacement that are angles."""
        ...

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        """Contact equations of chosen pairs; q of shape (n, c), chosen of shape (n, m) or (1, m)."""
        ...

    def solving(self, q: np.ndarray, chosen: np.ndarray, *, ends: bool = True) -> PairEquations:
        """As `equations`, to move configurations to where all chosen pairs touch; P more is a pair at its end.

        Without ``ends`` only those that are `firm` are wanted; others may be left out.
        """
        ...

    @property
    def ending(self) -> Mask:
        """Shape (P,): pairs that may be chosen at their ends, because other pairs tell these places badly."""
        ...

    def distances(self, q: np.ndarray) -> np.ndarray:
        """H of all pairs, shape (n, P) [m]."""
        ...

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the contact points of chosen pairs, fixed axes, (n, m, 2 or 3) [m]."""
        ...

    def rotations(self, q: np.ndarray) -> np.ndarray:
        """Rotation matrices from the moving body's axes to fixed ones, shape (n, 2, 2) or (n, 3, 3)."""
        ...

    def reach(self, q: np.ndarray) -> np.ndarray:
        """Levers (n, P): turning by an angle changes a pair's distance by at most lever times angle [m]."""
        ...

    def at_apices(self, q: np.ndarray, distance: float) -> np.ndarray:
        """Which pairs have the apex within ``distance`` of the facet's rim, shape (n, P)."""
        ...

    def coincident(self, q: np.ndarray, distance: float) -> np.ndarray:
        """Where a convex apex of one part lies within ``distance`` of one of the other part, shape (n,)."""
        ...

    def overlap(self, q: np.ndarray) -> np.ndarray:
        """How deep the parts overlap [m], shape (n,); not positive where they do not."""
        ...

    def moved(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Configurations after displacements (n, d): the origin by dx, turned by dtheta about it, fixed axes."""
        ...

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """The displacements (n, d) that move ``start`` to ``end``."""
        ...

    def aligned(self, q: np.ndarray) -> np.ndarray:
        """Configurations turned so that a facet of one part is parallel to one of the other, all for each of q."""
        ...

    def canonical(self, q: np.ndarray) -> np.ndarray:
        """The same configurations with their angles in the usual range."""
        ...

    def random(self, rng: np.random.Generator, count: int) -> np.ndarray:
        """Configurations (count, c) spread evenly over the region."""
        ...

    def inside(self, q: np.ndarray) -> Mask:
        """Which configurations are in the region."""
        ...

    def rows(self, q: np.ndarray, pairs: np.ndarray, vectors: np.ndarray, at_end: np.ndarray) -> ContactRows:
        """Face vectors of the pairs that touch at one configuration (c,): theirs, or those of several points."""
        ...

    def possible_together(self) -> np.ndarray:
        """(3-20): whether two pairs may both touch at once, by the distances between their features, (P, P)."""
        ...


def weights(geometry: ContactGeometry) -> Vector:
    """What makes the components of a displacement lengths, shape (d,): 1 and the radius."""
    values = np.ones(geometry.dimension)
    values[geometry.turns] = geometry.radius
    return values


def require_no_overlap(geometry: ContactGeometry, q: np.ndarray, near: float) -> None:
    """Nothing, where the parts overlap by no more than ``near`` at a configuration, shape (1, c).

    Raises:
        AssemblyError: they do.
    """
    if geometry.overlap(q)[0] > near:
        raise AssemblyError("the parts overlap at this configuration", found=f"{q[0].tolist()}")

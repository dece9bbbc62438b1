"""The contact equations H_jk(q) = 0 of (3-6), for many configurations and pairs at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class PairEquations:
    """Contact equations of m pairs at n configurations, each as k numbers that are zero where the pair touches.

    The first is the gap to the line or plane of the facet, positive outside the material; the others tell how far
    beyond the facet's ends the apex is, zero between them. H = |values| (3-30).

    Attributes:
        values: shape (n, m, k) [m].
        gradients: shape (n, m, k, d), with respect to displacements about the moving body's origin, fixed axes.
        firm: those of the k that hold wherever a contact is held: the gap, and what keeps a disk along a plane.
    """

    values: Float[np.ndarray, "n m k"]
    gradients: Float[np.ndarray, "n m k d"]
    firm: tuple[int, ...] = (0,)

    @property
    def distances(self) -> np.ndarray:
        """H, shape (n, m) [m]."""
        return np.linalg.norm(self.values, axis=-1)

    @property
    def face_vectors(self) -> np.ndarray:
        """d_jk of (3-34) and (3-35), shape (n, m, d): a displacement is admissible if d . dq <= 0."""
        return -self.gradients[:, :, 0]

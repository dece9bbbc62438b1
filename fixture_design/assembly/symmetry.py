"""Symmetries of an assembly: pairs of rigid motions that map both sides and the region of configurations to themselves.

Let A map the moving body to itself and g: x -> B x + b the fixed ones, both rotations or both mirrored. Then the
configuration (R, p) becomes (B R A^T, B p + b), and what touched before touches again, by other names: states and
transitions come in orbits, and one of each is enough to be found.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Mask, Points
from fixture_design.assembly import rotations
from fixture_design.assembly.sorting import Sorted

#: Seed of the numbers by which one of each orbit is chosen: any would do.
_SEED = 20


@dataclass(frozen=True, eq=False)
class Symmetries:
    """A group of symmetries, the identity first.

    Attributes:
        pairs: shape (g, P): where each takes each contact pair.
        before, after: shape (g, 4): quaternions of A^T and B, of their negatives where both are mirrored.
        matrices: B, shape (g, 3, 3).  shifts: b, shape (g, 3) [m].  mirrored: shape (g,).
    """

    pairs: Int[np.ndarray, "g P"]
    before: Float[np.ndarray, "g 4"]
    after: Float[np.ndarray, "g 4"]
    matrices: Float[np.ndarray, "g 3 3"]
    shifts: Points
    mirrored: Mask
    _keys: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        own = np.random.default_rng(_SEED).integers(-(2**62), 2**62, size=self.pairs.shape[1])
        object.__setattr__(self, "_keys", own[self.pairs])

    @classmethod
    def none(cls, count: int) -> Symmetries:
        """The identity alone, of ``count`` pairs."""
        still = np.array([[1.0, 0, 0, 0]])
        return cls(np.arange(count)[None], still, still, np.eye(3)[None], np.zeros((1, 3)), np.zeros(1, dtype=bool))

    def __len__(self) -> int:
        return len(self.pairs)

    def moved(self, elements: Indices, q: np.ndarray) -> np.ndarray:
        """Configurations (n, c), each by its element."""
        if len(self) == 1:
            return q
        position = np.einsum("nij,nj->ni", self.matrices[elements], q[:, :3]) + self.shifts[elements]
        turned = rotations.product(rotations.product(self.after[elements], q[:, 3:]), self.before[elements])
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)  # what does not turn is exactly [1, 0, 0, 0]
        return np.concatenate([position, turned], axis=1)

    def displaced(self, elements: Indices, displacements: np.ndarray) -> np.ndarray:
        """Displacements (n, d); angles are axial vectors: mirrors turn them the other way."""
        if len(self) == 1:
            return displacements
        B = self.matrices[elements]
        turn = np.where(self.mirrored[elements], -1.0, 1.0)[:, None]
        lengths, angles = displacements[:, :3, None], displacements[:, 3:, None]
        return np.concatenate([(B @ lengths)[..., 0], turn * (B @ angles)[..., 0]], axis=1)

    def permuted(self, elements: Indices, table: np.ndarray) -> np.ndarray:
        """A table (n, P) of numbers of pairs, each row by its element."""
        if len(self) == 1:
            return table
        found = np.empty_like(table)
        np.put_along_axis(found, self.pairs[elements], table, axis=1)
        return found

    def of(self, elements: Indices, found: Sorted) -> Sorted:
        """Sorted configurations, each by its element: nothing is sorted again."""
        if len(self) == 1:
            return found
        touching, distances = (self.permuted(elements, table) for table in (found.touching, found.distances))
        return Sorted(self.moved(elements, found.q), touching, distances, found.admissible, found.clear)

    def to_representatives(self, touching: np.ndarray, then: np.ndarray | None = None) -> Indices:
        """For each row of pairs that touch the element that makes the representative of its orbit of it.

        Args:
            touching: shape (n, P).
            then: shape (n, P): of several elements the one that makes the representative of this, too.

        The representative is the one with the smallest sum of random numbers, one for each pair: two that are equal are
        the same but for one chance in 2^60.
        """
        if len(self) == 1:
            return np.zeros(len(touching), dtype=int)
        sums = self.image_keys(touching)
        if then is not None:
            behind = self.image_keys(then)
            least = sums == sums.min(axis=1, keepdims=True)
            sums = np.where(least, behind, np.iinfo(np.int64).max)
        return sums.argmin(axis=1)

    def image_keys(self, touching: np.ndarray) -> np.ndarray:
        """Of patterns (n, P) the images by all elements, each as one random number: shape (n, g)."""
        return touching.astype(np.int64) @ self._keys.T

    def first_of_sets(self, sets: np.ndarray) -> Indices:
        """The first rows of which no other before is an image, of sets of pairs (s, k)."""
        least = [
            self._keys[:, sets[k : k + _SETS_TOGETHER]].sum(axis=-1).min(axis=0)
            for k in range(0, len(sets), _SETS_TOGETHER)
        ]
        return np.sort(np.unique(np.concatenate(least), return_index=True)[1])

    def orbits(self, touching: np.ndarray, then: np.ndarray | None = None) -> tuple[Indices, Indices]:
        """Rows, and elements that make all different images of each pattern (n, P), or of two together, one for each.

        The elements of each row are in order.
        """
        keys = self.image_keys(touching)
        # wrapped around: as good a random number for both together
        keys = keys if then is None else keys + _BOTH * self.image_keys(then)
        order = np.argsort(keys, axis=1, kind="stable")
        ordered = np.take_along_axis(keys, order, axis=1)
        first = np.ones(keys.shape, dtype=bool)
        first[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
        chosen = np.zeros(keys.shape, dtype=bool)
        np.put_along_axis(chosen, order, first, axis=1)
        rows, elements = np.nonzero(chosen)
        return rows, elements


#: An odd number by which the second of two numbers counts.
_BOTH = np.int64(0x5851F42D4C957F2D)

#: Sets of pairs whose images are looked at together.
_SETS_TOGETHER = 4096

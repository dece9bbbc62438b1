"""Configurations of a hand, to look up which of them fits some points of a part.

A fingertip counts as two points: where it is (of a ball its centre), and one a little further the way it looks. The
distances between all these points do not depend on where the hand is, so that the configuration whose distances are
nearest to those of the wanted points can be looked up in a tree; the pose follows by least squares (Kabsch).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, permutations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Weights, read_only
from fixture_design.grasp.hand_model import HandModel
from fixture_design.layout import Pose

#: Random configurations looked at; a hand with one joint is looked at evenly.
CONFIGURATIONS = 3000
_EVENLY = 200

#: How far ahead of a fingertip its second point is: of pads, which must lie flat, further [m].
_AHEAD, _PAD_AHEAD = 0.01, 0.03


@dataclass(frozen=True, eq=False)
class Spots:
    """Where some fingertips are to touch, in one frame: points, outward unit normals, shape (k, 3) [m]."""

    points: Float[np.ndarray, "k 3"]
    normals: Float[np.ndarray, "k 3"]


@dataclass(frozen=True, eq=False)
class Seed:
    """A configuration and a pose from which the wanted points are nearly reached.

    Attributes:
        tips: numbers of the fingertips, in the order of the points.
        q: joint positions.  X_PH: the hand in the frame of the points.
        off: root mean square of what is missed [m].
    """

    tips: tuple[int, ...]
    q: Weights
    X_PH: Pose
    off: float


@dataclass(frozen=True, eq=False)
class Library:
    """Configurations of a hand without collisions with itself.

    Attributes:
        count: how many fingertips touch at a time.
        configurations: shape (n, j).  at, facing: of all fingertips in H, shape (n, t, 3).
    """

    model: HandModel
    count: int
    configurations: Float[np.ndarray, "n j"]
    at: Float[np.ndarray, "n t 3"]
    facing: Float[np.ndarray, "n t 3"]

    @classmethod
    def of(cls, model: HandModel, count: int, rng: np.random.Generator) -> Library:
        """The library of a hand, for grasps with ``count`` of its fingertips."""
        if len(model.free) == 1:
            low, high = model.lower[model.free], model.upper[model.free]
            drawn = np.array([model.completed(low + (high - low) * s) for s in np.linspace(0, 1, _EVENLY)])
            drawn = drawn[model.within(drawn)]
        else:
            drawn = model.random(CONFIGURATIONS, rng)
        clear = np.array([q for q in drawn if model.collides_with_itself(q) is None]).reshape(-1, len(model.joints))
        found = [model.tips(q) for q in clear]
        at = np.array([tips[0] for tips in found]).reshape(-1, len(model.fingertips), 3)
        facing = np.array([tips[1] for tips in found]).reshape(-1, len(model.fingertips), 3)
        return cls(model, count, read_only(clear), read_only(at), read_only(facing))

    @cached_property
    def widest(self) -> float:
        """The largest distance between the surfaces of two fingertips [m]."""
        tips = self.model.fingertips
        return max(
            float(np.linalg.norm(self.at[:, one] - self.at[:, other], axis=1).max(initial=0.0))
            - tips[one].radius - tips[other].radius
            for one, other in combinations(range(len(tips)), 2)
        )  # fmt: skip

    @cached_property
    def orders(self) -> list[tuple[int, ...]]:
        """Which fingertip touches which point: all choices."""
        return list(permutations(range(len(self.model.fingertips)), self.count))

    @cached_property
    def _ahead(self) -> Weights:
        return np.array([_PAD_AHEAD if tip.pad else _AHEAD for tip in self.model.fingertips])

    def _doubled(self, at: np.ndarray, facing: np.ndarray, tips: tuple[int, ...]) -> Float[np.ndarray, "n k 3"]:
        """Both points of each of these fingertips."""
        chosen, ahead = list(tips), self._ahead[list(tips)][:, None]
        return np.concatenate([at[:, chosen], at[:, chosen] + ahead * facing[:, chosen]], axis=1)

    @cached_property
    def _tree(self) -> tuple[object, np.ndarray, np.ndarray]:
        """The tree, and for each of its leaves the order and the configuration."""
        from scipy.spatial import KDTree

        keys, orders, numbers = [], [], []
        for order, tips in enumerate(self.orders):
            keys.append(_distances(self._doubled(self.at, self.facing, tips)))
            orders.append(np.full(len(self.at), order))
            numbers.append(np.arange(len(self.at)))
        return KDTree(np.concatenate(keys)), np.concatenate(orders), np.concatenate(numbers)

    def seeds(self, spots: Spots, most: int) -> list[Seed]:
        """The configurations that fit some spots best, best first."""
        tree, orders, numbers = self._tree
        found: list[Seed] = []
        # tips of different size ask for different centres, so that every order has its own wanted points
        wanted = {order: self._wanted(spots, tips) for order, tips in enumerate(self.orders)}
        key = _distances(wanted[0][None])[0]
        _, leaves = tree.query(key, k=min(most, len(numbers)))  # type: ignore[attr-defined]
        for leaf in np.atleast_1d(leaves).tolist():
            tips = self.orders[orders[leaf]]
            points = self._doubled(self.at[numbers[leaf]][None], self.facing[numbers[leaf]][None], tips)[0]
            X_PH, off = kabsch(points, wanted[int(orders[leaf])])
            found.append(Seed(tips, self.configurations[numbers[leaf]], X_PH, off))
        return sorted(found, key=lambda seed: seed.off)

    def _wanted(self, spots: Spots, tips: tuple[int, ...]) -> Float[np.ndarray, "k 3"]:
        radii = np.array([self.model.fingertips[tip].radius for tip in tips])[:, None]
        at = spots.points + radii * spots.normals
        return np.vstack([at, at - self._ahead[list(tips)][:, None] * spots.normals])


def _distances(points: Float[np.ndarray, "n k 3"]) -> Float[np.ndarray, "n d"]:
    """All distances between the k points of each set."""
    one, other = np.triu_indices(points.shape[1], 1)
    return np.linalg.norm(points[:, one] - points[:, other], axis=2)


def kabsch(points: Float[np.ndarray, "k 3"], wanted: Float[np.ndarray, "k 3"]) -> tuple[Pose, float]:
    """The pose that brings points nearest to where they are wanted, and the root mean square that is left [m].

    Source: W. Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Crystallographica A32, 1976.
    """
    mine, theirs = points.mean(axis=0), wanted.mean(axis=0)
    left, _, right = np.linalg.svd((points - mine).T @ (wanted - theirs))
    turn = np.sign(np.linalg.det(left) * np.linalg.det(right))
    rotation = (left @ np.diag([1.0, 1.0, turn]) @ right).T
    pose = Pose(read_only(rotation), read_only(theirs - rotation @ mine))
    return pose, float(np.sqrt(((pose.points(points) - wanted) ** 2).sum(axis=1).mean()))

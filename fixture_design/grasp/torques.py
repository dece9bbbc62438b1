"""What the drives of a hand must do for the part to hold a load, and the largest load that they allow.

Contact forces x >= 0 on the edges of the friction cones, on the part, balance a load w, and the fingers push them with
joint torques tau = J^T f (J the contact's point fixed to its link, and its spin for the moments of soft tips):

    W^T x + w = 0,    |T x| <= effort

A drive that presses its joint against a stop makes it a fixed link, which holds up to the drive's effort but follows
nothing; where no joint that can still move presses, nothing is held (`squeezes`). Joints that follow others load the
one that moves them; the hand's own weight is left out. Drives without a limit hold anything. The cones are cut to
pyramids from inside, so that a load said to be held is held.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, Vector, Weights
from fixture_design.contacts import Contact
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.stops import Stopped
from fixture_design.grasp.wrenches import Pushes, pushes_of
from fixture_design.tolerances import DEFAULT, LEAST_COST


@dataclass(frozen=True, eq=False)
class Held:
    """A load that the drives hold.

    Attributes:
        factor: of the load that was asked for; inf where nothing limits it.
        torques: by joint that moves on its own [N m or N]; of the load, or of ``factor`` times it.
        forces: by element or contact, the force on the part at each contact point, summed, shape (3,) [N].
        moments: of soft tips, the moment on the part beside that force, at the contact point, shape (3,) [N m].
    """

    factor: float
    torques: Mapping[str, float]
    forces: Mapping[str, Point]
    moments: Mapping[str, Point]


@dataclass(frozen=True, eq=False)
class Drives:
    """A grasp as its drives see it: pushes, and the torques that each takes.

    Attributes:
        torques: T, shape (f, m), torques of joints that move on their own for 1 N on each edge.
        limits: shape (f,).
        names: of those joints.
        stopped: which of them are at a stop.
    """

    pushes: Pushes
    torques: Float[np.ndarray, "f m"]
    limits: Weights
    names: tuple[str, ...]
    stopped: Stopped

    @classmethod
    def of(cls, posture: Posture, contacts: Sequence[Contact], links: Mapping[str, str], reference: Point) -> Drives:
        """Of the contacts that a hand makes; ``links`` tells the link of each element or contact."""
        pushes, model = pushes_of(contacts, reference), posture.model
        X_HW = posture.X_WH.inverse()
        poses = model.poses(posture.q)
        torques, speeds = np.zeros((len(model.free), len(pushes.owners))), np.zeros(len(model.free))
        for number in sorted(set(pushes.contacts)):
            edges = np.flatnonzero(np.array(pushes.contacts) == number)
            link = links[pushes.owners[edges[0]]]
            p_LC = poses[link].inverse().points(X_HW.points(pushes.points[edges[:1]]))[0]
            forces, moments = X_HW.vectors(pushes.forces[edges]), X_HW.vectors(pushes.moments[edges])
            jacobian = model.jacobian(posture.q, link, p_LC)
            speeds = np.maximum(speeds, np.linalg.norm(jacobian, axis=0))
            torques[:, edges] = jacobian.T @ forces.T
            torques[:, edges] += model.spin_jacobian(posture.q, link).T @ moments.T
        names = tuple(model.joints[number].name for number in model.free.tolist())
        return cls(pushes, torques, model.efforts, names, Stopped.of(posture, speeds))

    @cached_property
    def squeezes(self) -> bool:
        """Whether the drives can squeeze: some joint that has way to go presses, in forces x >= 0 that balance.

        Where no joint is at a stop, contacts that close can always be squeezed, and this is not looked into.
        """
        if not self.stopped:
            return True
        ways = np.vstack([self.torques[~self.stopped.upper], -self.torques[~self.stopped.lower]])
        return any(self._presses(way) for way in ways if np.abs(way).max(initial=0.0) > LEAST_COST)

    def _presses(self, way: Weights) -> bool:
        """Whether forces that balance, 1 N in all at most, take a torque or force of this kind."""
        from scipy.optimize import linprog

        count, balance = len(way), self.pushes.wrenches.T
        found = linprog(-way, np.ones((1, count)), [1.0], balance, np.zeros(6), bounds=(0, None), method="highs")
        return found.x is not None and bool(-found.fun > DEFAULT.near * np.abs(way).max())

    @property
    def _rows(self) -> tuple[Float[np.ndarray, "r m"], Weights]:
        """Rows and sides of  rows x <= sides: within the drives' limits."""
        limited = np.isfinite(self.limits)
        return np.vstack([self.torques[limited], -self.torques[limited]]), np.tile(self.limits[limited], 2)

    def largest(self, load: Vector) -> Held | None:
        """The largest multiple of a load, shape (6,) about the reference, that is held; None where none is."""
        if not len(self.pushes.owners) or not self.squeezes:
            return None
        count = len(self.pushes.owners)
        cost = np.append(np.zeros(count), -1.0)
        equalities = np.hstack([self.pushes.wrenches.T, load[:, None]])
        found, bounded = self._solve(cost, equalities, np.zeros(6))
        if found is None:
            return None
        if not bounded:
            return Held(np.inf, {}, {}, {})
        return self._held(float(found[-1]), found[:-1])

    def least_effort(self, load: Vector) -> Held | None:
        """The torques that hold a load with the least largest share of their limits; None where none do.

        Where no drive has a limit, the least largest torque.
        """
        count = len(self.pushes.owners)
        if not count or not self.squeezes:
            return None
        from scipy.optimize import linprog

        limited = np.isfinite(self.limits)
        limits = np.where(limited, self.limits, 1.0)
        shares = (self.torques / limits[:, None])[limited if limited.any() else slice(None)]

        upper = np.vstack([np.hstack([side * shares, -np.ones((len(shares), 1))]) for side in (1.0, -1.0)])
        # a little of the forces themselves, so that nothing squeezes for nothing
        cost = np.append(np.full(count, LEAST_COST), 1.0)
        equalities = np.hstack([self.pushes.wrenches.T, np.zeros((6, 1))])
        found = linprog(cost, upper, np.zeros(len(upper)), equalities, -load, bounds=(0, None), method="highs")
        if found.x is None or (limited.any() and found.x[-1] > 1):
            return None
        return self._held(1.0, found.x[:-1])

    def squeeze(self, total: float) -> Weights | None:
        """Torques with which the fingers squeeze the part and balance, shape (f,); None where there are none.

        Of all such forces the least push is largest, within the drives' limits and with ``total`` [N] in all at most.
        """
        from scipy.optimize import linprog

        count, contacts = len(self.pushes.owners), max(self.pushes.contacts, default=-1) + 1
        if not count or not self.squeezes:
            return None
        member = np.array(self.pushes.contacts)[None] == np.arange(contacts)[:, None]
        member = member[member.any(axis=1)].astype(np.float64)
        rows, most = self._rows
        upper = np.vstack([np.hstack([-member, np.ones((len(member), 1))]), np.append(np.ones(count), 0.0)[None]])
        upper = np.vstack([upper, np.hstack([rows, np.zeros((len(rows), 1))])])
        sides = np.concatenate([np.zeros(len(member)), [total], most])
        equalities = np.hstack([self.pushes.wrenches.T, np.zeros((6, 1))])
        cost = np.append(np.zeros(count), -1.0)
        found = linprog(cost, upper, sides, equalities, np.zeros(6), bounds=(0, None), method="highs")
        if found.x is None or found.x[-1] <= 0:
            return None
        return self.torques @ found.x[:-1]

    def farthest(self, direction: Point, most: float) -> Point:
        """Of the forces through the reference that are held, one that goes furthest along a direction, shape (3,) [N].

        Args:
            most: no coordinate is looked at beyond this [N].
        """
        from scipy.optimize import linprog

        if not len(self.pushes.owners) or not self.squeezes:
            return np.zeros(3)
        # the contacts push the part with the opposite of the force that they hold
        forces, (rows, sides) = -self.pushes.forces.T, self._rows
        upper, sides = np.vstack([rows, forces, -forces]), np.append(sides, np.full(6, most))
        moments = self.pushes.wrenches[:, 3:].T
        found = linprog(
            -direction @ forces, upper, sides, moments, np.zeros(3), bounds=(0, None), method="highs"
        )  # no push at all is allowed, and no coordinate without a bound
        return np.zeros(3) if found.x is None else forces @ found.x

    def _solve(self, cost: Weights, equalities: np.ndarray, sides: Weights) -> tuple[Weights | None, bool]:
        """The solution, and whether it is bounded."""
        from scipy.optimize import linprog

        rows, most = self._rows
        upper = np.hstack([rows, np.zeros((len(rows), 1))])
        found = linprog(
            cost, upper if len(upper) else None, most if len(upper) else None, equalities, sides,
            bounds=(0, None), method="highs",
        )  # fmt: skip
        if found.status == 3:
            return np.zeros(len(cost)), False
        return (None if found.x is None else np.array(found.x)), True

    def _held(self, factor: float, x: Weights) -> Held:
        torques = dict(zip(self.names, (self.torques @ x).tolist(), strict=True))
        pushes = self.pushes
        soft = {owner for owner, moment in zip(pushes.owners, pushes.moments, strict=True) if moment.any()}
        moments = _summed(pushes.owners, pushes.moments * x[:, None])
        spins = {owner: moment for owner, moment in moments.items() if owner in soft}
        return Held(factor, torques, _summed(pushes.owners, pushes.forces * x[:, None]), spins)


def _summed(owners: Sequence[str], vectors: Float[np.ndarray, "m 3"]) -> dict[str, Point]:
    sums: dict[str, Point] = {}
    for owner, vector in zip(owners, vectors, strict=True):
        sums[owner] = sums.get(owner, np.zeros(3)) + vector
    return sums

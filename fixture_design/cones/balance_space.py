"""The space in which pushes can be balanced: scaled, and without what self-stress and rank make trivial.

Three things would leave a solver without an interior: lengths and forces of very different sizes; cones that can push
against each other, strictly (M_Z x_Z = 0 with x_Z inside), which take any wrench in their span, so that every motion of
the dual is orthogonal to it; and directions that no push reaches. One small problem finds the stressed cones Z with
x_Z, and a motion e that all other free cones oppose strictly. Motions are then sought in

    {q : M_Z^T q = 0} = {T^T p} + {C w},  the second part orthogonal to every push,

(facial reduction, in one step: J. M. Borwein, H. Wolkowicz 1981) where T also makes the pushes as round as they can be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask, Vector, Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.cones.kernel.balance import Guesses, balance_guesses

#: Singular values below this, relative to the largest of unit columns, are zero [-].
RANK = 1e-9
#: A cone is under stress if its x is this much further inside than its slack is long [-].
_STRESSED = 1e4
#: A self-stress, or a motion that all oppose, is strict if it is this far inside, next to its size [-].
_STRICT = 1e-7


@dataclass(frozen=True, eq=False)
class BalanceSpace:
    """Cones padded to one width w, in scaled rows (moments by a length) and scaled pushes.

    Attributes:
        cones: as given.  threads: for the kernel.
        rows: shape (d,): a wrench times these is a scaled one.
        force: the size of forces [N]; one for pushes that are measured by their maps alone.
        maps: shape (d, n, w), scaled; zero where a cone is inert; a clamp's first column is zero.
        units: shape (n,): what one of x means: a clamp's head, or 1 / |M_i| [N].
        balls, free: shape (n,), bool: clamps with friction, and cones of free t.
        fixed: shape (d,), with the clamps' heads, scaled.
        stressed: shape (n,), bool: Z.  stress: x_Z, shape (n, w), zero elsewhere.  relief: the pseudoinverse of M_Z.
        escape: e, shape (d,), and how strictly each cone opposes it, shape (n,); None if none does strictly.
        turn: T, shape (r, d).  beyond: C, shape (d, c).
    """

    cones: ForceCones
    threads: int | None
    rows: Vector
    force: float
    maps: np.ndarray
    units: Weights
    balls: Mask
    free: Mask
    fixed: Vector
    stressed: Mask
    stress: np.ndarray
    relief: np.ndarray
    escape: Vector | None
    turn: np.ndarray
    beyond: np.ndarray

    @staticmethod
    def of(cones: ForceCones, fixed: Vector, threads: int | None) -> BalanceSpace:
        d = cones.maps.shape[0]
        padded = np.concatenate([cones.maps, np.zeros((d, 1))], axis=1)[:, cones.places]
        width = min(max(int(cones.sizes.max(initial=2)), 2 if d <= 3 else 3), 4)
        padded = padded[:, :, :width]
        rows = _row_scale(padded)
        maps = padded * rows[:, None, None]
        heads = np.where(np.isnan(cones.heads), 0.0, cones.heads)
        held = rows * fixed + maps[:, :, 0] @ heads
        free = np.isnan(cones.heads)
        balls = ~free & (heads > 0) & (cones.sizes > 1)
        lengths = np.sqrt(np.einsum("dnw,dnw->n", maps, maps))
        free &= lengths > 0
        maps[:, ~(free | balls)] = 0.0
        maps[:, balls, 0] = 0.0
        reach = np.sqrt(np.einsum("dnw,dnw->n", maps[:, balls], maps[:, balls])) * heads[balls]
        force = max(float(np.linalg.norm(held)), float(reach.max(initial=0.0))) or 1.0
        units = np.where(free, force / np.where(free, lengths, 1.0), np.where(balls, heads, 0.0))
        maps = maps * (units / force)[:, None]
        stressed, stress, escape = _stress(maps, free, threads)
        kept = _complement(flat(maps[:, stressed]))
        turn, beyond = _turned(maps[:, ~stressed], kept)
        relief = np.linalg.pinv(flat(maps[:, stressed]), rcond=RANK)
        if escape is not None:
            escape = kept @ (kept.T @ escape)
            margins = margins_of(np.einsum("dnw,d->nw", maps, escape))[free & ~stressed]
            size = float(np.linalg.norm(escape))
            escape = escape if not len(margins) or margins.min() > _STRICT * size else None
        return BalanceSpace(
            cones, threads, rows, force, maps, units, balls, free, held / force,
            stressed, stress, relief, escape, turn, beyond,
        )  # fmt: skip

    @property
    def rest(self) -> Mask:
        """The cones that are not under stress and push at all."""
        return (self.free | self.balls) & ~self.stressed

    def guesses(self, fixed: np.ndarray, loads: np.ndarray, *, seek: bool) -> Guesses:
        """The interior point for loads of length 1 in the space of T, shapes (k, r)."""
        maps = np.einsum("rd,dnw->rnw", self.turn, self.maps[:, self.rest])
        return balance_guesses(maps, self.balls[self.rest], fixed, loads, seek=seek, threads=self.threads)

    def held(self, fixed: np.ndarray) -> Guesses:
        """Pushes that hold each fixed wrench, shape (k, r): a load along a direction that no push reaches."""
        maps = np.einsum("rd,dnw->rnw", self.turn, self.maps[:, self.rest])
        maps = np.concatenate([maps, np.zeros((1, *maps.shape[1:]))])
        if len(maps) > 6 and maps.shape[2] < 4:
            maps = np.concatenate([maps, np.zeros((*maps.shape[:2], 4 - maps.shape[2]))], axis=2)
        fixed = np.concatenate([fixed, np.zeros((len(fixed), 1))], axis=1)
        loads = np.zeros(fixed.shape)
        loads[:, -1] = 1.0
        found = balance_guesses(maps, self.balls[self.rest], fixed, loads, threads=self.threads)
        return Guesses(found.forces[:, :, : self.maps.shape[2]], found.motions[:, :-1], found.sizes, found.steps)


def flat(arrays: np.ndarray) -> np.ndarray:
    """The last two axes as one."""
    return arrays.reshape(*arrays.shape[:-2], arrays.shape[-2] * arrays.shape[-1])


def margins_of(x: np.ndarray) -> np.ndarray:
    """t - |z|, which is >= 0 in the cone, over the last axis."""
    return x[..., 0] - np.sqrt(np.einsum("...w,...w->...", x[..., 1:], x[..., 1:]))


def _row_scale(maps: np.ndarray) -> Vector:
    """Ones for forces and 1 / length for moments, where rows are [f; m]; the length that makes both alike."""
    d = len(maps)
    rows = np.ones(d)
    forces = {3: 2, 6: 3}.get(d, d)
    of_force, of_moment = np.linalg.norm(maps[:forces]), np.linalg.norm(maps[forces:])
    if of_force > 0 and of_moment > 0:
        rows[forces:] = of_force / of_moment
    return rows


def _stress(maps: np.ndarray, free: Mask, threads: int | None) -> tuple[Mask, np.ndarray, Vector | None]:
    """Which free cones can push against each other strictly, how, and a motion that the others oppose.

    The load sum_i M_i [1, 0] asks: its factor is 0 with every strict motion optimal, or there is a stress, and then the
    interior point ends in the middle of both.
    """
    d, n, width = maps.shape
    none = np.zeros(n, dtype=bool)
    if not free.any():
        return none, np.zeros((n, width)), np.zeros(d)
    turn, _ = _turned(maps[:, free], np.eye(d))
    turned = np.einsum("rd,dnw->rnw", turn, maps[:, free])
    load = turned[:, :, 0].sum(axis=1)
    size = float(np.linalg.norm(load))
    x = np.zeros((free.sum(), width))
    x[:, 0], slack, motion = 1.0, np.zeros(x.shape), np.zeros(len(turn))
    if size > RANK * np.sqrt(free.sum()):
        balls = np.zeros(free.sum(), dtype=bool)
        found = balance_guesses(turned, balls, np.zeros((1, len(load))), load[None] / size, threads=threads)
        motion = found.motions[0]
        # the load is a push too: one of each cone's normals for each part of it
        x = found.forces[0]
        factor = max(-float(load @ np.einsum("rnw,nw->r", turned, x)) / size**2, 0.0)
        x[:, 0] += factor
        slack = np.einsum("rnw,r->nw", turned, motion)
    pushed = free.copy()
    pushed[free] = margins_of(x) > _STRESSED * np.linalg.norm(slack, axis=1)
    strain, good = _balanced_stress(maps, pushed, x[pushed[free]])
    escape = turn.T @ motion
    return (pushed, strain, escape) if good else (none, np.zeros((n, width)), escape)


def _balanced_stress(maps: np.ndarray, pushed: Mask, x: np.ndarray) -> tuple[np.ndarray, bool]:
    """The stress with M_Z x_Z = 0 up to rounding, and whether it is strict."""
    stress = np.zeros(maps.shape[1:])
    if not pushed.any():
        return stress, True
    columns = flat(maps[:, pushed])
    inverse = np.linalg.pinv(columns, rcond=RANK)
    strain = x.reshape(-1)
    for _ in range(2):
        strain = strain - inverse @ (columns @ strain)
    if not np.abs(strain).max() > 0:
        return stress, False
    stress[pushed] = (strain / np.abs(strain).max()).reshape(x.shape)
    return stress, bool(margins_of(stress[pushed]).min() > _STRICT)


def _complement(columns: np.ndarray) -> np.ndarray:
    """An orthonormal basis of what is orthogonal to the columns, shape (d, c)."""
    if not columns.shape[1]:
        return np.eye(len(columns))
    left, sizes, _ = np.linalg.svd(columns)
    return left[:, int((sizes > RANK * sizes[0]).sum()) if len(sizes) and sizes[0] > 0 else 0 :]


def _turned(maps: np.ndarray, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """T, which makes the unit columns of the kept part orthonormal rows, and C, which they do not reach."""
    columns = kept.T @ flat(maps)
    lengths = np.linalg.norm(columns, axis=0)
    if not columns.shape[0] or not (lengths > 0).any():
        return np.zeros((0, len(maps))), kept
    largest = lengths.max()
    columns = columns[:, lengths > RANK * largest] / lengths[lengths > RANK * largest]
    left, sizes, _ = np.linalg.svd(columns)
    rank = int((sizes > RANK * sizes[0]).sum())
    return (left[:, :rank] / sizes[:rank]).T @ kept.T, kept @ left[:, rank:]

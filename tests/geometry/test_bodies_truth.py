"""Contacts of bodies against brute force: does the part enter the body after a small motion?

The first-order cone says how fast every clause is violated; solids are really moved, and their convex pieces tested for
overlap by separating axes. Motions whose rates lie within the second-order terms of zero are left out, and counted.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from fixture_design.geometry.bodies import touches_between
from fixture_design.geometry.features import Features
from fixture_design.geometry.touch import Touch
from tests.geometry.solids import Convex, Solid, bar, cuboid, heap, overlap, turn

#: Size of a motion, in units of the solids (about 1), and the rate below which its sign is not judged. Second-order
#: terms are 1e-12.
STEP, MARGIN = 1e-6, 1e-4

WEDGE = bar([[0, 0], [-0.5, 0.6], [0.4, 0.7]], 0.5)
PYRAMID = Convex.hull([[0, 0, 0], [-0.5, -0.4, 0.7], [0.5, -0.4, 0.7], [0.1, 0.6, 0.7]])
BLOCK = cuboid([-0.5, -0.4, 0], [0.5, 0.4, 0.6])
FLOOR = Solid((cuboid([-1, -1, -0.5], [1, 1, 0]),))
DOWN = np.diag([1.0, -1, -1])
RIDGE = Solid((WEDGE,)).placed(DOWN)
SPIKE = Solid((PYRAMID,)).placed(DOWN)
NOTCH = Solid((cuboid([-1, -1, -1], [1, 1, 0]), cuboid([-1, -1, 0], [0, 1, 1])))
CORNER = Solid((*NOTCH.pieces, cuboid([0, -1, 0], [1, 0, 1])))
SADDLE = heap({(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1)}, 0.7, (-1, -1, -1))
THORN = Convex.hull([[0, 0, 0], [0.5, 0.2, 0.4], [0.2, 0.5, 0.4], [0.4, 0.4, 0.7]])
L_PART = heap({(0, 0, 0), (1, 0, 0), (0, 0, 1)}, 0.4, (-1, -0.5, -1)).placed(turn([0, 1, 0], np.pi))
SIDE = [[0, 0], [1, 1], [1.2, 1], [1.2, -0.4], [0, -0.4]]
VEE = Solid((bar(SIDE, 0.8), bar([[-x, z] for x, z in SIDE], 0.8)))
NEEDLE = Convex.hull([[0, 0, 0], [1, 0.3, 0.2], [0.2, 1, 0.3], [0.3, 0.2, 1]])
STAND = Solid((cuboid([-0.2, -0.1, -1], [0.1, 0.3, 0]),))
TILTED = BLOCK.placed(turn([0, 1, 0], np.pi / 4), np.array([-0.5, 0, 0.5]) * 2**-0.5)
YAW = np.array([0, 0, 1.0])


def _any_turn(rng: np.random.Generator) -> np.ndarray:
    return turn(rng.normal(size=3), rng.uniform(0, np.pi))


def _yaw(rng: np.random.Generator) -> np.ndarray:
    return turn(YAW, rng.uniform(-np.pi, np.pi))


def _shift(rng: np.random.Generator, *spans: float) -> np.ndarray:
    return rng.uniform(-1, 1, 3) * np.array(spans)


#: Each kind of meeting: a part and a body that touch, drawn at random.
KINDS = {
    "face on face": lambda r: (Solid((BLOCK,)).placed(_yaw(r), _shift(r, 0.8, 0.8, 0)), FLOOR),
    "face on smaller face": lambda r: (Solid((BLOCK,)).placed(_yaw(r)), STAND),
    "flush blocks": lambda r: (Solid((BLOCK,)), Solid((cuboid([-0.5, -0.4, -0.6], [0.5, 0.4, 0]),))),
    "edge on face": lambda r: (Solid((WEDGE,)).placed(_yaw(r), _shift(r, 1, 1, 0)), FLOOR),
    "apex on face": lambda r: (Solid((PYRAMID,)).placed(_yaw(r)), FLOOR),
    "face on apex": lambda r: (Solid((BLOCK,)).placed(_yaw(r), _shift(r, 0.2, 0.2, 0)), SPIKE),
    "edge across edge": lambda r: (Solid((WEDGE,)).placed(turn(YAW, r.uniform(0.2, 2.9)), _shift(r, 0, 0.1, 0)), RIDGE),
    "edge along edge": lambda r: (Solid((WEDGE,)).placed(np.eye(3), _shift(r, 0, 0.6, 0)), RIDGE),
    "apex on edge": lambda r: (Solid((PYRAMID,)).placed(_yaw(r)), RIDGE),
    "edge on apex": lambda r: (Solid((WEDGE,)).placed(_yaw(r)), SPIKE),
    "apex on apex": lambda r: (Solid((PYRAMID,)).placed(_yaw(r)), SPIKE),
    "block in a notch": lambda r: (Solid((cuboid([0, -0.3, 0], [0.4, 0.4, 0.5]),)), NOTCH),
    "apex in a notch": lambda r: (Solid((PYRAMID.placed(turn([0, 1, 0], 0.75), np.zeros(3)),)), NOTCH),
    "block in a corner": lambda r: (Solid((cuboid([0, 0, 0], [0.4, 0.3, 0.5]),)), CORNER),
    "spike in a corner": lambda r: (Solid((NEEDLE,)), CORNER),
    "face on a saddle": lambda r: (Solid((BLOCK.placed(_yaw(r), np.array([0, 0, 0.7])),)), SADDLE),
    "spike on a saddle": lambda r: (Solid((THORN,)).placed(turn(YAW, r.uniform(-0.9, 0.9))), SADDLE),
    "block in a V": lambda r: (Solid((TILTED,)).placed(np.eye(3), _shift(r, 0, 0.3, 0)), VEE),
    "step over an edge": lambda r: (L_PART, Solid((cuboid([-0.9, -0.6, -0.9], [0, 0.7, 0]),))),
    "step on a step": lambda r: (L_PART, heap({(0, 0, 0), (1, 0, 0), (0, 0, 1)}, 0.4, (-1, -0.4, -2))),
}


def _rate(touches: tuple[Touch, ...], motion: np.ndarray) -> tuple[float, float]:
    """How fast the motion enters the body: at the places found (outer), and with segments held as a whole (inner)."""
    outer = inner = -np.inf
    for touch in touches:
        at = motion[:3] + np.cross(motion[3:], touch.point)
        for clause in touch.clauses:
            units = [normal / np.linalg.norm(normal) for normal in clause]
            outer = max(outer, min(float(unit @ at) for unit in units))
            if touch.twin is not None:
                there = motion[:3] + np.cross(motion[3:], touch.twin)
                inner = max(inner, min(max(float(unit @ at), float(unit @ there)) for unit in units))
    return outer, max(inner, outer)


def _motions(rng: np.random.Generator, touches: tuple[Touch, ...], count: int) -> np.ndarray:
    """Random motions, half of them pulled towards what all clauses admit."""
    motions = rng.normal(size=(count, 6))
    for index in range(0, count, 2):
        motion = motions[index]
        for _ in range(60):
            worst, row = -np.inf, None
            for touch in touches:
                for clause in touch.clauses:
                    rows = [np.r_[n, np.cross(touch.point, n)] / np.linalg.norm(n) for n in clause]
                    rates = [float(candidate @ motion) for candidate in rows]
                    if min(rates) > worst:
                        worst, row = min(rates), rows[int(np.argmin(rates))]
            if worst < 0.02 or row is None:
                break
            motion = motions[index] = motion - (worst + 0.05) * row / (row @ row)
    return motions / np.linalg.norm(motions, axis=1, keepdims=True)


def judge(kind: str, seed: int, motions: int) -> Counter:
    """One drawn meeting, in a random pose, against brute force."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    part, body = KINDS[kind](rng)
    if seed % 2:
        pose, shift = _any_turn(rng), rng.normal(size=3)
        part, body = part.placed(pose, shift), body.placed(pose, shift)
        center = shift
    else:
        center = np.zeros(3)
    touches = touches_between(Features(part.geometry("part")), Features(body.geometry("body")), 1e-7)
    assert touches, kind
    seen: Counter = Counter()
    for direction in _motions(rng, touches, motions):
        # about a point of the solids, so that motions are of their size
        motion = np.r_[direction[:3] - np.cross(direction[3:], center), direction[3:]]
        outer, inner = _rate(touches, motion)
        depth = overlap(part, body, STEP * motion)
        if outer > MARGIN:
            assert depth > 0, (kind, seed, outer, motion.tolist())
            seen["entered"] += 1
        elif inner < -MARGIN:
            assert depth < 0, (kind, seed, inner, depth, motion.tolist())
            seen["free"] += 1
        else:
            seen["between" if outer < -MARGIN else "tie"] += 1
    return seen


@pytest.mark.parametrize("kind", KINDS)
def test_first_order_is_what_moving_the_solids_shows(kind: str) -> None:
    seen: Counter = Counter()
    for seed in range(10):
        seen += judge(kind, seed, 24)
    assert min(seen["entered"], seen["free"]) >= 10
    assert seen["tie"] <= 0.1 * seen.total()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_first_order_is_what_moving_the_solids_shows_at_length(kind: str) -> None:
    for seed in range(100, 150):
        judge(kind, seed, 60)

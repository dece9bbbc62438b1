"""Random contacts for the largest factors, Clarabel as the other route, and a check of proofs that needs neither."""

from __future__ import annotations

import numpy as np

from fixture_design.cones.second_order import Factors, ForceCones

#: What a balance may leave of the sizes in it, and a motion of a cone's reach [-].
LEFT = 1e-12


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def spatial_map(point: np.ndarray, normal: np.ndarray, friction: float, size: int) -> np.ndarray:
    """A contact that pushes along -n: normal, two of friction, a soft tip's moment about the normal."""
    sides = np.linalg.svd(normal[None])[2][1:]
    forces = np.array([-normal, friction * sides[0], friction * sides[1], np.zeros(3)])[:size]
    moments = np.cross(point, forces)
    if size == 4:
        moments[3] = 0.05 * friction * normal
    return np.hstack([forces, moments]).T


def planar_map(point: np.ndarray, normal: np.ndarray, friction: float, size: int) -> np.ndarray:
    forces = np.array([-normal, [-friction * normal[1], friction * normal[0]]])[:size]
    return np.column_stack([forces, point[0] * forces[:, 1] - point[1] * forces[:, 0]]).T


def contacts(rng: np.random.Generator, dimension: int, count: int, *, sided: bool, most_friction: float) -> ForceCones:
    """Contacts around an ellipsoid; if sided, clamps push from one side and the others are on the other."""
    plane = 2 if dimension == 3 else 3
    clamps = rng.random(count) < rng.uniform(0, 0.7)
    normals = unit(rng.normal(size=(count, plane)))
    if sided:
        towards, side = unit(rng.normal(size=plane)), np.where(clamps, -1.0, 1.0)[:, None]
        normals = unit(normals * (np.sign(normals @ towards)[:, None] * side) + 0.3 * side * towards)
    points = normals * [0.9, 0.7, 0.6][:plane]
    kind, sizes = (planar_map, (1, 2, 2)) if plane == 2 else (spatial_map, (1, 3, 3, 4))
    chosen = rng.choice(sizes, size=count)
    maps = [kind(p, n, rng.uniform(0, most_friction), k) for p, n, k in zip(points, normals, chosen, strict=True)]
    heads = np.where(clamps, rng.choice([0.0, 0.5, 1.0, 2.0], p=[0.1, 0.3, 0.3, 0.3], size=count), np.nan)
    return ForceCones(np.hstack(maps), chosen.astype(np.int64), heads)


def clarabel(cones: ForceCones, fixed: np.ndarray, load: np.ndarray) -> float | None:
    """The largest factor by Clarabel: -inf if there is none, inf without end, None if it does not say."""
    from pydrake.solvers import ClarabelSolver, MathematicalProgram, SolutionResult

    program = MathematicalProgram()
    factor, x = program.NewContinuousVariables(1), program.NewContinuousVariables(cones.maps.shape[1])
    program.AddLinearCost(-factor[0])
    balance = np.hstack([load[:, None], cones.maps])
    program.AddLinearEqualityConstraint(balance, -fixed, np.concatenate([factor, x]))
    for start, size, head in zip(cones.starts, cones.sizes, cones.heads, strict=True):
        mine = x[start : start + size]
        if not np.isnan(head):
            program.AddLinearEqualityConstraint(np.eye(1), np.array([head]), mine[:1])
        if size == 1:
            program.AddBoundingBoxConstraint(0.0, np.inf, mine)
        else:
            program.AddLorentzConeConstraint(np.eye(size), np.zeros(size), mine)
    result = ClarabelSolver().Solve(program)
    said = result.get_solution_result()
    if said == SolutionResult.kSolutionFound:
        return float(result.GetSolution(factor)[0])
    ends = {SolutionResult.kInfeasibleConstraints: -np.inf, SolutionResult.kDualInfeasible: np.inf}
    return ends.get(said)


def check_pushes(cones: ForceCones, x: np.ndarray, wrench: np.ndarray, sizes: float, *, held: bool = True) -> None:
    """x is in the cones, clamps push with their heads (or not at all), and its wrench makes up for the other."""
    for start, size, head in zip(cones.starts, cones.sizes, cones.heads, strict=True):
        t, z = x[start], x[start + 1 : start + size]
        assert np.linalg.norm(z) <= t * (1 + 1e-15)
        if not np.isnan(head):
            assert t == (head if held else 0.0)
    reach = np.abs(cones.maps) @ np.abs(x)
    # forces and moments each by their own sizes
    for part in np.split(np.arange(len(wrench)), [2 if len(wrench) == 3 else 3]):
        assert np.linalg.norm((wrench + cones.maps @ x)[part]) <= LEFT * (reach.sum() + sizes)


def check(cones: ForceCones, fixed: np.ndarray, loads: np.ndarray, found: Factors) -> None:
    """Every bound by its own proof: products only."""
    for k, load in enumerate(loads):
        lower, upper, q = found.lower[k], found.upper[k], found.motions[k]
        # factors are as exact as the wrenches that they make up for
        made = np.linalg.norm(fixed) + np.linalg.norm(cones.maps, axis=0).max(initial=0.0) * np.nansum(cones.heads)
        scale = max(abs(lower), abs(upper), made / np.linalg.norm(load) if load.any() else 0.0)
        assert lower <= upper + (1e-12 * scale if np.isfinite(scale) else 0.0)
        sizes = float(np.abs(fixed).sum())
        if np.isposinf(lower):
            check_pushes(cones, found.forces[k], load, float(np.abs(load).sum()), held=False)
            held = fixed + cones.maps @ found.starts[k]
            factor = -(held @ load) / (load @ load) if load.any() else 0.0
            check_pushes(cones, found.starts[k], fixed + factor * load, sizes + abs(factor) * np.abs(load).sum())
        elif np.isfinite(lower):
            check_pushes(cones, found.forces[k], fixed + lower * load, sizes + abs(lower) * np.abs(load).sum())
        if np.isposinf(upper):
            continue
        least, value, terms = 0.0, -float(fixed @ q), float(np.abs(fixed) @ np.abs(q))
        for start, size, head in zip(cones.starts, cones.sizes, cones.heads, strict=True):
            c = cones.maps[:, start : start + size].T @ q
            parts = np.split(np.arange(len(q)), [2 if len(q) == 3 else 3])
            reach = sum(np.linalg.norm(cones.maps[p, start : start + size]) * np.linalg.norm(q[p]) for p in parts)
            if np.isnan(head):
                least = min(least, (c[0] - np.linalg.norm(c[1:])) / reach if reach > 0 else 0.0)
            else:
                value, terms = value + head * (np.linalg.norm(c[1:]) - c[0]), terms + head * reach
        assert least >= -LEFT
        if np.isneginf(upper):
            assert abs(load @ q) <= LEFT * (np.abs(load) @ np.abs(q))
            assert value < 0
        else:
            assert load @ q == np.float64(1.0) or abs(load @ q - 1) < 1e-12 * max(1.0, float(np.abs(load) @ np.abs(q)))
            assert abs(value - upper) <= 1e-11 * max(abs(upper), terms, 1e-300)

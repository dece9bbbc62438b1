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
    reach = np.linalg.norm(cones.maps, axis=0) @ np.abs(x)
    assert np.linalg.norm(wrench + cones.maps @ x) <= LEFT * (reach + sizes)


def check(cones: ForceCones, fixed: np.ndarray, loads: np.ndarray, found: Factors) -> None:
    """Every bound by its own proof: products only, with moments by the length that makes the maps' parts alike."""
    rows = np.ones(len(fixed))
    plane = 2 if len(fixed) == 3 else 3
    forces, moments = np.linalg.norm(cones.maps[:plane]), np.linalg.norm(cones.maps[plane:])
    rows[plane:] = forces / moments if forces > 0 and moments > 0 else 1.0
    cones = ForceCones(cones.maps * rows[:, None], cones.sizes, cones.heads)
    fixed, loads, motions = fixed * rows, loads * rows, found.motions / rows
    made = np.linalg.norm(fixed) + np.linalg.norm(cones.maps, axis=0).max(initial=0.0) * np.nansum(cones.heads)
    for load, lower, upper, x, start, q in zip(
        loads, found.lower, found.upper, found.forces, found.starts, motions, strict=True
    ):
        # factors are as exact as the wrenches that they make up for
        size = float(np.linalg.norm(load))
        scale = max(abs(lower), abs(upper), made / size if size > 0 else 0.0)
        assert lower <= upper + (LEFT * scale if np.isfinite(scale) else 0.0)
        if np.isposinf(lower):
            check_pushes(cones, x, load, size, held=False)
            factor = -((fixed + cones.maps @ start) @ load) / size**2 if size > 0 else 0.0
            check_pushes(cones, start, fixed + factor * load, made + abs(factor) * size)
        elif np.isfinite(lower):
            check_pushes(cones, x, fixed + lower * load, made + abs(lower) * size)
        if not np.isposinf(upper):
            check_motion(cones, fixed, load, float(upper), q)


def check_motion(cones: ForceCones, fixed: np.ndarray, load: np.ndarray, upper: float, q: np.ndarray) -> None:
    """No free push goes along q, and what clamps can do along it gives the bound."""
    length = float(np.linalg.norm(q))
    value, terms = -float(fixed @ q), float(np.linalg.norm(fixed)) * length
    for start, size, head in zip(cones.starts, cones.sizes, cones.heads, strict=True):
        mine = cones.maps[:, start : start + size]
        c, reach = mine.T @ q, float(np.linalg.norm(mine)) * length
        if np.isnan(head):
            assert c[0] - np.linalg.norm(c[1:]) >= -LEFT * reach
        else:
            value, terms = value + head * (np.linalg.norm(c[1:]) - c[0]), terms + head * reach
    work = float(np.isfinite(upper))
    assert abs(load @ q - work) <= LEFT * max(work, np.linalg.norm(load) * length)
    if work:
        assert abs(value - upper) <= 10 * LEFT * max(abs(upper), terms)
    else:
        assert value < -LEFT * terms


def on_a_grid(rng: np.random.Generator) -> tuple[ForceCones, np.ndarray, np.ndarray]:
    """Contacts on grid points along the axes, often in line, opposed, coplanar or alike; loads on the grid: ties."""
    dimension, count = int(rng.choice([3, 6])), int(rng.integers(1, 12))
    plane = 2 if dimension == 3 else 3
    points = rng.integers(-2, 3, size=(count, plane)) + rng.choice([0.0, 0.0, 0.0, 100.0])
    if rng.random() < 0.3:
        points[:, -1] = points[0, -1]
    axes = np.vstack([np.eye(plane), -np.eye(plane)])
    normals = axes[rng.integers(len(axes), size=count)]
    kind, sizes = (planar_map, (1, 2)) if plane == 2 else (spatial_map, (1, 3, 4))
    chosen, frictions = rng.choice(sizes, size=count), rng.choice([0.0, 0.5, 1.0], size=count)
    maps = [kind(p, n, mu, k) for p, n, mu, k in zip(points, normals, frictions, chosen, strict=True)]
    force, metres = 10.0 ** rng.choice([0, -3, 9]), 10.0 ** rng.choice([0, -3, 2])
    units = np.where(np.arange(dimension) < plane, 1.0, metres)
    heads = np.where(rng.random(count) < 0.4, force * rng.choice([0.0, 1.0, 2.0], size=count), np.nan)
    fixed = rng.integers(-2, 3, size=dimension) * rng.choice([0.0, force]) * units
    loads = np.vstack([rng.integers(-1, 2, size=(4, dimension)), rng.normal(size=(2, dimension))]) * units
    return ForceCones(np.hstack(maps) * units[:, None], chosen, heads), fixed, loads

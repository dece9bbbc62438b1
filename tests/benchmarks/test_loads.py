"""How long a thousand loads take: all at once with proofs, and one by one with Clarabel, as pydrake.solvers has it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fixture_design.cones import kernel
from fixture_design.cones.second_order import ForceCones, largest_factors
from tests.cones.second_order import clarabel, spatial_map, unit

Benchmark = Callable[..., Any]
#: So many loads; Clarabel takes some of them, and its time is for those.
LOADS, SOME = 1000, 100


def fixture(count: int = 12, clamps: int = 6, seed: int = 1) -> tuple[ForceCones, np.ndarray, np.ndarray]:
    """Clamps on one side of an ellipsoid push it onto locators on the other; every factor is finite."""
    rng = np.random.default_rng(seed)
    towards, side = unit(rng.normal(size=3)), np.where(np.arange(count) < clamps, -1.0, 1.0)[:, None]
    normals = unit(rng.normal(size=(count, 3)))
    normals = unit(normals * (np.sign(normals @ towards)[:, None] * side) + 0.5 * side * towards)
    maps = [spatial_map(p, n, 0.3, 3) for p, n in zip(normals * [0.9, 0.7, 0.6], normals, strict=True)]
    heads = np.where(np.arange(count) < clamps, 1.0, np.nan)
    cones = ForceCones(np.hstack(maps), np.full(count, 3), heads)
    return cones, 0.1 * rng.normal(size=6), rng.normal(size=(LOADS, 6))


@pytest.mark.parametrize("name", kernel.available())
@pytest.mark.benchmark(group="factors of 1,000 loads, 12 contacts")
def test_all_at_once(benchmark: Benchmark, name: kernel.choice.Name) -> None:
    cones, fixed, loads = fixture()
    with kernel.using(name):
        found = benchmark(largest_factors, cones, fixed, loads)
    assert (found.upper - found.lower <= 1e-6 * np.abs(found.upper)).all()


@pytest.mark.benchmark(group="factors of 100 loads by Clarabel")
def test_clarabel_program_built_each_time(benchmark: Benchmark) -> None:
    pytest.importorskip("pydrake.solvers")
    cones, fixed, loads = fixture()
    found = benchmark(lambda: [clarabel(cones, fixed, load) for load in loads[:SOME]])
    ours = largest_factors(cones, fixed, loads[:SOME])
    np.testing.assert_allclose(found, ours.lower, rtol=1e-5)


@pytest.mark.benchmark(group="factors of 100 loads by Clarabel")
def test_clarabel_program_built_once(benchmark: Benchmark) -> None:
    pytest.importorskip("pydrake.solvers")
    cones, fixed, loads = fixture()
    solve = _built_once(cones, fixed)
    found = benchmark(lambda: [solve(load)[0] for load in loads[:SOME]])
    benchmark.extra_info["Clarabel's own seconds"] = sum(solve(load)[1] for load in loads[:SOME])
    np.testing.assert_allclose(found, largest_factors(cones, fixed, loads[:SOME]).lower, rtol=1e-5)


def _built_once(cones: ForceCones, fixed: np.ndarray) -> Callable[[np.ndarray], tuple[float, float]]:
    """A program whose load alone changes: the factor, and the time that Clarabel says it took."""
    from pydrake.solvers import ClarabelSolver, MathematicalProgram

    program, solver = MathematicalProgram(), ClarabelSolver()
    factor, x = program.NewContinuousVariables(1), program.NewContinuousVariables(cones.maps.shape[1])
    program.AddLinearCost(-factor[0])
    balance = program.AddLinearEqualityConstraint(
        np.hstack([np.ones((6, 1)), cones.maps]), -fixed, np.concatenate([factor, x])
    )
    for start, size, head in zip(cones.starts, cones.sizes, cones.heads, strict=True):
        mine = x[start : start + size]
        if not np.isnan(head):
            program.AddLinearEqualityConstraint(np.eye(1), np.array([head]), mine[:1])
        program.AddLorentzConeConstraint(np.eye(size), np.zeros(size), mine)

    def solve(load: np.ndarray) -> tuple[float, float]:
        balance.evaluator().UpdateCoefficients(np.hstack([load[:, None], cones.maps]), -fixed)
        result = solver.Solve(program)
        return float(result.GetSolution(factor)[0]), float(result.get_solver_details().solve_time)

    return solve

"""The compiled kernel against pycddlib (floats) and pplpy (exact), ratios within one run.

By hand: `python -m tests.benchmarks.compare_kernel`. Both are under the GPL: they are in the optional group `compare`
and needed nowhere else.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import cos, pi, sin
from statistics import median

import numpy as np

from fixture_design.cones import kernel
from tests.benchmarks.conftest import unit

#: How long each measurement may take [s].
PATIENCE = 0.15


def seconds(work: Callable[[], object]) -> float:
    """The least time of one call, over as many rounds as fit."""
    best, spent = np.inf, 0.0
    while spent < PATIENCE:
        start = time.perf_counter()
        work()
        took = time.perf_counter() - start
        best, spent = min(best, took), spent + took
    return best


def rational(rows: np.ndarray, digits: int = 3) -> np.ndarray:
    """Integer rows near these, exact for everybody."""
    return np.round(rows * 10**digits).astype(int)


def contacts(normals: np.ndarray, points: np.ndarray) -> np.ndarray:
    return np.column_stack([normals, np.cross(points, normals)])


def around_ellipsoid(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    directions, axes = unit(rng.normal(size=(count, 3))), np.array([5.0, 3.0, 2.0])
    return contacts(unit(directions / axes), directions * axes)


def fan(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.normal(size=(count, 5)), np.ones(count)])


def pads(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    points = np.column_stack([rng.normal(size=(count, 2)), np.zeros(count)])
    return contacts(np.tile([0.0, 0.0, 1.0], (count, 1)), points)


def friction(count: int, edges: int, seed: int = 1) -> np.ndarray:
    """Contacts on a plane with the edges of their friction cones."""
    rng = np.random.default_rng(seed)
    rim = [[0.3 * cos(2 * pi * k / edges), 0.3 * sin(2 * pi * k / edges), 1.0] for k in range(edges)]
    points = np.column_stack([rng.normal(size=(count, 2)), np.zeros(count)])
    return np.vstack([contacts(np.array(rim), np.tile(point, (edges, 1))) for point in points])


def locators() -> np.ndarray:
    points = [[-1, -1, 0], [1, -1, 0], [0, 1, 0], [-1, 2, 1], [1, 2, 1], [2, 0, 1]]
    normals = [[0, 0, -1]] * 3 + [[0, 1, 0]] * 2 + [[1, 0, 0]]
    return contacts(np.array(normals, dtype=float), np.array(points, dtype=float))


def corner() -> np.ndarray:
    """Four contacts on each of three faces of a box."""
    grid = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]], dtype=float)
    faces = [np.insert(grid, axis, 2.0, axis=1) for axis in range(3)]
    return np.vstack([contacts(np.tile(np.eye(3)[axis], (4, 1)), face) for axis, face in enumerate(faces)])


CASES: dict[str, np.ndarray] = {
    "planar, 4": np.array([[0, 1, 1.0], [1, 0, -0.5], [-1, 0, 0.5], [0.6, 0.8, 0.3]]),
    "3-2-1, 6": locators(),
    "ellipsoid, 7": around_ellipsoid(7),
    "corner, 12": corner(),
    "fan, 12": fan(12),
    "coplanar, 64": pads(64),
    "ellipsoid, 40": around_ellipsoid(40),
    "ellipsoid, 80": around_ellipsoid(80),
    "fan, 60": fan(60),
    "3 x 8 friction edges": friction(3, 8),
    "8 x 16 friction edges": friction(8, 16),
}


def by_cdd(rows: np.ndarray) -> int:
    import cdd

    matrix = cdd.matrix_from_array(
        np.column_stack([np.zeros(len(rows)), -rows]).tolist(), rep_type=cdd.RepType.INEQUALITY
    )
    found = cdd.copy_generators(cdd.polyhedron_from_matrix(matrix))
    # a cone's vertex is listed only where there is nothing else
    return sum(not row[0] and any(row[1:]) for row in found.array) - len(found.lin_set)


def by_ppl(rows: list[list[int]]) -> int:
    import ppl

    system = ppl.Constraint_System()
    x = [ppl.Variable(k) for k in range(len(rows[0]))]
    for row in rows:
        system.insert(sum(-value * variable for value, variable in zip(row, x, strict=True)) >= 0)
    cone = ppl.C_Polyhedron(len(rows[0]), "universe")
    cone.add_constraints(system)
    return sum(generator.is_ray() for generator in cone.minimized_generators())


def conversions() -> None:
    print(f"kernel: {kernel.NAME}")
    print("| face vectors | rays | kernel [us] | pycddlib / kernel | exact kernel [us] | pplpy / exact |")
    print("|---|---|---|---|---|---|")
    ratios, exact_ratios = [], []
    for name, rows in CASES.items():
        none = np.zeros((0, rows.shape[1]))
        whole = rational(unit(rows))
        floats, integers = unit(rows), whole.tolist()
        found = kernel.double_description(floats, none, 1e-9)
        fast = seconds(lambda floats=floats, none=none: kernel.double_description(floats, none, 1e-9))
        exact = seconds(lambda integers=integers: kernel.exact_double_description(integers, dimension=len(integers[0])))
        try:
            slow = seconds(lambda floats=floats: by_cdd(floats)) / fast
            note = "" if by_cdd(floats) == len(found.rays) else " (other rays)"
        except Exception as failure:  # noqa: BLE001 - whatever pycddlib raises
            slow, note = np.nan, f" ({type(failure).__name__})"
        rays = len(kernel.exact_double_description(integers, dimension=len(integers[0])).rays)
        slow_exact = seconds(lambda integers=integers: by_ppl(integers)) / exact
        assert by_ppl(integers) == rays, f"{name}: {by_ppl(integers)} rays, not {rays}"
        ratios.append(slow)
        exact_ratios.append(slow_exact)
        times = f"{fast * 1e6:.1f} | {slow:.1f}{note} | {exact * 1e6:.0f} | {slow_exact:.1f}"
        print(f"| {name} | {len(found.rays)} | {times} |", flush=True)
    for title, found_ratios in (("pycddlib", ratios), ("pplpy", exact_ratios)):
        values = [value for value in found_ratios if np.isfinite(value)]
        print(f"{title}: least {min(values):.1f}, median {median(values):.1f}, most {max(values):.1f}")


def closures() -> None:
    print("| closure test | us |\n|---|---|")
    for count in (7, 9, 12):
        rows = unit(around_ellipsoid(count))
        print(f"| {count} contacts | {seconds(lambda rows=rows: kernel.closure_test(rows)) * 1e6:.1f} |")
    rng = np.random.default_rng(3)
    directions = unit(rng.normal(size=(6, 3)))
    rims = []
    for n in directions:
        first = unit(np.cross(n, np.eye(3)[np.argmin(np.abs(n))])[None, :])[0]
        angles = 2 * pi * np.arange(64) / 64
        edges = n + 0.3 * (np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * np.cross(n, first))
        rims.append(contacts(edges, np.tile(n, (64, 1)) * [5.0, 3.0, 2.0]))
    rows = unit(np.vstack(rims))
    found = kernel.closure_test(rows)
    print(f"| 6 x 64 friction edges, closed: {found.closes} | {seconds(lambda: kernel.closure_test(rows)) * 1e6:.1f} |")
    count = 50_000
    many = unit(rng.normal(size=(12 * count, 6)))
    offsets = np.arange(0, 12 * count + 1, 12)
    for threads, witnesses in ((1, False), (2, True)):
        took = seconds(lambda t=threads, w=witnesses: kernel.closure_tests(many, offsets, witnesses=w, threads=t))
        words = "with witnesses" if witnesses else "bounds only"
        print(f"| batch of 12 contacts, {threads} thread(s), {words} | {count / took:,.0f} layouts/s |")


def modes() -> None:
    print("| modes | count | ms |\n|---|---|---|")
    rng = np.random.default_rng(5)
    for count in (24, 100):
        directions = unit(rng.normal(size=(count, 3)))
        directions[:, 2] = np.abs(directions[:, 2])
        rows = unit(contacts(unit(directions), directions * [1.0, 0.7, 0.5]))
        none = np.zeros((0, 6))

        def work(rows: np.ndarray = rows, none: np.ndarray = none) -> kernel.Faces:
            cone = kernel.double_description(rows, none, 1e-9)
            return kernel.faces_of(len(cone.lines), cone.rays, cone.incidence, cone.ambient)

        print(f"| {count} generic contacts | {len(work())} | {seconds(work) * 1e3:.2f} |")
    for count in (40, 100):
        curve = [[1, t, t * t, t**5, t**4, -2 * t**3] for t in range(1, count + 1)]
        start = time.perf_counter()
        found = kernel.exact_faces(curve, dimension=6)
        print(f"| moment curve, {count}, exact | {len(found)} | {(time.perf_counter() - start) * 1e3:.0f} |")


if __name__ == "__main__":
    closures()
    modes()
    conversions()

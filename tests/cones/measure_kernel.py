"""Long checks of the compiled kernel, by hand: `python -m tests.cones.measure_kernel [layouts] [cones]`.

* random batch layouts (7 to 12 rows, generic and degenerate ones) against exact arithmetic without any float filter,
* degenerate cones turned and shaken by noise against the exact double description, as `test_degenerate` has them,
* cyclic cones, whose rays are known to be 272 (20 face vectors) and 2,162 (50).

Exits with 1 if an answer is wrong and not flagged.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from fixture_design.cones import convert_rows, kernel
from fixture_design.cones.kernel.choice import compiled
from fixture_design.tolerances import DEFAULT, Tolerances
from tests.cones.test_degenerate import degenerate_rows, random_rotation

NOISES = (0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8)


def layouts(total: int, piece: int = 50_000) -> int:
    """Float layouts: the tolerant answer, where it has one, is the exact sign of the numbers as they are, or a tie."""
    native = compiled(6)
    if native is None:
        sys.exit("the compiled kernel was not built")
    rng = np.random.default_rng(7)
    wrong = undecided = ties = filtered_differs = done = 0
    while done < total:
        counts = rng.integers(7, 13, size=piece)
        offsets = np.concatenate([[0], np.cumsum(counts)])
        rows = rng.normal(size=(offsets[-1], 6))
        grid = np.repeat(rng.random(piece) < 0.2, counts)
        rows[grid] = np.round(rows[grid])
        lengths = np.linalg.norm(rows, axis=1, keepdims=True)
        rows = rows / np.where(lengths > 0, lengths, 1.0)
        found = kernel.closure_tests(rows, offsets)
        exactly = native.exact_signs(rows, None, offsets, False, 2)
        filtered_differs += int((native.exact_signs(rows, None, offsets, True, 2) != exactly).sum())
        tie = (found.closes == 0) & (found.leaves == 0)
        # a tie of the tolerance is any exact sign with s within rounding of zero; a yes must be an exact yes
        wrong += int(((found.closes == 1) & (exactly != 1)).sum() + ((found.leaves == 1) & (exactly != -1)).sum())
        wrong += int(((found.closes == 0) & (exactly == 1) & ~tie).sum())
        ties += int(tie.sum())
        undecided += int(((found.closes == -1) | (found.leaves == -1)).sum())
        done += piece
    print(
        f"{done} layouts: {wrong} wrong, {undecided} undecided, {ties} ties, {filtered_differs} changed by the filter"
    )
    return wrong + filtered_differs


def cones(total: int) -> int:
    """Noise is known, as it is of measured data: the tolerance is a thousand times as large, 1e-9 at least."""
    rng = np.random.default_rng(11)
    wrong = flagged = 0
    for number in range(total):
        d, noise = (3, 6)[number % 2], NOISES[number // 2 % len(NOISES)]
        rows = degenerate_rows(rng, d)
        truth = kernel.exact_double_description(rows.tolist(), dimension=d)
        turned = rows @ random_rotation(rng, d)
        turned = turned * (1 + noise * rng.normal(size=turned.shape)) * 10.0 ** rng.integers(-3, 4, size=(len(rows), 1))
        found = convert_rows(turned, np.zeros((0, d)), Tolerances(max(DEFAULT.tie, 1000 * noise)))
        flagged += not found.certain
        same = (len(found.vectors), len(found.lines)) == (len(truth.rays), len(truth.lines))
        wrong += found.certain and not same
    print(f"{total} degenerate cones, noise 0 to 1e-8: {wrong} wrong and unflagged, {flagged} flagged")
    return wrong


def cyclic() -> int:
    wrong = 0
    for count, rays in ((20, 272), (50, 2162)):
        rows = [[t**k for k in range(6)] for t in range(-count // 2, count // 2)]
        exactly = len(kernel.exact_double_description(rows, dimension=6).rays)
        points = np.cos(np.pi * (np.arange(count) + 0.5) / count)
        floats = np.polynomial.legendre.legvander(points, 5)
        found = convert_rows(floats, np.zeros((0, 6)))
        print(f"cyclic cone of {count}: {exactly} rays exact, {len(found.vectors)} float, certain: {found.certain}")
        wrong += (exactly != rays) + (found.certain and len(found.vectors) != rays)
    return wrong


def main() -> None:
    sizes = [int(value) for value in sys.argv[1:]]
    start = time.perf_counter()
    wrong = cyclic() + cones(sizes[1] if len(sizes) > 1 else 3000) + layouts(sizes[0] if sizes else 1_000_000)
    print(f"{time.perf_counter() - start:.0f} s")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

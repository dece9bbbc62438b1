"""Exact arithmetic in Python's own integers: the reference of the compiled exact kernel, and what runs without it.

The algorithms are those of `double_description` and `tucker`, on integer vectors without common factor.
"""

from __future__ import annotations

from math import gcd

from fixture_design.errors import ConeError

Integers = tuple[int, ...]


def dot(first: Integers, second: Integers) -> int:
    return sum(a * b for a, b in zip(first, second, strict=True))


def primitive(vector: list[int]) -> Integers:
    """The shortest integer vector along this one; zero stays zero."""
    factor = gcd(*vector) or 1
    return tuple(value // factor for value in vector)


def combined(a: int, x: Integers, b: int, y: Integers) -> Integers:
    """a x - b y, shortened."""
    return primitive([a * p - b * q for p, q in zip(x, y, strict=True)])


def echelon(rows: list[Integers], dimension: int) -> list[Integers]:
    """Reduced row echelon form: one canonical basis of the linear span, leading entries positive."""
    rest, basis = list(rows), []
    for column in range(dimension):
        place = next((k for k, row in enumerate(rest) if row[column]), None)
        if place is None:
            continue
        pivot = rest.pop(place)
        pivot = primitive(list(pivot)) if pivot[column] > 0 else primitive([-value for value in pivot])
        basis = [combined(pivot[column], row, row[column], pivot) for row in basis] + [pivot]
        rest = [combined(pivot[column], row, row[column], pivot) for row in rest]
    return basis


def convert(
    rows: list[Integers], equalities: list[Integers], dimension: int, max_rays: int
) -> tuple[list[Integers], list[Integers], list[int], int]:
    """Lines (echelon), rays (orthogonal to them), for each the rows it lies on as bits, and the ambient dimension."""
    lines: list[Integers] = [tuple(int(i == k) for k in range(dimension)) for i in range(dimension)]
    rays: list[tuple[Integers, int]] = []
    for equality in equalities:
        lines, _, _ = _take_line(lines, [], equality)
    ambient = len(lines)
    for number, row in enumerate(rows):
        bit = 1 << number
        lines, rays, down = _take_line(lines, rays, row)
        if down is not None:
            rays = [(ray, on | bit) for ray, on in rays] + [(down, bit - 1)]
            continue
        heights = [dot(row, ray) for ray, _ in rays]
        kept = [(ray, on | bit if h == 0 else on) for (ray, on), h in zip(rays, heights, strict=True) if h <= 0]
        above = [(ray, on, h) for (ray, on), h in zip(rays, heights, strict=True) if h > 0]
        below = [(ray, on, h) for (ray, on), h in zip(rays, heights, strict=True) if h < 0]
        needed = ambient - len(lines) - 2
        for up, on_up, high in above:
            for low, on_low, deep in below:
                common = on_up & on_low
                if common.bit_count() >= needed and sum(not common & ~on for _, on in rays) == 2:
                    kept.append((combined(high, low, deep, up), common | bit))
        rays = kept
        if len(rays) > max_rays:
            raise ConeError(f"the cone has more than {max_rays} extreme rays after {number + 1} face vectors")
    lines = echelon(lines, dimension)
    orthogonal: list[Integers] = []
    for line in lines:
        orthogonal.append(_across(line, orthogonal))
    return lines, [_across(ray, orthogonal) for ray, _ in rays], [on for _, on in rays], ambient


def _take_line(
    lines: list[Integers], rays: list[tuple[Integers, int]], row: Integers
) -> tuple[list[Integers], list[tuple[Integers, int]], Integers | None]:
    """Where a line crosses the row: the others slid along it onto the row, and the line itself, pointing down."""
    place = next((k for k, line in enumerate(lines) if dot(row, line)), None)
    if place is None:
        return lines, rays, None
    line = lines[place]
    down = line if dot(row, line) < 0 else tuple(-value for value in line)
    depth = dot(row, down)

    def slid(vector: Integers) -> Integers:
        return combined(dot(row, vector), down, depth, vector)

    rest = [slid(other) for k, other in enumerate(lines) if k != place]
    return rest, [(slid(ray), on) for ray, on in rays], down


def _across(vector: Integers, lines: list[Integers]) -> Integers:
    """The part of a vector orthogonal to orthogonal lines."""
    for line in lines:
        vector = combined(dot(line, line), vector, dot(vector, line), line)
    return vector


def partition(rows: list[Integers], dimension: int) -> tuple[list[int], Integers | None, list[Integers]]:
    """Tucker's partition: weights (positive on balanced rows), a motion that leaves the others, the balanced span.

    Does -sum d_i lie in the cone of the rows? If so, 1 + its weights balance; if not, Farkas' vector leaves some rows,
    and the rest is asked again.
    """
    weights, left = [0] * len(rows), list(range(len(rows)))
    motion: Integers | None = None
    gone: list[int] = []
    while left:
        vectors = [rows[k] for k in left]
        target = tuple(-sum(column) for column in zip(*vectors, strict=True))
        found, denominator, separating = nonnegative_solution(vectors, target)
        if separating is None:
            for k, weight in zip(left, found, strict=True):
                weights[k] = denominator + weight
            break
        factor = 1
        for k in gone if motion is not None else []:
            before, now = dot(rows[k], motion), dot(rows[k], separating)  # pyright: ignore[reportArgumentType]
            factor = max(factor, now // -before + 1)
        motion = separating if motion is None else combined(factor, motion, -1, separating)
        gone += [k for k in left if dot(rows[k], separating) < 0]
        left = [k for k in left if dot(rows[k], separating) == 0]
    return weights, motion, echelon([rows[k] for k in left], dimension)


def nonnegative_solution(columns: list[Integers], target: Integers) -> tuple[list[int], int, Integers | None]:
    """Farkas' lemma, decided: weights and denominator with sum w_j columns_j = denominator target, or y that separates.

    Phase 1 of the simplex method on an integer tableau with Bland's rule; y . columns <= 0, y . target > 0.
    """
    count, size = len(columns), len(target)
    signs = [-1 if value < 0 else 1 for value in target]
    table = [
        [sign * column[i] for column in columns] + [int(i == k) for k in range(size)] + [sign * target[i]]
        for i, sign in enumerate(signs)
    ]
    costs = [sum(row[j] for row in table) for j in range(count)] + [0] * size + [sum(row[-1] for row in table)]
    basis, denominator = [count + i for i in range(size)], 1
    while costs[-1]:
        entering = next((j for j in range(count) if costs[j] > 0), None)
        if entering is None:
            separating = tuple(sign * (costs[count + i] + denominator) for i, sign in enumerate(signs))
            return [], denominator, primitive(list(separating))
        leaving = _first_to_vanish(table, basis, entering)
        pivot_row, pivot = table[leaving], table[leaving][entering]
        for row in [*table, costs]:
            if row is not pivot_row:
                factor = row[entering]
                row[:] = [(a * pivot - factor * p) // denominator for a, p in zip(row, pivot_row, strict=True)]
        denominator, basis[leaving] = pivot, entering
    weights = [0] * count
    for row, index in zip(table, basis, strict=True):
        if index < count:
            weights[index] = row[-1]
    return weights, denominator, None


def _first_to_vanish(table: list[list[int]], basis: list[int], entering: int) -> int:
    best = -1
    for i, row in enumerate(table):
        if row[entering] <= 0:
            continue
        ahead = -1 if best < 0 else row[-1] * table[best][entering] - table[best][-1] * row[entering]
        if ahead < 0 or (ahead == 0 and basis[i] < basis[best]):
            best = i
    return best

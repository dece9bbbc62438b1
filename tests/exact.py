"""An independent exact route to every question of the cones: integers and Fractions only, nothing of the package.

A row may be scaled by any positive number without changing an answer, so rows become integer vectors without common
factor first. Linear programs are answered by a phase 1 simplex with Bland's rule on an integer tableau; every answer is
a certificate (weights, or a Farkas vector) that is checked in exact arithmetic before it is returned.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise, product
from math import gcd, isqrt, lcm, pi, tan
from typing import Literal

Number = int | Fraction
Vector = Sequence[Number]
Integers = tuple[int, ...]
Rows = Sequence[Vector]
#: AND over clauses, OR over alternatives, each alternative a list of rows.
Clauses = Sequence[Sequence[Rows]]

#: Edges of the pyramids that bracket a friction cone, refined until both agree.
EDGES = (8, 32, 128)


def dot(first: Vector, second: Vector) -> Number:
    return sum(a * b for a, b in zip(first, second, strict=True))


def integer_row(row: Vector) -> Integers:
    """The shortest integer vector along ``row``; zero stays zero."""
    fractions = [Fraction(value) for value in row]
    scale = lcm(*(value.denominator for value in fractions))
    whole = [int(value * scale) for value in fractions]
    factor = gcd(*whole) or 1
    return tuple(value // factor for value in whole)


def integer_rows(rows: Rows) -> list[Integers]:
    return [integer_row(row) for row in rows]


def echelon(rows: Rows) -> list[Integers]:
    """Reduced row echelon form in integers: one canonical basis of the linear span, leading entries positive."""
    rest, basis = integer_rows(rows), []
    for column in range(len(rest[0]) if rest else 0):
        pivot = next((row for row in rest if row[column]), None)
        if pivot is None:
            continue
        pivot = pivot if pivot[column] > 0 else tuple(-value for value in pivot)
        basis = [_eliminated(row, pivot, column) for row in basis] + [pivot]
        rest = [_eliminated(row, pivot, column) for row in rest]
    return basis


def _eliminated(row: Integers, pivot: Integers, column: int) -> Integers:
    return integer_row([pivot[column] * a - row[column] * b for a, b in zip(row, pivot, strict=True)])


def rank(rows: Rows) -> int:
    return len(echelon(rows))


@dataclass(frozen=True)
class Answer:
    """Either weights w >= 0 with sum w_j columns_j = target, or y with y . columns_j <= 0 and y . target > 0."""

    weights: tuple[Fraction, ...] | None
    separating: Integers | None


def nonnegative_solution(columns: Rows, target: Vector) -> Answer:
    """Farkas' lemma, decided: is ``target`` a nonnegative combination of ``columns``?"""
    vectors, b = integer_rows(columns), integer_row(target)
    signs = [-1 if value < 0 else 1 for value in b]
    count, size = len(vectors), len(b)
    table = [
        [sign * vector[i] for vector in vectors] + [int(i == k) for k in range(size)] + [sign * b[i]]
        for i, sign in enumerate(signs)
    ]
    costs = [sum(row[j] for row in table) for j in range(count)] + [0] * size + [sum(row[-1] for row in table)]
    basis, denominator = [count + i for i in range(size)], 1
    while costs[-1]:
        entering = next((j for j in range(count) if costs[j] > 0), None)  # Bland's rule: no cycles
        if entering is None:
            break
        leaving = _ratio_test(table, basis, entering)
        pivot_row, pivot = table[leaving], table[leaving][entering]
        for i, row in enumerate([*table, costs]):
            if i != leaving and (row[entering] or pivot != denominator):
                factor = row[entering]
                row[:] = [(a * pivot - factor * p) // denominator for a, p in zip(row, pivot_row, strict=True)]
        denominator, basis[leaving] = pivot, entering
    if costs[-1]:
        separating = tuple(sign * (costs[count + i] + denominator) for i, sign in enumerate(signs))
        assert dot(separating, b) > 0
        assert all(dot(separating, vector) <= 0 for vector in vectors)
        return Answer(None, separating)
    return Answer(_weights(columns, target, vectors, b, table, basis, denominator), None)


def _ratio_test(table: list[list[int]], basis: list[int], entering: int) -> int:
    best = -1
    for i, row in enumerate(table):
        if row[entering] > 0:
            if best < 0:
                best = i
                continue
            ahead = row[-1] * table[best][entering] - table[best][-1] * row[entering]
            if ahead < 0 or (ahead == 0 and basis[i] < basis[best]):
                best = i
    return best


def _weights(columns, target, vectors, b, table, basis, denominator) -> tuple[Fraction, ...]:
    weights = [Fraction(0)] * len(columns)
    for row, index in zip(table, basis, strict=True):
        if index < len(columns):
            weights[index] = Fraction(row[-1], denominator) * _ratio(vectors[index], columns[index]) / _ratio(b, target)
    assert all(weight >= 0 for weight in weights)
    for i, value in enumerate(target):
        assert sum(w * column[i] for w, column in zip(weights, columns, strict=True) if w) == value
    return tuple(weights)


def _ratio(scaled: Vector, original: Vector) -> Fraction:
    return next((Fraction(a) / Fraction(b) for a, b in zip(scaled, original, strict=True) if b), Fraction(1))


def in_cone(vector: Vector, generators: Rows) -> bool:
    """Whether ``vector`` is in span{generators}."""
    return nonnegative_solution(generators, vector).weights is not None


def in_faces(vector: Vector, faces: Rows, equalities: Rows = ()) -> bool:
    return all(dot(face, vector) <= 0 for face in faces) and all(dot(row, vector) == 0 for row in equalities)


def balanced(rows: Rows) -> list[bool]:
    """Tucker's B: which rows take part in a positive balance, that is, have -d_i in the cone of all rows."""
    return [in_cone([-value for value in row], rows) for row in rows]


def closes(rows: Rows, dimension: int) -> bool:
    """face{rows} = {o}: rank d, and all (non-zero) rows balance: D^T (1 + v) = 0 for some v >= 0 (Stiemke)."""
    vectors = [row for row in integer_rows(rows) if any(row)]
    if len(vectors) <= dimension or rank(vectors) < dimension:
        return False
    return in_cone([-sum(column) for column in zip(*vectors, strict=True)], vectors)


def separable(rows: Rows) -> bool:
    """Some u has d . u < 0 for every row: no weights w >= 0, not all zero, balance them (Gordan). True without rows."""
    lifted = [(*row, 1) for row in integer_rows(rows)]
    return not lifted or not in_cone([0] * (len(lifted[0]) - 1) + [1], lifted)


def extreme(faces: Rows, equalities: Rows = (), *, dimension: int) -> tuple[list[Integers], list[Integers]]:
    """Extreme rays and lines of {x : faces . x <= 0, equalities . x = 0}, by double description in integers.

    Rays are orthogonal to the lines, integer without common factor, sorted; lines are in reduced echelon form.
    """
    lines: list[Integers] = [tuple(int(i == k) for k in range(dimension)) for i in range(dimension)]
    for row in integer_rows(equalities):
        crossing = next((line for line in lines if dot(row, line)), None)
        if crossing is not None:
            lines = [_slid(line, crossing, row) for line in lines if line is not crossing]
    rays: list[tuple[Integers, int]] = []  # each with the bit mask of the rows it lies on
    for number, row in enumerate(integer_rows(faces)):
        bit, earlier = 1 << number, (1 << number) - 1
        crossing = next((line for line in lines if dot(row, line)), None)
        if crossing is not None:
            lines = [_slid(line, crossing, row) for line in lines if line is not crossing]
            down = crossing if dot(row, crossing) < 0 else tuple(-value for value in crossing)
            rays = [(_slid(ray, crossing, row), on | bit) for ray, on in rays] + [(down, earlier)]
            continue
        heights = [dot(row, ray) for ray, _ in rays]
        kept = [(ray, on | bit if h == 0 else on) for (ray, on), h in zip(rays, heights, strict=True) if h <= 0]
        for (up, on_up), high in zip(rays, heights, strict=True):
            for (low, on_low), depth in zip(rays, heights, strict=True):
                if high > 0 > depth and sum(not (on_up & on_low & ~on) for _, on in rays) == 2:
                    between = [high * b - depth * a for a, b in zip(up, low, strict=True)]
                    kept.append((integer_row(between), on_up & on_low | bit))
        rays = kept
    lines = echelon(lines)
    return sorted(across(ray, lines) for ray, _ in rays), lines


def _slid(vector: Integers, along: Integers, row: Integers) -> Integers:
    """``vector`` moved along ``along`` until row . x = 0."""
    slope, height = dot(row, along), dot(row, vector)
    sign = 1 if slope > 0 else -1
    return integer_row([sign * (slope * a - height * b) for a, b in zip(vector, along, strict=True)])


def across(vector: Vector, lines: Rows) -> Integers:
    """The part of ``vector`` orthogonal to ``lines``, as a shortest integer vector."""
    orthogonal: list[Integers] = []
    for line in [*lines, vector]:
        rest = [Fraction(value) for value in line]
        for other in orthogonal:
            factor = Fraction(dot(rest, other)) / dot(other, other)
            rest = [a - factor * b for a, b in zip(rest, other, strict=True)]
        orthogonal.append(integer_row(rest))
    return orthogonal[-1]


def branches(clauses: Clauses) -> Iterable[list[Vector]]:
    """One alternative out of every clause, in all ways; the rows of each choice."""
    for choice in product(*clauses):
        yield [row for alternative in choice for row in alternative]


def union_closes(clauses: Clauses, dimension: int) -> bool:
    """Every branch closes."""
    return all(closes(rows, dimension) for rows in branches(clauses))


def union_separable(clauses: Clauses) -> bool:
    """Some branch leaves all its rows strictly: strong accessibility."""
    return any(separable(rows) for rows in branches(clauses))


def union_full_rank(clauses: Clauses, dimension: int) -> bool:
    """Every branch has rank d: determinacy."""
    return all(rank(rows) == dimension for rows in branches(clauses))


def face_vector(point: Vector, normal: Vector) -> tuple[Number, ...]:
    """[n; x X n]."""
    if len(point) == 2:
        return (*normal, point[0] * normal[1] - point[1] * normal[0])
    (x, y, z), (a, b, c) = point, normal
    return (a, b, c, y * c - z * b, z * a - x * c, x * b - y * a)


@dataclass(frozen=True)
class ExactContact:
    """A contact as the package has it, in rational numbers: AND over clauses, OR over the normals of each."""

    point: tuple[Number, ...]
    clauses: tuple[tuple[tuple[Number, ...], ...], ...]
    friction: Number = 0


def clauses_of(contacts: Sequence[ExactContact], edges: int = 0, side: Literal["inner", "outer"] = "inner") -> Clauses:
    """Face vectors with their logic, of normals (edges = 0) or friction pyramids; moments about the first point."""
    rows = []
    for contact in contacts:
        lever = [Fraction(a) - b for a, b in zip(contact.point, contacts[0].point, strict=True)]
        mu = contact.friction if edges else 0
        for clause in contact.clauses:
            rows.append([[face_vector(lever, edge) for edge in friction_edges(n, mu, edges, side)] for n in clause])
    return rows


@cache
def circle(count: int, side: Literal["inner", "outer"]) -> tuple[tuple[Fraction, Fraction], ...]:
    """Rational corners of a polygon inscribed in (inner) or circumscribed about (outer) the unit circle.

    ``count`` is a multiple of 4; near equal spacing, with rational half-angle tangents.
    """
    halves = [Fraction(round(tan(pi * k / count) * 8 * count), 8 * count) for k in range(count // 4)]
    quarter = [((1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)) for t in halves]
    inner = [(x, y) for x, y in quarter]
    for _ in range(3):
        quarter = [(-y, x) for x, y in quarter]
        inner += quarter
    if side == "inner":
        return tuple(inner)
    # tangents at neighbours p and q meet in (p + q) / (1 + p . q)
    around = pairwise([*inner, inner[0]])
    return tuple(((p[0] + q[0]) / (1 + dot(p, q)), (p[1] + q[1]) / (1 + dot(p, q))) for p, q in around)


def square_root(value: Number, side: Literal["inner", "outer"]) -> Fraction:
    """The square root: exact where rational, else within 2^-40 (relative), from below (inner) or above (outer)."""
    value = Fraction(value)
    whole = value.numerator * value.denominator
    if isqrt(whole) ** 2 == whole:
        return Fraction(isqrt(whole), value.denominator)
    shift = 2 ** max(0, 42 - whole.bit_length() // 2)
    return Fraction(isqrt(whole * shift**2) + (side == "outer"), value.denominator * shift)


def friction_edges(normal: Vector, friction: Number, count: int, side: Literal["inner", "outer"]) -> list[Vector]:
    """Edges of a polyhedral cone inside (outside) the friction cone of ``normal``; exact in the plane."""
    if not friction:
        return [normal]
    n = [Fraction(value) for value in normal]
    if len(n) == 2:
        across_n = (-n[1], n[0])
        return [[a + sign * friction * b for a, b in zip(n, across_n, strict=True)] for sign in (-1, 1)]
    length = square_root(dot(n, n), side)
    first, second = _tangents(n, length, side)
    return [
        [a + friction * length * (c * b + s * e) for a, b, e in zip(n, first, second, strict=True)]
        for c, s in circle(count, side)
    ]


def _tangents(n: Vector, length: Fraction, side: Literal["inner", "outer"]) -> tuple[Vector, Vector]:
    """Orthogonal tangents, of length one if |n| is rational, else at most (inner) or at least (outer) one."""
    if length * length == dot(n, n):
        # the reflection that takes e3 to n / |n| takes e1 and e2 to tangents
        axis = [0 - n[0], 0 - n[1], length - n[2]]
        if not any(axis):
            return (1, 0, 0), (0, 1, 0)
        factor = Fraction(2) / dot(axis, axis)
        images = [[int(i == k) - factor * axis[k] * axis[i] for i in range(3)] for k in range(2)]
        return images[0], images[1]
    smallest = min(range(3), key=lambda i: abs(n[i]))
    first = face_vector([int(i == smallest) for i in range(3)], n)[3:]
    second = face_vector(n, first)[3:]
    opposite = "outer" if side == "inner" else "inner"
    return tuple([v / square_root(dot(t, t), opposite) for v in t] for t in (first, second))


def force_closes(contacts: Sequence[ExactContact], dimension: int) -> bool | None:
    """Force closure with friction; None if inner and outer pyramids of 128 edges disagree."""
    return force_bracket(contacts, dimension)[0]


def force_bracket(contacts: Sequence[ExactContact], dimension: int) -> tuple[bool | None, int]:
    """`force_closes`, and the number of edges that settled it."""
    exact = dimension == 3 or not any(contact.friction for contact in contacts)
    for count in EDGES:
        if union_closes(clauses_of(contacts, count, "inner"), dimension):
            return True, count
        if exact or not union_closes(clauses_of(contacts, count, "outer"), dimension):
            return False, count
    return None, EDGES[-1]

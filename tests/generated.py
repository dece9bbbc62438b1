"""A seeded stream of layouts with exact truth: rational contacts, decided before they are moved and rounded.

    for layout in generate(1000, seed=0):
        findings = judge(layout.contacts)                       # floats, as a file would have them
        assert layout.accepts("form_closure", findings["form_closure"])

Every layout is built from rational points and normals, its truth is decided in exact arithmetic (`tests.exact`), then
it is moved by a rational rigid motion, scaled, and rounded to float64 or to 12 decimals. Rounding turns exact ties into
near ones: an answer that takes the rounded numbers for exact is caught.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random

import numpy as np

from fixture_design.contacts import Contact
from tests import exact
from tests.checks import Gaps, gaps_of
from tests.exact import ExactContact

QUESTIONS = ("form_closure", "accessible", "strongly_accessible", "deterministic", "force_closure")

#: A near tie: here, and where the friction bracket disagrees, 'undecided' is a right answer.
NEAR_TIE = 1e-7

#: Spatial layouts with more branches or clauses than this get no friction: the exact bracket would take seconds.
FRICTION_BRANCHES, FRICTION_CLAUSES = 4, 6


Builder = Callable[[Random], list[ExactContact]]
Point = tuple[exact.Number, ...]


@dataclass(frozen=True)
class Kind:
    """How one kind of layout is made.

    Attributes:
        build: exact contacts about a part of size 1 near the origin.
        tilted: always rotated, else three times in four.  decimals: of the rounded coordinates, None for float64.
        scales: range of powers of ten.  offset: distance from the origin in sizes; 0 for a random one up to 100.
    """

    name: str
    space: str
    build: Builder
    tilted: bool = False
    decimals: int | None = None
    scales: tuple[int, int] = (-2, 0)
    offset: int = 0


KINDS: list[Kind] = []


def kind(name: str, space: str, **how: object) -> Callable[[Builder], Builder]:
    """Registers the decorated builder as a kind of layout."""

    def register(build: Builder) -> Builder:
        KINDS.append(Kind(name, space, build, **how))
        return build

    return register


@dataclass(frozen=True, eq=False)
class GeneratedLayout:
    """One layout.

    Attributes:
        kind: which generator made it.  number: its place in the stream.  space: "planar" or "spatial".
        base: exact contacts before the motion (truth and margins are those of ``base``; motions change neither).
        exact: exact contacts after the motion.
        contacts: ``exact``, rounded: what the code under test gets.
        truth: question -> True, False, or None where inner and outer friction pyramids disagree.
        gaps: question -> how far the answer is from another one, as a float: |s| for closure, strong accessibility and
            force closure, the smallest singular value for determinacy; infinite where an exact tie decides it.
        margin: exact sign times float size of the closure margin s; 0.0 is an exact tie.
        noise: size of the rounding in ``contacts``, relative to the layout's size.
    """

    kind: str
    number: int
    space: str
    base: tuple[ExactContact, ...]
    exact: tuple[ExactContact, ...]
    contacts: tuple[Contact, ...]
    truth: Mapping[str, bool | None]
    gaps: Mapping[str, float]
    margin: float
    noise: float

    @property
    def dimension(self) -> int:
        return 3 if self.space == "planar" else 6

    @property
    def exact_rows(self) -> exact.Clauses:
        """Face vectors of ``exact`` about its first point, with their logic."""
        return exact.clauses_of(self.exact)

    def is_near_tie(self, question: str) -> bool:
        return self.truth[question] is None or self.gaps[question] < NEAR_TIE

    def accepts(self, question: str, answer: str) -> bool:
        """Whether "yes", "no" or "undecided" is a right answer; undecided only in a near tie."""
        if answer == "undecided":
            return self.is_near_tie(question)
        truth = self.truth[question]
        return truth is None or answer == ("yes" if truth else "no")

    def __str__(self) -> str:
        return f"{self.kind} (layout {self.number}, {len(self.contacts)} contacts, margin {self.margin:.3g})"


def generate(count: int, seed: int, kinds: Sequence[Kind] | None = None) -> Iterator[GeneratedLayout]:
    """``count`` layouts, cycling over the kinds; each depends on its place in the stream and the seed alone."""
    kinds = kinds or KINDS
    for number in range(count):
        kind = kinds[number % len(kinds)]
        yield generate_one(kind, number, seed)


def generate_one(kind: Kind, number: int, seed: int) -> GeneratedLayout:
    rng = Random(f"{seed}/{number}/{kind.name}")
    base = tuple(_with_friction(kind.build(rng), kind.space, rng))
    moved, noise = _moved(base, kind, rng)
    truth, gaps = truth_of(base, 3 if kind.space == "planar" else 6)
    contacts = tuple(_rounded(contact, index, kind.decimals) for index, contact in enumerate(moved))
    known = {
        "form_closure": gaps.form_closure,
        "accessible": gaps.form_closure,
        "strongly_accessible": gaps.strongly_accessible,
        "deterministic": gaps.deterministic,
        "force_closure": gaps.force_closure,
    }
    return GeneratedLayout(
        kind.name, number, kind.space, base, tuple(moved), contacts, truth, known, gaps.margin, noise
    )


def truth_of(contacts: Sequence[ExactContact], dimension: int) -> tuple[dict[str, bool | None], Gaps]:
    """The five answers in exact arithmetic, and how far each is from another one."""
    clauses = exact.clauses_of(contacts)
    closed = exact.union_closes(clauses, dimension)
    has_friction = any(contact.friction for contact in contacts)
    force, edges = exact.force_bracket(contacts, dimension) if has_friction else (closed, 0)
    truth = {
        "form_closure": closed,
        "accessible": not closed,
        "strongly_accessible": exact.union_separable(clauses),
        "deterministic": exact.union_full_rank(clauses, dimension),
        "force_closure": force,
    }
    return truth, gaps_of(contacts, truth, dimension, edges)


def _with_friction(contacts: list[ExactContact], space: str, rng: Random) -> list[ExactContact]:
    """Friction for a third of the layouts whose kind has none of its own."""
    clauses = [clause for contact in contacts for clause in contact.clauses]
    count = 1
    for clause in clauses:
        count *= len(clause)
    affordable = space == "planar" or (count <= FRICTION_BRANCHES and len(clauses) <= FRICTION_CLAUSES)
    if any(contact.friction for contact in contacts) or not affordable or rng.randrange(3):
        return contacts
    friction = Fraction(rng.choice([1, 2, 3, 5, 8]), 10)
    return [replace(contact, friction=friction) for contact in contacts]


def rotation(space: str, rng: Random) -> list[list[Fraction]]:
    """A rational rotation: from an integer quaternion, or in the plane from a half-angle tangent."""
    if space == "planar":
        p, q = rng.randint(1, 30), rng.randint(-30, 30)
        c, s = Fraction(p * p - q * q, p * p + q * q), Fraction(2 * p * q, p * p + q * q)
        return [[c, -s], [s, c]]
    w, x, y, z = (rng.randint(-9, 9) for _ in range(4))
    w = w or 1
    n = w * w + x * x + y * y + z * z
    matrix = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return [[Fraction(value, n) for value in row] for row in matrix]


def _moved(base: Sequence[ExactContact], kind: Kind, rng: Random) -> tuple[list[ExactContact], float]:
    width = len(base[0].point)
    tilt = rotation(kind.space, rng) if kind.tilted or rng.randrange(4) else _identity(width)
    scale = Fraction(10) ** rng.randint(*kind.scales)
    offset = kind.offset or rng.choice([0, 0, 1, 100])
    shift = [scale * offset * Fraction(rng.randint(-1000, 1000), 1000) for _ in range(width)]

    def turned(vector: Sequence[exact.Number]) -> tuple[exact.Number, ...]:
        return tuple(exact.dot(row, vector) for row in tilt)

    moved = [
        ExactContact(
            tuple(scale * a + b for a, b in zip(turned(contact.point), shift, strict=True)),
            tuple(tuple(turned(normal) for normal in clause) for clause in contact.clauses),
            contact.friction,
        )
        for contact in base
    ]
    rounding = 2.0**-53 if kind.decimals is None else 0.5 * 10.0**-kind.decimals / min(1.0, float(scale))
    return moved, rounding * (1 + offset)


def _identity(width: int) -> list[list[Fraction]]:
    return [[Fraction(int(i == k)) for k in range(width)] for i in range(width)]


def _rounded(contact: ExactContact, index: int, decimals: int | None) -> Contact:
    def vector(values: Sequence[exact.Number]) -> np.ndarray:
        floats = [float(value) for value in values]
        return np.array(floats if decimals is None else [round(value, decimals) for value in floats])

    clauses = tuple(tuple(vector(normal) for normal in clause) for clause in contact.clauses)
    return Contact(f"C{index + 1}", "locator", vector(contact.point), clauses, float(contact.friction))


# The kinds. Parts have a size of about 1 and sit near the origin; every number is rational.


def on(point: Sequence[exact.Number], *normals: Sequence[exact.Number], friction: exact.Number = 0) -> ExactContact:
    """A contact on all of some facets (AND)."""
    return ExactContact(tuple(point), tuple((tuple(normal),) for normal in normals), friction)


def any_of(point: Sequence[exact.Number], *normals: Sequence[exact.Number], friction: exact.Number = 0) -> ExactContact:
    """A contact on at least one of some facets (OR): a tip at a convex edge or apex."""
    return ExactContact(tuple(point), (tuple(tuple(normal) for normal in normals),), friction)


def fraction(rng: Random, low: int = -1, high: int = 1, parts: int = 16) -> Fraction:
    return Fraction(rng.randint(low * parts, high * parts), parts)


def integers(rng: Random, width: int, size: int = 7) -> Point:
    """A random direction that is not zero."""
    while not any(vector := tuple(rng.randint(-size, size) for _ in range(width))):
        pass
    return vector


def sphere_point(rng: Random, width: int) -> Point:
    """A rational point of the unit circle or sphere, by stereographic projection."""
    at = [Fraction(rng.randint(-12, 12), rng.randint(3, 9)) for _ in range(width - 1)]
    square = sum(value * value for value in at)
    return (*(2 * value / (1 + square) for value in at), (1 - square) / (1 + square))


def bulged(rng: Random, width: int) -> ExactContact:
    """A contact roughly on an ellipsoid: the normal points about away from the centre."""
    normal = integers(rng, width)
    size = max(abs(value) for value in normal)
    return on([Fraction(value, size) + fraction(rng) / 2 for value in normal], normal)


def box_face(axis: int, sign: int, *others: exact.Number) -> ExactContact:
    """A contact on the face sign * e_axis of the box [-1, 1]^width, at the other coordinates."""
    point, normal = list(others), [0] * (len(others) + 1)
    point.insert(axis, sign)
    normal[axis] = sign
    return on(point, normal)


def on_box(rng: Random, width: int) -> ExactContact:
    return box_face(rng.randrange(width), rng.choice([-1, 1]), *(fraction(rng, parts=4) for _ in range(width - 1)))


def locators_321(rng: Random) -> list[ExactContact]:
    """Three below, two behind, one at the side; seldom in a line, and then not deterministic."""
    below = [box_face(2, -1, fraction(rng), fraction(rng)) for _ in range(3)]
    behind = [box_face(1, -1, fraction(rng), fraction(rng)) for _ in range(2)]
    return [*below, *behind, box_face(0, -1, fraction(rng), fraction(rng))]


def clamps_321(rng: Random, spread: int = 3) -> list[ExactContact]:
    """Three clamps against 3-2-1, near the middle, so that many layouts close."""
    return [box_face(axis, 1, fraction(rng) / spread, fraction(rng) / spread) for axis in range(3)]


def force_on(wrench: Sequence[Fraction]) -> ExactContact:
    """The planar contact with a given face vector [n; m], n not zero."""
    nx, ny, moment = wrench
    square = nx * nx + ny * ny
    return on([moment * ny / square, -moment * nx / square], [nx, ny])


@kind("planar, generic", "planar", scales=(-3, 3))
def _(rng: Random) -> list[ExactContact]:
    return [bulged(rng, 2) for _ in range(rng.randint(3, 8))]


@kind("spatial, generic", "spatial", scales=(-3, 3))
def _(rng: Random) -> list[ExactContact]:
    return [bulged(rng, 3) for _ in range(rng.randint(6, 14))]


@kind("spatial, generic, up to 24 contacts", "spatial")
def _(rng: Random) -> list[ExactContact]:
    return [bulged(rng, 3) for _ in range(rng.randint(15, 24))]


@kind("box, up to 24 contacts", "spatial")
def _(rng: Random) -> list[ExactContact]:
    return [on_box(rng, 3) for _ in range(rng.randint(7, 24))]


@kind("rectangle, up to 12 contacts", "planar")
def _(rng: Random) -> list[ExactContact]:
    return [on_box(rng, 2) for _ in range(rng.randint(3, 12))]


@kind("on a sphere, rank 3", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return [on(n, n) for n in (sphere_point(rng, 3) for _ in range(rng.randint(3, 12)))]


@kind("on a circle, rank 2", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return [on(n, n) for n in (sphere_point(rng, 2) for _ in range(rng.randint(2, 8)))]


@kind("normals through one axis, rank 5", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    contacts = []
    for _ in range(rng.randint(6, 14)):
        x, y = sphere_point(rng, 2)
        radius, out, up = Fraction(rng.randint(1, 8), 8), rng.randint(0, 5), rng.randint(-5, 5)
        contacts.append(on([radius * x, radius * y, fraction(rng)], [out * x, out * y, up if out else 1]))
    return contacts


@kind("ten contacts, one spin free", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    around = [sphere_point(rng, 2) for _ in range(4)]
    sides = [on([s * x, s * y, fraction(rng)], [s * x, s * y, 0]) for x, y in around for s in (1, -1)]
    ends = [box_face(2, sign, fraction(rng, parts=8), fraction(rng, parts=8)) for sign in (1, -1)]
    return sides + ends


@kind("two antipodal contacts with friction, rank 5", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    n, mu = sphere_point(rng, 3), Fraction(rng.randint(1, 12), 10)
    return [on([sign * v for v in n], [sign * v for v in n], friction=mu) for sign in (1, -1)]


@kind("two contacts with friction", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    mu = Fraction(rng.randint(0, 10), 10)
    return (
        [box_face(0, 1, fraction(rng, parts=8)), box_face(0, -1, fraction(rng, parts=8))]
        if not mu
        else [replace(box_face(0, sign, fraction(rng, parts=8)), friction=mu) for sign in (1, -1)]
    )


@kind("all push one way", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    count = rng.randint(3, 9)
    return [on([fraction(rng), fraction(rng), 1], [rng.randint(-2, 2), rng.randint(-2, 2), 3]) for _ in range(count)]


@kind("all push down, parallel", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return [box_face(2, 1, fraction(rng), fraction(rng)) for _ in range(rng.randint(1, 8))]


@kind("3-2-1 without clamps", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return locators_321(rng)


@kind("3-2-1 with clamps", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return locators_321(rng) + clamps_321(rng)


@kind("3-2-1 with clamps, rounded to 12 decimals", "spatial", tilted=True, decimals=12, scales=(0, 0))
def _(rng: Random) -> list[ExactContact]:
    return locators_321(rng) + clamps_321(rng, spread=6)


@kind("cylinder in a bore, rounded to 12 decimals", "spatial", tilted=True, decimals=12, scales=(0, 0))
def _(rng: Random) -> list[ExactContact]:
    around = [sphere_point(rng, 2) for _ in range(rng.randint(5, 12))]
    return [on([x, y, fraction(rng)], [x, y, 0]) for x, y in around] + [box_face(2, -1, 0, 0)] * rng.randint(0, 1)


@kind("rectangle, rounded to 12 decimals", "planar", tilted=True, decimals=12, scales=(0, 0))
def _(rng: Random) -> list[ExactContact]:
    return [on_box(rng, 2) for _ in range(rng.randint(4, 8))]


@kind("friction going to zero", "spatial")
def _(rng: Random) -> list[ExactContact]:
    mu = rng.choice([Fraction(1, 10**k) for k in range(1, 7)] + [Fraction(0)])
    clamp = box_face(rng.randrange(3), 1, fraction(rng) / 4, fraction(rng) / 4)
    return [replace(contact, friction=mu) for contact in [*locators_321(rng)[: rng.randint(3, 5)], clamp]]


@kind("friction going to zero", "planar")
def _(rng: Random) -> list[ExactContact]:
    mu = rng.choice([Fraction(1, 10**k) for k in range(1, 7)] + [Fraction(0)])
    return [replace(on_box(rng, 2), friction=mu) for _ in range(rng.randint(2, 5))]


@kind("friction at its threshold", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    # contacts above, below and at the side: closed if and only if mu > offset / height of the side contact
    offset, height = Fraction(rng.randint(1, 7), 16), Fraction(1, 2) + Fraction(rng.randint(-6, 6), 16)
    mu = offset / height * (1 + Fraction(rng.choice([-1, 0, 0, 1]), 10 ** rng.randint(2, 6)))
    below, side = on([0, Fraction(-1, 2)], [0, -1], friction=mu), on([Fraction(1, 2), height - Fraction(1, 2)], [1, 0])
    return [below, side, on([offset, Fraction(1, 2)], [0, 1])]


@kind("friction at its threshold", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    # four contacts around a tapered part push it down; horizontal forces need mu > p / q, and then it is closed
    p, q = rng.choice([(3, 4), (5, 12), (8, 15), (1, 2), (2, 5)])
    mu = Fraction(p, q) * (1 + Fraction(rng.choice([-1, 0, 1]), 10 ** rng.randint(1, 6)))
    around = [(1, 0), (-1, 0), (0, 1), (0, -1)]
    return [on([x, y, 0], [q * x, q * y, p], friction=mu) for x, y in around]


@kind("millimetres next to metres", "spatial", scales=(-3, 3))
def _(rng: Random) -> list[ExactContact]:
    contacts = [bulged(rng, 3) for _ in range(rng.randint(7, 12))]
    small = [rng.random() < 0.5 for _ in contacts]
    return [
        replace(contact, point=tuple(Fraction(v) / 1000 for v in contact.point)) if tiny else contact
        for contact, tiny in zip(contacts, small, strict=True)
    ]


@kind("millimetres next to metres", "planar", scales=(-3, 3))
def _(rng: Random) -> list[ExactContact]:
    contacts = [bulged(rng, 2) for _ in range(rng.randint(4, 7))]
    small = [rng.random() < 0.5 for _ in contacts]
    return [
        replace(contact, point=tuple(Fraction(v) / 1000 for v in contact.point)) if tiny else contact
        for contact, tiny in zip(contacts, small, strict=True)
    ]


@kind("far from the origin, 1e4 sizes", "spatial", tilted=True, scales=(-3, 3), offset=10**4)
def _(rng: Random) -> list[ExactContact]:
    return rng.choice([locators_321(rng), locators_321(rng) + clamps_321(rng), [bulged(rng, 3) for _ in range(9)]])


@kind("far from the origin, 1e4 sizes", "planar", tilted=True, scales=(-3, 3), offset=10**4)
def _(rng: Random) -> list[ExactContact]:
    return [on_box(rng, 2) for _ in range(rng.randint(3, 7))]


@kind("far from the origin, 1e6 sizes", "spatial", tilted=True, scales=(-3, 2), offset=10**6)
def _(rng: Random) -> list[ExactContact]:
    return [bulged(rng, 3) for _ in range(rng.randint(6, 10))]


@kind("margin of about 1e-6", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _last_balances(rng, Fraction(rng.choice([-1, 1]), 10**6))


@kind("exact tie", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _last_balances(rng, Fraction(0))


def _last_balances(rng: Random, last: Fraction) -> list[ExactContact]:
    """Three contacts and a fourth that balances them with weights a, b and ``last``: closed if and only if last > 0."""
    while True:
        rows = [exact.clauses_of([on([0, 0], [1, 0]), bulged(rng, 2)])[1][0][0] for _ in range(3)]
        weights = [Fraction(rng.randint(2, 9), 4), Fraction(rng.randint(2, 9), 4), last]
        fourth = [-sum(w * row[i] for w, row in zip(weights, rows, strict=True)) for i in range(3)]
        if exact.rank(rows) == 3 and any(fourth[:2]):
            order = [force_on([Fraction(v) for v in row]) for row in [*rows, fourth]]
            rng.shuffle(order)
            return order


@kind("margin of about 1e-6", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _clamp_at_the_edge(rng, Fraction(rng.choice([-1, 1]), 10**6))


@kind("exact tie", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _clamp_at_the_edge(rng, Fraction(0))


def _clamp_at_the_edge(rng: Random, inward: Fraction) -> list[ExactContact]:
    """3-2-1 on its middle planes; the top clamp is ``inward`` of the edge of the support triangle: closed iff > 0."""
    a, b = fraction(rng, 0) / 2 + Fraction(1, 4), fraction(rng, 0) / 2 + Fraction(1, 4)
    below = [box_face(2, -1, -a, -b), box_face(2, -1, a, -b), box_face(2, -1, fraction(rng), b)]
    side = [box_face(1, -1, -a, 0), box_face(1, -1, a, 0), box_face(0, -1, 0, 0)]
    return [*below, *side, box_face(1, 1, a / 3, 0), box_face(0, 1, 0, 0), box_face(2, 1, a / 5, -b + inward)]


@kind("repeated contacts", "spatial")
def _(rng: Random) -> list[ExactContact]:
    contacts = rng.choice([locators_321(rng) + clamps_321(rng), [bulged(rng, 3) for _ in range(7)]])
    return _repeated(contacts, rng)


@kind("repeated contacts", "planar")
def _(rng: Random) -> list[ExactContact]:
    return _repeated([bulged(rng, 2) for _ in range(rng.randint(2, 5))], rng)


def _repeated(contacts: list[ExactContact], rng: Random) -> list[ExactContact]:
    """Some contacts again, as they are or with a longer normal."""
    again = [rng.choice(contacts) for _ in range(rng.randint(1, 6))]
    factors = [rng.choice([1, 1, 3, Fraction(1, 7)]) for _ in again]
    return contacts + [
        replace(c, clauses=tuple(tuple(tuple(f * v for v in n) for n in clause) for clause in c.clauses))
        for c, f in zip(again, factors, strict=True)
    ]


@kind("opposed contacts", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _opposed(rng, 3, rng.randint(2, 7))


@kind("opposed contacts", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    return _opposed(rng, 2, rng.randint(1, 4))


def _opposed(rng: Random, width: int, pairs: int) -> list[ExactContact]:
    """Pairs along one line of force; at most one of them is then pushed off it."""
    contacts = []
    for _ in range(pairs):
        first = bulged(rng, width)
        normal = first.clauses[0][0]
        along = [x - Fraction(n, 3) for x, n in zip(first.point, normal, strict=True)]
        contacts += [first, on(along, [-v for v in normal])]
    return contacts + [bulged(rng, width)] * rng.randint(0, 1)


@kind("convex apices (OR)", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    apices = [any_of([-2, 0], [-1, 1], [-1, -1]), any_of([2, fraction(rng)], [1, rng.randint(1, 3)], [1, -1])]
    return apices[: rng.randint(1, 2)] + [bulged(rng, 2) for _ in range(rng.randint(1, 6))]


@kind("convex apices (OR)", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    contacts = [bulged(rng, 3) for _ in range(rng.randint(4, 14))]
    for _ in range(rng.randint(1, 3)):
        corner = [rng.choice([-1, 1]) for _ in range(3)]
        normals = [[s * int(i == k) for i in range(3)] for k, s in enumerate(corner)] + [corner]
        contacts.append(any_of(corner, *normals[: rng.randint(2, 4)]))
    return contacts


@kind("apices on a clamped box (OR)", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    edges = [any_of([1, 1, fraction(rng)], [1, 0, 0], [0, 1, 0]) for _ in range(rng.randint(1, 3))]
    return locators_321(rng) + clamps_321(rng)[: rng.randint(1, 3)] + edges


@kind("notches (AND)", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    notches = [on([fraction(rng), 1], [1, rng.randint(1, 3)], [-1, 1]) for _ in range(rng.randint(1, 3))]
    return notches + [bulged(rng, 2) for _ in range(rng.randint(0, 4))]


@kind("notches (AND)", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    grooves = [on([fraction(rng), fraction(rng), 1], [1, 0, 1], [-1, 0, 1]) for _ in range(rng.randint(1, 3))]
    grooves += [on([fraction(rng), fraction(rng), -1], [0, 1, -1], [0, -1, -1]) for _ in range(rng.randint(0, 3))]
    return grooves + [on_box(rng, 3) for _ in range(rng.randint(0, 5))]


@kind("coplanar pads", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    pads = [box_face(2, -1, fraction(rng, parts=4), fraction(rng, parts=4)) for _ in range(rng.randint(4, 12))]
    return pads + [on_box(rng, 3) for _ in range(rng.randint(0, 8))]


@kind("parallel pins", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    around = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]
    pins = [on([x, fraction(rng, parts=4), z], *around) for x in (-1, 1) for z in (-1, 1)[: rng.randint(1, 2)]]
    ends = [box_face(2, sign, fraction(rng), fraction(rng)) for sign in rng.choice([(), (-1,), (-1, -1, 1)])]
    return pins + ends


@kind("parallel pins", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    around = [(3, 4), (-4, 3), (-3, -4), (4, -3)][: rng.randint(2, 4)]
    return [on([x, fraction(rng, parts=4)], *around) for x in (-1, 1)[: rng.randint(1, 2)]]


@kind("single contact", "spatial")
def _(rng: Random) -> list[ExactContact]:
    return [rng.choice([bulged(rng, 3), any_of([1, 1, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1])])]


@kind("single contact", "planar")
def _(rng: Random) -> list[ExactContact]:
    return [rng.choice([bulged(rng, 2), any_of([1, 1], [1, 0], [0, 1]), on([0, 1], [1, 1], [-1, 1])])]


@kind("normals of wildly different lengths", "spatial", scales=(-3, 3))
def _(rng: Random) -> list[ExactContact]:
    contacts = rng.choice([locators_321(rng) + clamps_321(rng), [bulged(rng, 3) for _ in range(9)]])
    lengths = [Fraction(10) ** rng.randint(-6, 6) for _ in contacts]
    return [
        replace(c, clauses=tuple(tuple(tuple(f * v for v in n) for n in clause) for clause in c.clauses))
        for c, f in zip(contacts, lengths, strict=True)
    ]


@kind("hard fingers with friction", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    mu = Fraction(rng.randint(1, 9), 10)
    return [replace(bulged(rng, 3), friction=mu) for _ in range(rng.randint(2, 5))]


@kind("fingers on a ball with friction", "spatial", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    mu = Fraction(rng.randint(1, 9), 10)
    return [on(n, n, friction=mu) for n in (sphere_point(rng, 3) for _ in range(rng.randint(2, 4)))]


@kind("an apex with friction (OR)", "planar", tilted=True)
def _(rng: Random) -> list[ExactContact]:
    apex = any_of([-2, 0], [-1, 1], [-1, -1], friction=Fraction(rng.randint(0, 8), 10))
    others = [replace(on_box(rng, 2), friction=Fraction(rng.randint(0, 4), 10)) for _ in range(rng.randint(1, 4))]
    return [apex, *others]

"""Problems with known answers, transcribed, each with its source.

Verdicts: True, False, or None where the source says nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from fixture_design.contacts import Contact
from tests.exact import ExactContact

THESIS_2_7 = "S. Hirai, 1991, section 2.7, Figure 8, eqs. (2-64) to (2-77)"
CS237B = "Stanford CS237B, homework 2, problem 1, tests (numbers only)"
FORM_CLOSURE_M = "W. Kan, Form-Closure, comments of isFormClosure.m (numbers only)"

Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Figure8Verdict:
    """What the thesis says of some of Figure 8's contacts.

    Attributes:
        contacts: names; friction: of all of them.
        force_set_faces: face vectors of F (2-75).  in_a, in_interior: displacements in A and in its interior.
    """

    contacts: tuple[str, ...]
    form_closure: bool | None = None
    accessible: bool | None = None
    strongly_accessible: bool | None = None
    force_closure: bool | None = None
    friction: float = 0.0
    force_set_faces: tuple[Numbers, ...] | None = None
    in_a: Numbers | None = None
    in_interior: Numbers | None = None
    source: str = THESIS_2_7


#: Face vectors of (2-64), by the thesis's names.
FIGURE_8_FACE_VECTORS: dict[str, Numbers] = {
    "d11": (0, 1, 1),
    "d22": (-1, 1, -2),
    "d23": (-1, -1, 2),
    "d34": (0, -1, 0),
    "d44": (0, -1, -2),
    "d55": (1, 0, 0),
}

#: Contacts of Figure 8: point, alternatives as (normal, face vector).
FIGURE_8_CONTACTS: dict[str, tuple[Numbers, tuple[tuple[Numbers, str], ...]]] = {
    "P1": ((1, 1), (((0, 1), "d11"),)),
    "P2": ((-2, 0), (((-1, 1), "d22"), ((-1, -1), "d23"))),
    "P3": ((0, -1), (((0, -1), "d34"),)),
    "P4": ((2, -1), (((0, -1), "d44"),)),
    "P5": ((3, 0), (((1, 0), "d55"),)),
}

FIGURE_8_VERDICTS = (
    Figure8Verdict(
        ("P1", "P2", "P3", "P4"),
        form_closure=False,
        accessible=True,
        strongly_accessible=False,
        force_closure=False,
        force_set_faces=((1, 0, 0),),
        in_a=(1, 0, 0),
    ),
    Figure8Verdict(("P1", "P2", "P3", "P4", "P5"), form_closure=True, accessible=False, strongly_accessible=False),
    Figure8Verdict(
        ("P2", "P3", "P4"), form_closure=False, accessible=True, strongly_accessible=True, in_interior=(2, 1, 0)
    ),
    Figure8Verdict(("P1", "P3", "P4"), force_closure=True, friction=0.1),
    Figure8Verdict(("P1", "P3", "P4"), force_closure=True, friction=1e-4),
)

#: Of face{d11, d34, d44, d55} these are bidirectional, since 2 d11 + d34 + d44 = o (2-76).
FIGURE_8_BIDIRECTIONAL = {"faces": ("d11", "d34", "d44", "d55"), "balanced": {"d11": 2, "d34": 1, "d44": 1}}


def figure_8(names: tuple[str, ...], friction: float = 0.0) -> list[Contact]:
    """Some contacts of Figure 8."""
    contacts = []
    for name in names:
        point, alternatives = FIGURE_8_CONTACTS[name]
        clause = tuple(np.array(normal, dtype=float) for normal, _ in alternatives)
        contacts.append(Contact(name, "locator", np.array(point, dtype=float), (clause,), friction))
    return contacts


@dataclass(frozen=True)
class ClosureCase:
    """A published closure verdict, with normals as the source has them: into the body.

    Attributes:
        friction: one number a contact; None: form closure is asked, without friction.  rank: of the wrenches.
    """

    name: str
    points: tuple[Numbers, ...]
    normals_into_body: tuple[Numbers, ...]
    friction: tuple[float, ...] | None
    closed: bool
    source: str
    rank: int | None = None

    @property
    def contacts(self) -> list[Contact]:
        """As the package has them: normals out of the part."""
        return [
            Contact.on_facet(f"C{i + 1}", "locator", point, [-v for v in normal], mu)
            for i, (point, normal, mu) in enumerate(zip(self.points, self.normals_into_body, self._mu, strict=True))
        ]

    @property
    def exact_contacts(self) -> list[ExactContact]:
        """The same in rational numbers: the source's decimals."""
        return [
            ExactContact(
                tuple(Fraction(str(v)) for v in point),
                ((tuple(-Fraction(str(v)) for v in normal),),),
                Fraction(str(mu)),
            )
            for point, normal, mu in zip(self.points, self.normals_into_body, self._mu, strict=True)
        ]

    @property
    def _mu(self) -> tuple[float, ...]:
        return self.friction or (0.0,) * len(self.points)


def _three_planar(name: str, side: float, above: float, friction: float, closed: bool) -> ClosureCase:
    """Below with friction, at the right at height ``side``, above at x = ``above``: the threshold is c / h."""
    points = ((0, -0.5), (0.5, side), (above, 0.5))
    return ClosureCase(name, points, ((0, 1), (-1, 0), (0, -1)), (friction, 0.0, 0.0), closed, CS237B)


_HALF = 0.707106781187

CLOSURE_CASES = (
    ClosureCase(
        "four planar contacts in pairs",
        ((-1, -1), (0, -2), (1, 1), (0, 2)),
        ((1, 0), (0, 1), (-1, 0), (0, -1)),
        None,
        False,
        CS237B,
        rank=3,
    ),
    ClosureCase(
        "seven contacts on a cube",
        ((1, 0, -1), (1, -1, -1), (1, -1, -1), (-1, 1, 1), (-1, 1, 1), (-1, 1, 1), (1, 1, 1)),
        ((0, 0, 1), (-1, 0, 0), (0, 1, 0), (0, 0, -1), (1, 0, 0), (0, -1, 0), (0, 0, -1)),
        None,
        True,
        CS237B,
        rank=6,
    ),
    ClosureCase("two planar, one with friction", ((-1, 0), (1, 0)), ((1, 0), (-1, 0)), (1.0, 0.0), False, CS237B),
    ClosureCase("two planar, both with friction", ((-1, 0), (1, 0)), ((1, 0), (-1, 0)), (1.0, 1.0), True, CS237B),
    _three_planar("threshold 1/2, above", 0.0, 0.25, 0.501, True),
    _three_planar("threshold 1/2, below", 0.0, 0.25, 0.499, False),
    _three_planar("threshold 2/7, above", 0.2, 0.2, 0.286714, True),
    _three_planar("threshold 2/7, below", 0.2, 0.2, 0.284714, False),
    _three_planar("threshold 2/3, above", -0.2, 0.2, 0.667667, True),
    _three_planar("threshold 2/3, below", -0.2, 0.2, 0.665667, False),
    ClosureCase(
        "three spatial with friction 1",
        ((-1, 0, 0), (0, 0, -1), (0, 0, 1)),
        ((1, 0, 0), (0, 0, 1), (0, 0, -1)),
        (1.0, 1.0, 1.0),
        True,
        CS237B,
    ),
    ClosureCase(
        "four corners of a rectangle",
        ((1.5, 1), (-1.5, 1), (-1.5, -1), (1.5, -1)),
        ((-_HALF, -_HALF), (_HALF, -_HALF), (_HALF, _HALF), (-_HALF, _HALF)),
        None,
        True,
        FORM_CLOSURE_M,
    ),
)

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

#: Table 4: contact states whose equations were chosen a priori, by their contacts.
FIGURE_14_TABLE_4: tuple[tuple[str, ...], ...] = (
    (),
    ("apex 3 - facet 5",),
    ("facet 2 - apex 1",),
    ("apex 4 - facet 7", "facet 2 - apex 1"),
    ("apex 4 - facet 7",),
    ("apex 3 - facet 5", "apex 4 - facet 5"),
    ("apex 3 - facet 8", "apex 4 - facet 8"),
    ("apex 3 - facet 6",),
    ("apex 3 - facet 6", "facet 4 - apex 2"),
    ("facet 4 - apex 2",),
    ("apex 4 - facet 8",),
)

#: Table 5: configurations [x, y, theta] of three of these states, to five or six digits.
FIGURE_14_TABLE_5: dict[str, tuple[Numbers, ...]] = {
    "N2": (
        (-1.83164, 0.998921, 1.52434),
        (-2.77709, 0.633807, 0.686465),
        (-2.89437, 0.0569517, 0.0569825),
        (-3.32054, 0.996523, 1.48738),
        (-1.88392, 0.557976, 0.591945),
        (-3.59624, 0.600891, 0.644615),
        (-2.44534, 0.204418, 0.205869),
        (-1.85565, 0.986096, 1.40384),
        (-1.77021, 0.997336, 1.49779),
        (-1.98365, 0.225795, 0.227759),
    ),
    "N3": (
        (-0.126021, 0.244488, 0.94804),
        (-0.365466, -3.88133, 0.0344948),
        (-0.278171, 0.620316, 1.22258),
        (-0.777667, 0.695846, 0.843813),
        (-0.115079, -1.29941, 0.262679),
        (-0.510564, 0.180663, 0.287996),
        (0.885466, 0.944987, 1.54763),
        (0.321822, -2.08112, 0.349131),
        (-0.475391, 0.32081, 0.676007),
        (-0.868446, 0.775385, 0.896344),
    ),
    "N4": (
        (0.707289, -1.22989, 0.655554),
        (0.832624, -0.747578, 0.840117),
        (0.658549, -1.51076, 0.570833),
        (0.673465, -1.41493, 0.597872),
        (0.536717, -3.58277, 0.271824),
        (0.833291, -0.745488, 0.841012),
        (0.743821, -1.06474, 0.713343),
        (0.666844, -1.45617, 0.586007),
        (0.720476, -1.1669, 0.676891),
        (0.536676, -3.58491, 0.271671),
    ),
}
FIGURE_14_TABLE_5_CONTACTS: dict[str, tuple[str, ...]] = {
    "N2": ("apex 3 - facet 5",),
    "N3": ("facet 2 - apex 1",),
    "N4": ("apex 4 - facet 7", "facet 2 - apex 1"),
}

#: Table 6: face vectors of the measurement sets, N2 to N4 one cone for all of Table 5's samples; scaled to a largest
#: component of 1, in the order in which Table 7 drops them.
FIGURE_14_TABLE_6: dict[str, tuple[Numbers, ...]] = {
    "N1": ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, -1), (0, -1, 0), (-1, 0, 0)),
    "N2": ((1, 0, 0), (-1, 0, 0), (0, -0.04644, -1), (0, 0.998377, 1)),
    "N3": (
        (-0.30396, 1, -0.068729),
        (1, 0.592024, 0.260282),
        (1, -0.610791, -0.248616),
        (1, -0.804673, -0.44315),
        (-0.142827, 0.102581, -1),
    ),
    "N4": (
        (-1, -0.138369, -0.377961),
        (-1, -0.287817, -0.417221),
        (-0.895973, -1, -0.60046),
        (-1, -0.755479, -0.550071),
        (-1, 0.67478, -0.195623),
        (-1, 0.036819, -0.337039),
        (-1, -0.012028, -0.348241),
        (-0.663462, 1, -0.092698),
        (-0.319406, -1, -0.428551),
        (0, 1, 0),
        (-1, -0.400926, -0.448018),
        (0.019246, 1, 0.071721),
    ),
}

#: Table 6 from Table 5: how far its face vectors are from those computed here. Table 5 has five or six digits, and the
#: two contacts of N4 are nearly opposed.
FIGURE_14_TABLE_6_ROUNDING: dict[str, float] = {"N2": 1e-5, "N3": 1e-5, "N4": 3.1e-3}

#: T_i of section 4.7, and Table 7: the faces of S_j that detect a transition from N_i to N_j.
FIGURE_14_SUCCESSORS: dict[str, tuple[str, ...]] = {"N1": ("N1", "N2", "N3"), "N2": ("N2", "N3"), "N3": ("N3", "N4")}
FIGURE_14_TABLE_7: dict[tuple[str, str], tuple[Numbers, ...]] = {
    ("N1", "N1"): ((-1, 0, 0), (0, -1, 0)),
    ("N1", "N2"): ((-1, 0, 0),),
    ("N1", "N3"): ((1, -0.804673, -0.44315),),
    ("N2", "N2"): ((-1, 0, 0),),
    ("N2", "N3"): ((1, -0.804673, -0.44315),),
    ("N3", "N3"): ((1, 0.592024, 0.260282), (1, -0.610791, -0.248616)),
    ("N3", "N4"): tuple(row for row in FIGURE_14_TABLE_6["N4"] if row != (0, 1, 0)),
}

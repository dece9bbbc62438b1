"""Small layouts as text, each with one outcome."""

HEAD = "schema: fixture_design/layout/1\n"

#: Figure 8 of the thesis without an apex: P2, P3 and P4 locate and let go; with P1 they hold as well.
LOCATORS = f"""{HEAD}space: planar
contacts:
  - {{name: P2, role: locator, point: [-1, 0], normal: [0, -1]}}
  - {{name: P3, role: locator, point: [1, 0], normal: [0, -1]}}
  - {{name: P4, role: locator, point: [-2, 0.5], normal: [-1, 0]}}
"""
NOTHING_REQUIRED = LOCATORS
HOLDS = LOCATORS + "require: {locators: [deterministic, strongly_accessible]}\n"
FAILS = LOCATORS + "require: {all: [form_closure]}\n"
UNDECIDED = LOCATORS + "require: {locators: [accurate]}\n"
BAD = LOCATORS + "require: {all: [form_closur]}\n"

#: A tetrahedron of a metre, and one without its last face.
CLOSED_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
OPEN_OBJ = CLOSED_OBJ.removesuffix("f 1 4 3\n")


def on_part(part: str, at: str = "[0.2, 0.2, 0]") -> str:
    """A layout of one locator on a part."""
    return f"{HEAD}part: {part}\nelements:\n  - {{name: L1, role: locator, at: {at}}}\n"


def contact(keys: str, space: str = "spatial") -> str:
    """A layout of one contact, on line 4."""
    return f"{HEAD}space: {space}\ncontacts:\n  - {{name: Q1, role: locator, {keys}}}\n"

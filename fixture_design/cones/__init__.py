"""Theory of polyhedral convex cones (thesis 2.4, 2.5, 2.8): one class, its two forms, and the thesis's operations.

Cones know nothing of contacts: everything here is about vectors in R^d.
"""

from fixture_design.cones.bidirection import bidirectional
from fixture_design.cones.cone import PolyhedralConvexCone
from fixture_design.cones.convert import convert, convert_both, convert_rows
from fixture_design.cones.membership import element, equal, interior, nonzero, subset
from fixture_design.cones.polar import convex_sum, dual, intersect
from fixture_design.cones.reduction import reduce
from fixture_design.cones.union import ConeUnion, union_dual, union_element, union_interior, union_nonzero

__all__ = [
    "ConeUnion",
    "PolyhedralConvexCone",
    "bidirectional",
    "convert",
    "convert_both",
    "convert_rows",
    "convex_sum",
    "dual",
    "element",
    "equal",
    "interior",
    "intersect",
    "nonzero",
    "reduce",
    "subset",
    "union_dual",
    "union_element",
    "union_interior",
    "union_nonzero",
]

"""The decisions that everything else waits for, behind one interface of a few functions.

* `double_description`: both forms of a cone, with incidence; `DoubleDescription.add_row` goes on from any of them.
* `tucker_partition`: which rows balance and which motion leaves the others: closure, interior, membership, redundancy.
* `minimum_norm_point`: the nearest point of a hull to the origin, for margins.
* `singular_directions`: ranks and null spaces.
* `nonnegative_least_squares`: the nearest point of a cone to a vector.
* `closure_test`, `closure_tests`, `membership_tests`: closure, strong accessibility, membership without CONVERT, of one
  set of rows or hundreds of thousands; `branch_sets` lists the branches of a union for them.
* `faces_of`, `exact_faces`: all faces of a cone, which are the contact modes.
* `balance_guesses`: how many times loads can be held by pushes in second-order cones, for `second_order` to prove.
* `exact_*`: the same in rational arithmetic, for rational data.

They take unit rows and a relative zero, and report the values they decided on. Each comes twice: in numpy, to read, and
in Rust (src/), much faster, where that was built; `NAME` says which runs, and `using` chooses (`choice`).
"""

from fixture_design.cones.kernel.balance import Guesses, balance_guesses
from fixture_design.cones.kernel.branches import branch_sets
from fixture_design.cones.kernel.choice import NAME, available, using
from fixture_design.cones.kernel.closure import (
    Closure,
    Closures,
    Membership,
    Memberships,
    closure_bound,
    closure_test,
    closure_tests,
    membership_test,
    membership_tests,
)
from fixture_design.cones.kernel.directions import singular_directions
from fixture_design.cones.kernel.double_description import MAX_RAYS, DoubleDescription, double_description
from fixture_design.cones.kernel.exact import (
    ExactDescription,
    ExactPartition,
    exact_closure_sign,
    exact_closure_signs,
    exact_double_description,
    exact_tucker_partition,
    integer_rows,
)
from fixture_design.cones.kernel.minimum_norm import minimum_norm_point
from fixture_design.cones.kernel.modes import MAX_FACES, Faces, exact_faces, faces_of
from fixture_design.cones.kernel.nonnegative import nonnegative_least_squares
from fixture_design.cones.kernel.tucker import TuckerPartition, tucker_partition

__all__ = [
    "MAX_FACES",
    "MAX_RAYS",
    "NAME",
    "Closure",
    "Closures",
    "DoubleDescription",
    "ExactDescription",
    "ExactPartition",
    "Faces",
    "Guesses",
    "Membership",
    "Memberships",
    "TuckerPartition",
    "available",
    "balance_guesses",
    "branch_sets",
    "closure_bound",
    "closure_test",
    "closure_tests",
    "double_description",
    "exact_closure_sign",
    "exact_closure_signs",
    "exact_double_description",
    "exact_faces",
    "exact_tucker_partition",
    "faces_of",
    "integer_rows",
    "membership_test",
    "membership_tests",
    "minimum_norm_point",
    "nonnegative_least_squares",
    "singular_directions",
    "tucker_partition",
    "using",
]

"""Fixtures and grasps from the theory of polyhedral convex cones (S. Hirai, doctoral thesis, Kyoto University, 1991).

Architecture
============

A part touched by a fixture may move a little or not at all. Every contact forbids half a space of small motions, so the
motions that are left form a union of polyhedral convex cones, and the loads that the contacts can balance form the
polar cone. Every question (does it locate, does it come out, does it hold) is a question about these cones::

    URDF part + fixture --signed distance--> contacts --> cones --> verdicts with evidence

The folders state the theory, and each imports only from those to its right::

    cli > batch > viewing > io > simulation > grasp > design | recognition > assembly > verification
        > geometry | analysis > layout > contacts > cones > arrays | errors | tolerances

* `cones`: the polyhedral convex cone, its two forms, and the operations of sections 2.4, 2.5 and 2.8. `cones.kernel`
  has the decisions everything waits for: double description (CONVERT), Tucker's partition (which rows balance), and the
  point of a hull nearest to the origin; in numpy and, where it was built, in Rust. `cones.thesis` is CONVERT as the
  thesis has it, for comparison.
* `contacts`: a contact is a point and an AND of ORs of normals; face vectors, friction cones; `Constraints` are the
  same as flat arrays.
* `layout`: the nouns: part, element, layout, group, verdict.
* `analysis`: one file a question: form closure, accessibility, force closure, determinacy, hybrid control. Unions are
  searched, not listed (`branches`); every answer comes with bounds on the margin that prove it (`bounds`). Forces:
  `contact_forces` are cones, `loads` asks a solver for balances, `balances` makes exact ones of its suggestions, and
  `holding`, `seating`, `preloads` and `stiffness` are the questions.
* `geometry`: parts from URDF, meshes and polygons, their facets and round surfaces (`geometry.smooth_regions`);
  contacts of tips (points, balls, pads, lines, pins) through Drake's signed distance, and from polygons; of fixture
  bodies all there are (`geometry.bodies`), each from the tangent cones of both sides (`contacts.polyhedral`); the part
  posed among bodies, candidate points on its surface, sliding over it.
* `verification`: layout in, verdict out; and a checker that confirms the evidence without a solver.
* `assembly`: which contacts two parts can have and which can follow which: the contact state graph.
* `design`: elements added, moved and removed until the conditions hold: exchange search for locators, hitting sets with
  cuts for the fewest clamps and the proof, circuits that bind and motions that are free for the record.
* `grasp`: hands in Drake, what they touch as layouts, the search for grasps that close and can be reached.
* `recognition`: contact states from measured forces and displacements: measurement sets, discriminants, classifier.
* `simulation`: assemblies in Drake with true contact states, recognition as a Drake system, and the loop closed by it.
* `io`: files. `viewing`: evidence in words, the sheet to sign, the scene to look at (`viewing.scene`) as a page or a
  picture; `viewing.session` changes a layout in the browser. `batch`: thousands of layouts in worker processes.
  `cli`: the command line.

How an answer is decided
========================

For rows d_i scaled to unit length, s = min over |u| = 1 of max_i d_i . u is positive if and only if they close,
negative if and only if some motion leaves them all, and zero in the degenerate cases that real fixtures are full of.
s moves no more than the rows do. Weights that balance bound it from below, a motion bounds it from above; an answer is
given where a bound clears the band around zero (`tolerances`), and is *undecided* otherwise, with the reason. Exact
arithmetic on rounded coordinates would answer another question, so ties are ties within the tolerance.

Conventions
===========

SI units and radians; everything in a file is in the world frame W. A displacement is [dx; dtheta], a wrench [f; m],
moments and rotations about W's origin; planar: [dx, dy, dtheta], [fx, fy, m]. A contact's normal is the part's outward
normal: d = [n; x X n], admissible motions have d . dq <= 0, and the contact pushes the part along -n.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fixture_design.packages import loaded_later
from fixture_design.version import VERSION as __version__

if TYPE_CHECKING:
    from fixture_design.assembly import Assembly, ContactStateGraph, state_at, state_graph
    from fixture_design.batch import verify_batch
    from fixture_design.cones import PolyhedralConvexCone
    from fixture_design.contacts import Contact
    from fixture_design.design import DesignResult, Task, design, repair
    from fixture_design.grasp import GraspResult, grasp
    from fixture_design.io import (
        read_assembly,
        read_classifier,
        read_graph,
        read_hand,
        read_layout,
        read_log,
        read_task,
        task_of_part,
        write_classifier,
        write_graph,
        write_layout,
    )
    from fixture_design.layout import Layout, Verdict
    from fixture_design.recognition import Classifier, Recogniser, build_classifier
    from fixture_design.verification import check, contacts_of, verify
    from fixture_design.viewing import interactive, preview

#: Public names and the module each comes from; loaded when first asked for, so that `import fixture_design` is cheap.
_HOME = {
    "Assembly": "assembly",
    "Classifier": "recognition",
    "Contact": "contacts",
    "ContactStateGraph": "assembly",
    "DesignResult": "design",
    "GraspResult": "grasp",
    "Layout": "layout",
    "PolyhedralConvexCone": "cones",
    "Recogniser": "recognition",
    "Task": "design",
    "Verdict": "layout",
    "build_classifier": "recognition",
    "check": "verification",
    "contacts_of": "verification",
    "design": "design",
    "grasp": "grasp",
    "interactive": "viewing",
    "preview": "viewing",
    "read_assembly": "io",
    "read_classifier": "io",
    "read_graph": "io",
    "read_hand": "io",
    "read_layout": "io",
    "read_log": "io",
    "read_task": "io",
    "repair": "design",
    "state_at": "assembly",
    "state_graph": "assembly",
    "task_of_part": "io",
    "verify": "verification",
    "verify_batch": "batch",
    "write_classifier": "io",
    "write_graph": "io",
    "write_layout": "io",
}

__all__ = [
    "Assembly",
    "Classifier",
    "Contact",
    "ContactStateGraph",
    "DesignResult",
    "GraspResult",
    "Layout",
    "PolyhedralConvexCone",
    "Recogniser",
    "Task",
    "Verdict",
    "__version__",
    "build_classifier",
    "check",
    "contacts_of",
    "design",
    "grasp",
    "interactive",
    "preview",
    "read_assembly",
    "read_classifier",
    "read_graph",
    "read_hand",
    "read_layout",
    "read_log",
    "read_task",
    "repair",
    "state_at",
    "state_graph",
    "task_of_part",
    "verify",
    "verify_batch",
    "write_classifier",
    "write_graph",
    "write_layout",
]

__getattr__ = loaded_later(__name__, _HOME)


def __dir__() -> list[str]:
    return sorted(__all__)

"""Manipulation problems (thesis 2.3, 2.6): what a set of contacts allows, forbids and can hold."""

from fixture_design.analysis.accessibility import accessible, strongly_accessible
from fixture_design.analysis.accuracy import accurate
from fixture_design.analysis.admissible_sets import (
    admissible_displacements,
    admissible_forces,
    bidirectional_contacts,
    displacements_in_world,
    forces_in_world,
)
from fixture_design.analysis.determinacy import deterministic
from fixture_design.analysis.force_closure import force_closure
from fixture_design.analysis.form_closure import form_closure
from fixture_design.analysis.hybrid_control import HybridControl, classify_pair, commanded_pair, hybrid_control
from fixture_design.analysis.restraint import Restraint

__all__ = [
    "HybridControl",
    "Restraint",
    "accessible",
    "accurate",
    "admissible_displacements",
    "admissible_forces",
    "bidirectional_contacts",
    "classify_pair",
    "commanded_pair",
    "deterministic",
    "displacements_in_world",
    "force_closure",
    "forces_in_world",
    "form_closure",
    "hybrid_control",
    "strongly_accessible",
]

"""Design: elements added, moved and removed until the conditions hold, and the proof that fewer do not."""

from fixture_design.design.design import design
from fixture_design.design.repair import repair
from fixture_design.design.result import Bound, ChangeBound, DesignResult
from fixture_design.design.steps import Step
from fixture_design.design.task import CandidateRules, Grid, Limits, Objective, PinRules, Task
from fixture_design.design.ways import Progress, Ways
from fixture_design.packages import called_as

__all__ = [
    "Bound",
    "CandidateRules",
    "ChangeBound",
    "DesignResult",
    "Grid",
    "Limits",
    "Objective",
    "PinRules",
    "Progress",
    "Step",
    "Task",
    "Ways",
    "design",
    "repair",
]

# as `fd.design` it is this package once anything has imported it
called_as(__name__, design)

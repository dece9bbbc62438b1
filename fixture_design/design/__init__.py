"""Design: elements added, moved and removed until the conditions hold, and the proof that fewer do not."""

import sys
from types import ModuleType

from fixture_design.design.design import design
from fixture_design.design.repair import repair
from fixture_design.design.result import Bound, ChangeBound, DesignResult
from fixture_design.design.steps import Step
from fixture_design.design.task import CandidateRules, Grid, Limits, Objective, PinRules, Task
from fixture_design.design.ways import Progress, Ways

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


class _Callable(ModuleType):
    """`fixture_design.design` is this package once anything has imported it; `fd.design(task)` works all the same."""

    __call__ = staticmethod(design)


sys.modules[__name__].__class__ = _Callable

"""`accurate` on what search and batch ask about most: six tips; three tips, a round and a diamond pin; three pads."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fixture_design.analysis import accurate
from fixture_design.layout import Answer
from tests.analysis.locators import ACROSS_X, ROUND, THREE_TWO_ONE, UNDER, feature, layout_of, pad, pin

Benchmark = Callable[..., Any]
PINS = [*UNDER, *pin("P", [0.02, 0.04, 0.01], 0.004, 2e-5, ROUND), *pin("Q", [0.08, 0.04, 0.01], 0.004, 2e-5, ACROSS_X)]
PADS = [
    corner
    for name, at in zip("ABC", ((0.01, 0.01, 0), (0.09, 0.01, 0), (0.05, 0.06, 0)), strict=True)
    for corner in pad(name, at, 0.01)
]
CASES = {"six tips": list(THREE_TWO_ONE), "plane and two pins": PINS, "three pads": [*PADS, *THREE_TWO_ONE[3:]]}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.benchmark(group="accurate, one feature")
def test_accurate(benchmark: Benchmark, name: str) -> None:
    bore = feature([0.05, 0.04, 0.03], [0, 0.6, 0.8], 1e-3)
    layout, group = layout_of(CASES[name], dict.fromkeys("ABCDEFPQ", 1e-5), [bore], center=[0.05, 0.03, 0.02])
    assert benchmark(accurate, layout, group, np.zeros(3)).answer is Answer.YES

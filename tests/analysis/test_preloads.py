"""The least preloads hold, and less does not."""

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.analysis.acting import LoadRow
from fixture_design.analysis.preloads import least_preloads
from fixture_design.layout import Answer, Element, Load
from fixture_design.tolerances import DEFAULT
from tests.analysis.forces import across, asked, block, held, opposed

ZERO = np.zeros(6)


def test_two_opposed_clamps():
    """80 N across with friction 0.2 on both sides need 200 N."""
    found = least_preloads(opposed(), {"K": 300.0}, {"K": (0.0, 500.0)}, ZERO, [across(80.0)], DEFAULT)
    assert found["K"] == pytest.approx(200.0, rel=1e-3)
    assert held(opposed(), found, across(80.0)).answer is Answer.YES
    assert held(opposed(), {"K": found["K"] * 0.999}, across(80.0)).answer is Answer.NO


def test_limits():
    rows = [across(80.0)]
    assert least_preloads(opposed(), {}, {"K": (0.0, 150.0)}, ZERO, rows, DEFAULT) is None
    assert least_preloads(opposed(), {}, {"K": (250.0, 300.0)}, ZERO, rows, DEFAULT)["K"] == pytest.approx(250.0)
    assert least_preloads(opposed(), {"K": 200.0}, {}, ZERO, rows, DEFAULT) is None


def test_a_path_of_loads():
    """The largest of many rows counts."""
    rows = [
        LoadRow("path", i, np.array([0, 80 * np.sin(a), 80 * np.cos(a), 0, 0, 0]))
        for i, a in enumerate(np.linspace(0, 3, 30))
    ]
    rows.append(across(100.0))
    found = least_preloads(opposed(), {}, {"K": (0.0, 500.0)}, ZERO, rows, DEFAULT)
    assert found["K"] == pytest.approx(250.0, rel=1e-3)


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_a_block_with_three_clamps(friction):
    """All loads are held with the least preloads, and not with a hundredth less of them all."""
    loads = (
        Load("cut", np.array([0.1, 0.05, 0.05]), np.array([30.0, 50, -20])),
        Load("back", np.array([0.1, 0.05, 0.05]), np.array([-30.0, 20, 60])),
    )
    layout = block({"K1": 200.0, "K2": 100.0, "K3": 100.0}, friction, loads=loads)
    free = tuple(replace(element, limits=(0.0, 500.0)) for element in layout.elements)
    least = asked(replace(layout, elements=free), "holds_loads").use.least_preloads
    assert sum(least.values()) < 400
    for factor, answer in ((1.0, Answer.YES), (0.99, Answer.NO)):
        pushed = tuple(replace(element, preload=least[element.name] * factor) for element in free)
        assert asked(replace(layout, elements=pushed), "holds_loads").answer is answer


def test_given_preloads_stay():
    layout = block({"K1": 200.0, "K2": 100.0}, 0.2, loads=(Load("cut", np.zeros(3), np.array([0, 60.0, 0])),))
    elements = (layout.elements[0], Element("K2", "clamp", np.zeros(3), preload=100.0, limits=(0.0, 500.0)))
    least = asked(replace(layout, elements=elements), "holds_loads").use.least_preloads
    assert set(least) == {"K2"}

"""Limits of preloads within which nothing holds the loads: said at once, from the bound alone."""

from __future__ import annotations

from typing import Never

import numpy as np
import pytest

from fixture_design.design import Limits, Task, design, search
from fixture_design.layout import Answer, Load, Part, Pose

RECTANGLE = np.array([[0.0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])


def test_no_layout_is_searched_for_where_the_bound_says_that_none_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    def searched(*_: object) -> Never:
        raise AssertionError("the bound was known")

    monkeypatch.setattr(search, "_better_within", searched)
    # whichever way it comes out, a load pulls it there
    pulls = [(300.0, 0.0), (-300.0, 0.0), (0.0, 300.0), (0.0, -300.0)]
    loads = tuple(Load(f"pull {k}", point=np.array([0.1, 0.05]), force=np.array(f)) for k, f in enumerate(pulls))
    require = {"locators": ("deterministic", "strongly_accessible", "loadable"), "all": ("form_closure", "holds_loads")}
    part = Part("polygon", "polygon", None, RECTANGLE, 1.0, Pose.identity(2))
    limits = Limits(preload=(0.0, 1.0))
    result = design(Task("plate", part, "planar", require=require, loads=loads, limits=limits))
    assert result.satisfied is Answer.NO
    assert "preload" in (result.reason or "")

"""Parts that sit on their locators although friction may rub: sets with clamps square against the faces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from fixture_design.analysis.seating import seating
from fixture_design.contacts import Contact
from fixture_design.design import CandidateRules, Limits, Task, design
from fixture_design.design.duties import Duties
from fixture_design.design.problem import Problem
from fixture_design.design.regions import regions_of
from fixture_design.design.rubbing import seated
from fixture_design.design.square import square_sets
from fixture_design.layout import Answer, Load, Part, Pose, Seating
from fixture_design.verification import check
from tests.design.fakes import box, candidates

DOWN = np.array([0.0, 0.0, -5.0, 0.0, 0.0, 0.0])


def box_problem(friction: float, seed: int) -> Problem:
    some = candidates(box(10, seed), friction)
    count = len(some)
    limits = (np.full(count, 1.0), np.full(count, np.inf), np.zeros(count))
    push = np.array([10.0, 5.0, 0.0, 0.0, 0.0, 0.0])
    duties = Duties.of(DOWN, [push], some.scale, limits, np.ones(count, dtype=bool), seated=True, required=True)
    return Problem(some, Limits(), ("fewest", "preload"), duties=duties)


@pytest.mark.parametrize(("friction", "seed"), [(0.1, 0), (0.1, 1), (0.1, 2), (0.3, 0)])
def test_square_sets_are_pressed_as_the_verdict_says(friction: float, seed: int) -> None:
    problem = box_problem(friction, seed)
    points, normals = problem.candidates.points[:, 0], problem.candidates.normals[:, 0]
    yes = 0
    for region in regions_of(problem, 0)[0]:
        for locators, clamps in square_sets(problem, region, np.random.default_rng(0)):
            found = seated(problem, locators, clamps)
            if found is None:
                continue
            contacts = [Contact(f"L{i}", "locator", points[i], ((normals[i],),), friction) for i in locators.tolist()]
            contacts += [Contact(f"K{i}", "clamp", points[i], ((normals[i],),), friction) for i in clamps.tolist()]
            pushes = {f"K{clamps[k]}": float(found.pushes[k]) for k in found.order}
            finding = seating(contacts, pushes, DOWN)
            assert finding.answer is Answer.YES, finding.reason
            assert isinstance(finding.use, Seating)
            # pyramids around the cones leave friction more than it may do
            least = found.bounds.at(found.pushes)
            seen = [max(step.reactions[f"L{i}"][0] for step in finding.use.steps) for i in locators.tolist()]
            assert (least <= np.array(seen) + 1e-6 * sum(pushes.values())).all()
            yes += 1
        if yes:
            break
    assert yes


def test_a_part_that_is_to_sit_with_friction_gets_clamps_square_against_its_faces(tmp_path: Path) -> None:
    file = tmp_path / "box.stl"
    trimesh.creation.box((0.1, 0.06, 0.04)).export(file)
    part = Part("box", "mesh", file, None, 1.0, Pose.identity(3), mass=0.5)
    cut = Load("cut", point=np.array([0.0, 0.0, 0.02]), force=np.array([50.0, 30.0, -40.0]))
    task = Task(
        "box", part, "spatial", gravity=np.array([0.0, 0.0, -9.81]), friction=0.2, loads=(cut,),
        require={"locators": ("deterministic", "loadable"), "all": ("force_closure", "holds_loads", "seated")},
        limits=Limits(preload=(0.0, 500.0), loading=DOWN[:3]),
        candidates=CandidateRules(spacing=0.025), objective=("fewest",),
    )  # fmt: skip
    result = design(task)
    assert result.satisfied is Answer.YES, result.reason
    assert result.verdict is not None
    assert check(result.verdict) == []

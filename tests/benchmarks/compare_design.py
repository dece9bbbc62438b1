"""Design against a rule of thumb and against restarts of plain exchange, on public parts with 5,000 candidates each.

By hand: `python -m tests.benchmarks.compare_design [PART ...]`. The figure is the worst error at three key features for
errors of 1 along the locators' normals. *Rule of thumb*: the widest 3-2-1 on the largest faces. *Plain exchange*: a
random way out, random locators, exchanges until none is better, clamps one after the other; ten times, or for as long
as the design took if that is longer (processor time). *Bound*: no locators with a way out have less.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design import CandidateRules, Task, design
from fixture_design.design.adding import added
from fixture_design.design.clamping import closes
from fixture_design.design.features import features_of
from fixture_design.design.fitting import fitting
from fixture_design.design.locating import exchanged, inaccuracy, independent
from fixture_design.design.plans import by_certainty
from fixture_design.design.problem import Problem
from fixture_design.design.regions import ways_out
from fixture_design.design.touching import candidates_of
from fixture_design.layout import Answer, KeyFeature, Load, Part, Pose
from fixture_design.verification.surface import PartSurface
from tests.geometry.parts import SHARED

#: Spots wanted (edges leave about half of them, and those on round surfaces are left out where they can be); restarts.
CANDIDATES, RESTARTS = 10_000, 10
MM, INCH = 0.001, 0.0254
MODELS, EDU = "trimesh/models", "example-robot-data/example-robot-data/robots/finger_edu_description/meshes"
FINGERTIPS = "airo-models/airo_models/grippers/fingertips/originals"
GRIPPER = "airo-models/airo_models/grippers/robotiq_2f_85/meshes/collision"
PEGS = "IsaacGymEnvs/assets/factory/mesh/factory_insertion"
PARTS = (
    (f"{MODELS}/featuretype.STL", INCH),
    (f"{MODELS}/angle_block.STL", INCH),
    (f"{MODELS}/plate_holes.STL", MM),
    (f"{MODELS}/7_8ths_cube.stl", MM),
    (f"{MODELS}/octagonal_pocket.stl", MM),
    (f"{EDU}/base_front.stl", 1.0),
    (f"{EDU}/base_side_left.stl", 1.0),
    (f"{FINGERTIPS}/backing.stl", MM),
    (f"{FINGERTIPS}/pcb_top_cover3.STL", MM),
    (f"{FINGERTIPS}/robotiq_adapter.stl", MM),
    (f"{GRIPPER}/robotiq_arg2f_85_inner_finger.obj", MM),
    (f"{PEGS}/factory_rectangular_hole_8mm_subdiv_3x.obj", 1.0),
)


@dataclass(frozen=True)
class Row:
    """One part's figures: errors at the key features [-], clamps, seconds."""

    part: str
    candidates: int
    ours: float
    clamps: int
    bound: float | None
    seconds: float
    thumb: float | None
    exchange: tuple[int, float] | None


def task_of(file: Path, scale: float) -> tuple[Task, PartSurface]:
    part = Part(file.stem, "mesh", file, None, scale, Pose.identity(3))
    surface = PartSurface(part, 1e-5)
    geometry = surface.geometry
    corners = geometry.vertices[geometry.triangles]  # type: ignore[union-attr]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    low, high = geometry.vertices.min(axis=0), geometry.vertices.max(axis=0)
    at = low + (high - low) * np.array([[0.2, 0.3, 0.8], [0.7, 0.8, 0.4], [0.6, 0.2, 0.3]])
    features = tuple(KeyFeature(f"F{k}", at[k], np.eye(3)[k], 1.0) for k in range(3))
    path = tuple(
        Load(f"cut {k}", point=at[k], force=np.array(force))
        for k, force in enumerate(([100.0, 0, -50], [-100.0, 0, -50], [0, 100.0, -50]))
    )
    task = Task(
        file.stem, part, candidates=CandidateRules(spacing=float(np.sqrt(area / CANDIDATES))), key_features=features,
        loads=path, objective=("fewest", "accuracy", "preload"),
    )  # fmt: skip
    return task, surface


def problem_of(task: Task, surface: PartSurface) -> Problem:
    """The same candidates as the design has; that elements may not run into each other binds the design alone."""
    everything, _ = candidates_of(task, surface, surface.spots(task.candidates, 0))
    candidates = next(iter(by_certainty(fitting(task, surface, everything)[0])))
    return Problem(candidates, task.limits, task.objective, features=features_of(task, candidates))


def by_thumb(problem: Problem) -> float | None:
    """Three far apart on the largest face, two on the next one across it, one on the next across both."""
    candidates = problem.candidates
    normals, names = candidates.normals[:, 0], np.array(candidates.features)
    faces = sorted({*candidates.features}, key=lambda name: -int((names == name).sum()))
    chosen: list[int] = []
    taken: list[np.ndarray] = []
    for count in (3, 2, 1):
        for face in faces:
            on_it = np.flatnonzero(names == face)
            across = all(abs(float(normals[on_it[0]] @ other)) < 0.1 for other in taken)
            if across and len(on_it) >= count:
                chosen += _far_apart(candidates.places[on_it], on_it, count)
                taken.append(normals[on_it[0]])
                break
    if len(chosen) < 6 or np.linalg.matrix_rank(problem.rows[chosen], 1e-7) < 6:
        return None
    assert problem.features is not None
    return inaccuracy(problem.rows, problem.features, np.array(chosen))


def _far_apart(places: np.ndarray, which: Indices, count: int) -> list[int]:
    hull = [int(np.argmax(places @ d)) for d in np.random.default_rng(0).normal(size=(60, 3))]
    sets = list(combinations(sorted(set(hull)), count)) or [tuple(range(count))]

    def spread(some: tuple[int, ...]) -> float:
        if count < 3:
            return float(np.linalg.norm(np.ptp(places[list(some)], axis=0)))
        a, b, c = places[list(some)]
        return float(np.linalg.norm(np.cross(b - a, c - a)))

    return which[list(max(sets, key=spread))].tolist()


def by_exchange(problem: Problem, least_time: float) -> tuple[int, float] | None:
    """The best of some restarts: fewest clamps, then the smallest error."""
    ways = [allowed for _, allowed in ways_out(problem, 0)[0]]
    rng, best, tries, start = np.random.default_rng(0), None, 0, time.process_time()
    assert problem.features is not None
    while tries < RESTARTS or time.process_time() - start < least_time:
        tries += 1
        pool = np.flatnonzero(ways[rng.integers(len(ways))])
        first = independent(problem.rows, pool, (), rng, 6) if len(pool) >= 6 else pool[:0]
        if len(first) < 6:
            continue
        locators = exchanged(problem.rows, pool, first, (), problem.features)
        others = np.setdiff1d(np.arange(len(problem.candidates)), locators)
        clamps = [index for index, _ in added(problem.closing_rows, locators, others)]
        if closes(problem.closing_rows, [*locators, *clamps]):
            found = (len(clamps), inaccuracy(problem.rows, problem.features, locators))
            best = found if best is None or found < best else best
    return best


def measured(file: Path, scale: float) -> Row:
    task, surface = task_of(file, scale)
    _ = surface.geometry  # the part is loaded before the clock starts: its contacts are known
    start = time.process_time()
    result = design(task, surface)
    took = time.process_time() - start
    assert result.satisfied is Answer.YES, result.reason
    assert result.layout is not None
    assert result.accuracy is not None
    problem = problem_of(task, surface)
    clamps = sum(element.role == "clamp" for element in result.layout.elements)
    return Row(
        file.stem, len(problem.candidates), result.accuracy, clamps, result.best_accuracy, took,
        by_thumb(problem), by_exchange(problem, took),
    )  # fmt: skip


def main(names: list[str]) -> None:
    print("| part | candidates | clamps | error | bound | rule of thumb | plain exchange (clamps, error) | time [s] |")
    print("|---|---|---|---|---|---|---|---|")
    for name, scale in PARTS:
        if names and not any(word in name for word in names):
            continue
        try:
            row = measured(SHARED / name, scale)
        except AssertionError as error:
            print(f"| {Path(name).stem} | no layout: {error} |")
            continue
        thumb = "none" if row.thumb is None else f"{row.thumb / row.ours:.2f}x"
        other = "none" if row.exchange is None else f"{row.exchange[0]}, {row.exchange[1] / row.ours:.3f}x"
        bound = "" if row.bound is None else f"{row.bound / row.ours:.3f}x"
        cells = [row.part, row.candidates, row.clamps, f"{row.ours:.2f}", bound, thumb, other, f"{row.seconds:.1f}"]
        print("|", " | ".join(map(str, cells)), "|", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])

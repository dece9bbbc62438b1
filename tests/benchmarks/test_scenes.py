"""Posed scenes, candidate points and slides: points and configurations a second on meshes of known size.

The part is a bumpy ring and the body a larger one of as many triangles; poses are drawn around it, so that some of
them overlap. Each benchmark does ``COUNT`` of its things at a time: their rate is COUNT / the time it shows.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
import trimesh

from fixture_design.geometry import PartGeometry, PlacedBody, SamplingRules, Scene, sample_surface, slide
from fixture_design.layout import Pose

Benchmark = Callable[..., Any]
COUNT = 100
SIZES = (1_000, 10_000, 50_000)


def solid(mesh: trimesh.Trimesh, name: str) -> PartGeometry:
    vertices = np.array(mesh.vertices, dtype=float)
    return PartGeometry(name, vertices, np.array(mesh.faces), np.full(len(vertices), 1e-17))


@cache
def bumpy_ring(size: int) -> PartGeometry:
    around = int(np.sqrt(size / 2))
    mesh = trimesh.creation.torus(0.02, 0.01, around, around)
    x, y, z = (np.array(mesh.vertices) / 0.03).T
    mesh.vertices *= (1 + 0.1 * np.sin(7 * x) * np.cos(5 * y) * np.sin(6 * z))[:, None]
    made = solid(mesh, f"{len(mesh.faces)} triangles")
    assert made.is_one_shell
    return made


@cache
def scene(size: int) -> Scene:
    around = int(np.sqrt(size / 2))
    ring = solid(trimesh.creation.torus(0.05, 0.02, around, around), "ring")
    made = Scene(bumpy_ring(size), [PlacedBody("ring", ring, Pose.identity(3))])
    made.at(Pose.identity(3)).clearance()  # Drake's scenes are built when first asked
    return made


def poses(count: int) -> list[Pose]:
    rng = np.random.default_rng(1)
    places = zip(rng.uniform(-0.12, 0.12, (count, 3)), rng.uniform(-3, 3, (count, 3)), strict=True)
    return [Pose.from_xyz_rpy(xyz, rpy) for xyz, rpy in places]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.benchmark(group=f"signed distance of {COUNT} points at a pose")
def test_points(benchmark: Benchmark, size: int) -> None:
    posed = Scene(bumpy_ring(size)).at(poses(1)[0])
    points = np.random.default_rng(2).uniform(-0.1, 0.1, (COUNT, 3))
    posed.part_distances(points)
    assert benchmark(posed.part_distances, points).shape == (COUNT,)


@pytest.mark.parametrize("size", SIZES[:2])
@pytest.mark.benchmark(group=f"is the part free, {COUNT} poses")
def test_free(benchmark: Benchmark, size: int) -> None:
    free = benchmark(scene(size).is_free, poses(COUNT))
    assert 0 < free.sum() < COUNT


@pytest.mark.parametrize("limit", [1e-3, np.inf])
@pytest.mark.parametrize("size", SIZES[:2])
@pytest.mark.benchmark(group=f"clearance, {COUNT // 10} poses")
def test_clearance(benchmark: Benchmark, size: int, limit: float) -> None:
    found = benchmark.pedantic(  # type: ignore[attr-defined]
        scene(size).clearances, (poses(COUNT // 10), limit), rounds=2
    )
    assert found.min() < limit


@pytest.mark.parametrize("processes", [1, 2])
@pytest.mark.parametrize("size", SIZES[:2])
@pytest.mark.benchmark(group=f"is the part free, {10 * COUNT} poses, starting workers included")
def test_free_with_workers(benchmark: Benchmark, size: int, processes: int) -> None:
    free = benchmark.pedantic(  # type: ignore[attr-defined]
        scene(size).is_free, (poses(10 * COUNT),), {"processes": processes}, rounds=1
    )
    assert 0 < free.sum() < 10 * COUNT


@pytest.mark.parametrize("margin", [0.0, 0.003])
@pytest.mark.benchmark(group="candidate points on a bracket, about 700 and 400")
def test_sampling(benchmark: Benchmark, margin: float) -> None:
    vertices, triangles = trimesh.creation.box((0.08, 0.05, 0.02)).vertices, trimesh.creation.box().faces
    part = solid(trimesh.Trimesh(vertices, triangles, process=False), "bracket")
    assert part.facets
    found = benchmark(sample_surface, part, Pose.identity(3), 0.0038, SamplingRules(edge_margin=margin))
    assert len(found) > 200


@pytest.mark.parametrize("size", SIZES[:2])
@pytest.mark.benchmark(group="a slide of 2 mm")
def test_slide(benchmark: Benchmark, size: int) -> None:
    part = bumpy_ring(size)
    start = part.surface.at(np.array([0.015, 0.015, 0.02]))[1]
    assert part.facets
    assert benchmark(slide, part, start, np.array([1.0, -1, 0.3]), 0.002).length == 0.002

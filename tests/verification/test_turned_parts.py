"""Bodies of revolution, however coarse and however their triangles are folded: never closed, never located in turn."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fixture_design.layout import Answer, Element, Layout, Motion, Verdict
from fixture_design.verification import check, verify
from tests.geometry.parts import Mesh, part, write

#: Profiles [radius, height] from the axis at the bottom to the axis at the top [m].
PROFILES = {
    "cylinder": [[0.0, 0.0], [0.02, 0.0], [0.02, 0.05], [0.0, 0.05]],
    "cone": [[0.0, 0.0], [0.025, 0.0], [0.01, 0.05], [0.0, 0.05]],
    "barrel": [
        [0.0, 0.0],
        *[[0.015 + 0.008 * np.sin(t), 0.05 * t / np.pi] for t in np.linspace(0, np.pi, 9)],
        [0.0, 0.05],
    ],
    "vase": [[0.0, 0.0], *[[0.02 + 0.006 * np.sin(5 * h), 0.02 * h] for h in np.linspace(0, 3, 16)], [0.0, 0.06]],
}
FOLDS = ("short", "long", "alternating", "random", "half turned")


def turned(profile: list[list[float]], sections: int, fold: str, seed: int = 0) -> Mesh:
    """The profile turned about z: quadrilaterals between rings split by a rule, or rings turned by half a step."""
    rng = np.random.default_rng(seed)
    vertices: list[list[float]] = []
    rings: list[list[int]] = []
    for number, (radius, height) in enumerate(profile):
        if radius == 0:
            rings.append([len(vertices)])
            vertices.append([0.0, 0.0, height])
            continue
        offset = 0.5 * (number % 2) if fold == "half turned" else 0.0
        angles = 2 * np.pi * (np.arange(sections) + offset) / sections
        rings.append(list(range(len(vertices), len(vertices) + sections)))
        vertices += [[radius * np.cos(a), radius * np.sin(a), height] for a in angles]
    triangles: list[list[int]] = []
    for low, high in pairwise(rings):
        for k in range(sections):
            j = (k + 1) % sections
            if len(low) == 1:
                triangles.append([low[0], high[j], high[k]])
            elif len(high) == 1:
                triangles.append([low[k], low[j], high[0]])
            else:
                # "long" leaves the quadrilateral, two steps round, so that the surface is creased
                end = high[(k + 2) % sections] if fold == "long" else high[j]
                first = {"alternating": k % 2 == 0, "half turned": low[0] % 2 == 0, "random": rng.random() < 0.5}
                if first.get(fold, True):
                    triangles += [[low[k], low[j], end], [low[k], end, high[j] if fold == "long" else high[k]]]
                else:
                    triangles += [[low[k], low[j], high[k]], [low[j], high[j], high[k]]]
    return np.array(vertices), np.array(triangles)


def held(mesh: Mesh, folder: Path, count: int, seed: int) -> Verdict:
    """The verdict on random points of the mesh's faces, as locators."""
    body = trimesh.Trimesh(*mesh, process=False)
    points, _ = trimesh.sample.sample_surface(body, count, seed=seed)
    elements = tuple(Element(f"E{k}", "locator", point) for k, point in enumerate(points))
    return verify(Layout("turned", part=part(write(folder, mesh, "turned.obj")), elements=elements, surface_gap=2e-3))


@pytest.mark.parametrize("fold", FOLDS)
@pytest.mark.parametrize("shape", list(PROFILES))
@pytest.mark.parametrize("sections", [6, 8, 11, 14, 24, 48])
def test_a_body_of_revolution_is_never_held(shape: str, sections: int, fold: str, tmp_path: Path) -> None:
    """The spin about the axis is free; a yes would be the worst that this tool can say."""
    mesh = turned(PROFILES[shape], sections, fold, sections)
    if not trimesh.Trimesh(*mesh, process=False).is_volume:
        pytest.skip("this fold of so few sections cuts itself")
    verdict = held(mesh, tmp_path, 24, sections)
    for claim in ("form_closure", "deterministic"):
        assert verdict.groups["all"].findings[claim].answer is not Answer.YES
    assert check(verdict) == []


@pytest.mark.parametrize("fold", ["alternating", "half turned"])
@pytest.mark.parametrize("shape", list(PROFILES))
@pytest.mark.parametrize("sections", [11, 14, 32])
def test_nor_is_one_whose_vertices_are_badly_known(shape: str, sections: int, fold: str, tmp_path: Path) -> None:
    """Vertices off by up to 1e-4 of the size, and nothing in the file says so."""
    rng = np.random.default_rng(sections)
    vertices, triangles = turned(PROFILES[shape], sections, fold)
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    for noise in (2e-5, 1e-4):
        shaken = vertices + noise * size * rng.uniform(-1, 1, vertices.shape)
        verdict = held((shaken, triangles), tmp_path, 24, sections)
        for claim in ("form_closure", "deterministic"):
            assert verdict.groups["all"].findings[claim].answer is not Answer.YES
        assert check(verdict) == []


@pytest.mark.parametrize("fold", ["short", "alternating", "random", "half turned"])
@pytest.mark.parametrize("shape", list(PROFILES))
def test_its_spin_is_found_where_the_mesh_is_fine(shape: str, fold: str, tmp_path: Path) -> None:
    verdict = held(turned(PROFILES[shape], 40, fold), tmp_path, 24, 3)
    finding = verdict.groups["all"].findings["form_closure"]
    assert finding.answer is Answer.NO
    assert isinstance(finding.evidence, Motion)
    unit = finding.evidence.motion / np.linalg.norm(finding.evidence.motion)
    np.testing.assert_allclose(np.abs(unit), [0, 0, 0, 0, 0, 1], atol=1e-4)

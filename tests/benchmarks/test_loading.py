"""How long a part takes to get in: read, mended, checked; cut into facets; and Drake's distance built."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fixture_design.geometry import PartGeometry, load_part
from tests.geometry.parts import part

Benchmark = Callable[..., Any]
#: About so many triangles, as strips around and along a torus.
SECTIONS = {1_000: (40, 13), 10_000: (125, 40), 50_000: (280, 90)}


@pytest.fixture(params=SECTIONS, scope="module")
def file(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A binary STL file: three vertices a triangle, in single precision."""
    import trimesh

    major, minor = SECTIONS[request.param]
    name = tmp_path_factory.mktemp("parts") / f"{request.param}.stl"
    trimesh.creation.torus(0.03, 0.01, major_sections=major, minor_sections=minor).export(name)
    return name


@pytest.mark.benchmark(group="load a mesh")
def test_load(benchmark: Benchmark, file: Path) -> None:
    geometry: PartGeometry = benchmark(load_part, part(file))
    assert len(geometry.triangles) == pytest.approx(int(file.stem), rel=0.05)


@pytest.mark.benchmark(group="load a mesh and find its facets")
def test_load_and_facets(benchmark: Benchmark, file: Path) -> None:
    geometry: PartGeometry = benchmark(lambda: _with(load_part(part(file)), "facets"))
    assert len(geometry.facets) > len(geometry.triangles) / 3


@pytest.mark.benchmark(group="load a mesh and build Drake's distance")
def test_load_and_distance(benchmark: Benchmark, file: Path) -> None:
    geometry: PartGeometry = benchmark(lambda: _with(load_part(part(file)), "surface"))
    assert geometry.surface.at(geometry.high + 0.01)[0] > 0.01


def _with(geometry: PartGeometry, asked: str) -> PartGeometry:
    """The geometry after it was asked for something that it computes once."""
    getattr(geometry, asked)
    return geometry

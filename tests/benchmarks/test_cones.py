"""CONVERT and the closure tests at 4 to 60 contacts, in R3 and R6."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fixture_design.analysis import Restraint, form_closure, strongly_accessible
from fixture_design.analysis.branches import UnionQuestions
from fixture_design.cones.kernel import double_description, tucker_partition
from fixture_design.contacts import constraints_of
from fixture_design.tolerances import DEFAULT
from tests.benchmarks.conftest import SIZES, ellipsoid_contacts, fan

Benchmark = Callable[..., Any]
SPACES = {"R3": "planar", "R6": "spatial"}


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize("dimension", [3, 6])
@pytest.mark.benchmark(group="CONVERT, half-space fan")
def test_convert_fan(benchmark: Benchmark, dimension: int, count: int) -> None:
    rows = fan(count, dimension)
    found = benchmark(double_description, rows, np.zeros((0, dimension)), DEFAULT.tie)
    assert found.is_certain(DEFAULT.band)


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.benchmark(group="CONVERT, contacts around an ellipsoid")
def test_convert_contacts(benchmark: Benchmark, space: str, count: int) -> None:
    rows = UnionQuestions(constraints_of(ellipsoid_contacts(count, SPACES[space]))).rows
    found = benchmark(double_description, rows, np.zeros((0, rows.shape[1])), DEFAULT.tie)
    assert found.is_certain(DEFAULT.band)


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.benchmark(group="closure, bare partition")
def test_partition(benchmark: Benchmark, space: str, count: int) -> None:
    rows = UnionQuestions(constraints_of(ellipsoid_contacts(count, SPACES[space]))).rows
    assert benchmark(tucker_partition, rows, DEFAULT.tie).zero_max < DEFAULT.zero


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.benchmark(group="form closure with margin and evidence")
def test_form_closure(benchmark: Benchmark, space: str, count: int) -> None:
    contacts = ellipsoid_contacts(count, SPACES[space])
    assert benchmark(lambda: form_closure(Restraint.of(contacts))).answer is not None


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.benchmark(group="strong accessibility with margin and evidence")
def test_strong_accessibility(benchmark: Benchmark, space: str, count: int) -> None:
    contacts = ellipsoid_contacts(count, SPACES[space])
    assert benchmark(lambda: strongly_accessible(Restraint.of(contacts))).answer is not None

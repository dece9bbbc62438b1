"""Every test of the cones runs on every kernel that this installation has."""

from collections.abc import Iterator

import pytest

from fixture_design.cones import kernel


@pytest.fixture(params=kernel.available(), autouse=True, scope="session")
def implementation(request: pytest.FixtureRequest) -> Iterator[str]:
    with kernel.using(request.param):
        yield request.param

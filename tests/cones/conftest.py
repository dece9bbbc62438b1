"""Every test of the cones runs on every kernel that this installation has."""

from collections.abc import Iterator

import pytest

from fixture_design.cones import kernel


# Ends with its module: tests elsewhere run on the kernel that was chosen at the start.
@pytest.fixture(params=kernel.available(), autouse=True, scope="module")
def implementation(request: pytest.FixtureRequest) -> Iterator[str]:
    with kernel.using(request.param):
        yield request.param

"""Modular plates: every fixture of three round locators in a grid of holes and one clamp that holds a planar part.

The method is that of Brost and Goldberg, "A complete algorithm for designing planar fixtures using modular components",
IEEE Transactions on Robotics and Automation 12 (1996), one file a step:

* `grown_edges`: the edges moved out by the locator's radius, so that locators become points on them;
* `triples`: three edges and three holes whose distances some pose may have;
* `poses`: the poses in which the three holes are on the three grown edges;
* `clearance`: what touches the part touches it only where it should;
* `clamps`: where a plunger along a row or column of holes meets an edge;
* `closure`: whether four contacts hold the part, and by how much;
* `quality`: numbers to choose by.
"""

from fixture_design.design.plates.enumeration import enumerate_fixtures
from fixture_design.design.plates.fixtures import Fixtures
from fixture_design.design.plates.plate import Clamp, Plate
from fixture_design.design.plates.quality import best_fixture, locating_error, reaction
from fixture_design.design.plates.to_layout import fixture_layout

__all__ = [
    "Clamp",
    "Fixtures",
    "Plate",
    "best_fixture",
    "enumerate_fixtures",
    "fixture_layout",
    "locating_error",
    "reaction",
]

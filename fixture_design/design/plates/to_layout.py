"""From a fixture on a plate to a layout, for verification, files and pictures."""

from __future__ import annotations

from fixture_design.design.plates.fixtures import Fixtures
from fixture_design.errors import InputError
from fixture_design.layout import Element, Layout, Part, PointTip, Pose, SphereTip, Tip


def fixture_layout(fixtures: Fixtures, index: int, name: str = "plate", friction: float = 0.0) -> Layout:
    """One fixture as a planar layout: locators L1 to L3 and clamp K1, with tips that touch where they were found to.

    It requires that the locators are deterministic and that all contacts close. The polygon's edges are meant as they
    are: none stands for a piece of an arc.

    Raises:
        InputError: there is no such fixture.
    """
    if not 0 <= index < len(fixtures):
        raise InputError("there is no such fixture", found=str(index), expected=f"0 to {len(fixtures) - 1}")
    plate = fixtures.plate
    radii = [plate.locator_radius] * 3 + [plate.plunger.radius]
    elements = tuple(
        Element(f"{'K' if number == 3 else 'L'}{number % 3 + 1}", "clamp" if number == 3 else "locator", point, _tip(r))
        for number, (point, r) in enumerate(zip(fixtures.points[index], radii, strict=True))
    )
    pose = Pose.from_xy_theta(fixtures.translation[index], float(fixtures.theta[index]))
    return Layout(
        name=name,
        space="planar",
        part=Part("polygon", "polygon", None, fixtures.polygon, 1.0, pose, faceted=True),
        friction=friction,
        elements=elements,
        require={"locators": ("deterministic",), "all": ("form_closure",)},
    )


def _tip(radius: float) -> Tip:
    return SphereTip(radius) if radius else PointTip()

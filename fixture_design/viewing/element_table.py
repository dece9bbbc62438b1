"""Every contact of a layout with its coordinates and normals, and the element it comes from."""

from __future__ import annotations

from fixture_design.contacts import unit_normal
from fixture_design.errors import format_length
from fixture_design.layout import (
    Element,
    Layout,
    LineTip,
    PadTip,
    PinTip,
    SoftTip,
    SphereTip,
    Verdict,
    element_name,
)
from fixture_design.viewing.markup import Markup, joined, table
from fixture_design.viewing.number_text import millimetres, numbers_text


def elements(layout: Layout, verdict: Verdict) -> Markup:
    """Coordinates and normals of every contact, with the element it comes from."""
    given = {element.name: element for element in layout.elements}
    rows = []
    for contact in verdict.contacts:
        element = given.get(element_name(contact.name))
        normals = joined((numbers_text(unit_normal(normal)) for normal in contact.normals), "; ")
        tolerance, preload = (None, None) if element is None else (element.tolerance, element.preload)
        place = [millimetres(contact.point), normals, contact.feature or ""]
        given_for = [_length(tolerance), _newtons(preload), f"{contact.friction:g}"]
        rows.append([contact.name, contact.role, _tip(element), *place, *given_for])
    headings = ["contact", "role", "tip", "at [mm]", "part's outward normal", "on", "tolerance", "preload", "friction"]
    return table(headings, rows)


def _tip(element: Element | None) -> str:
    if element is None:
        return ""
    match element.tip:
        case SphereTip():
            return f"ball, radius {format_length(element.tip.radius)}"
        case PadTip():
            return f"pad {format_length(element.tip.width)} x {format_length(element.tip.height)}"
        case LineTip():
            return f"line, {format_length(element.tip.length)}"
        case SoftTip():
            return f"soft, radius {format_length(element.tip.radius)}"
        case PinTip():
            pin = element.tip
            fit = f"{format_length(pin.diameter)}, clearance {format_length(pin.clearance)}"
            return f"{pin.shape} pin {fit}"
    return "point"


def _length(value: float | None) -> str:
    return "" if value is None else format_length(value)


def _newtons(value: float | None) -> str:
    return "" if value is None else f"{value:g} N"

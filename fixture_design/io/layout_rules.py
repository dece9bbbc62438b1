"""What a layout's keys must satisfy together: one of several keys, keys that need others, roles, stages.

Each rule yields the problems it finds; none stops at the first. Coordinates are in `coordinate_rules`, names in
`name_rules`.
"""

from __future__ import annotations

from collections.abc import Iterator

from fixture_design.io.coordinate_rules import coordinate_problems
from fixture_design.io.name_rules import name_problems
from fixture_design.io.places import KeyPath
from fixture_design.io.problems import Problem, either
from fixture_design.io.record_types import Record
from fixture_design.io.records import ElementRecord, LayoutRecord, LoadRecord, PartRecord, TipRecord

TIPS = ("sphere", "pad", "line", "soft", "pin")
NORMALS = ("normal", "any_of", "all_of", "normals")
PARTS = ("urdf", "mesh", "step", "polygon")


def layout_problems(layout: LayoutRecord) -> Iterator[Problem]:
    """Everything about a layout that its keys' types do not tell."""
    if layout.part is not None:
        yield from _part_problems(layout.part, layout.space == "planar")
    for index, element in enumerate(layout.elements):
        yield from _element_problems(element, ("elements", index), layout.space == "planar")
    for index, contact in enumerate(layout.contacts):
        yield from _exactly_one(contact, NORMALS, ("contacts", index), f"contact {contact.name!r}", "normal")
    for index, load in enumerate(layout.loads):
        yield from _load_problems(load, ("loads", index))
    if layout.space == "planar" and layout.bodies:
        yield Problem(("bodies",), "bodies are spatial", expected="`contacts` or `elements` where `space: planar`")
    yield from _requirement_problems(layout)
    if layout.sweep is not None and layout.sweep.friction is not None:
        yield from order_problems(layout.sweep.friction, ("sweep", "friction"))
    yield from name_problems(layout)
    yield from coordinate_problems(layout)


def _exactly_one(record: Record, keys: tuple[str, ...], path: KeyPath, owner: str, what: str) -> Iterator[Problem]:
    given = given_keys(record, keys)
    if len(given) > 1:
        yield Problem(
            (*path, given[1]), f"{owner} has {' and '.join(map(repr, given))} together", expected="one of them"
        )
    elif not given:
        yield Problem(path, f"{owner} has no {what}", expected=f"one of the keys {either(keys)}")


def given_keys(record: Record, keys: tuple[str, ...]) -> list[str]:
    """Those of the keys that the record has a value for."""
    return [key for key in keys if getattr(record, key) is not None]


def _part_problems(part: PartRecord, planar: bool) -> Iterator[Problem]:
    yield from _exactly_one(part, PARTS, ("part",), "the part", "geometry")
    given = given_keys(part, PARTS)
    if planar and given and "polygon" not in given:
        yield Problem(
            ("part", given[0]), "a planar part is a polygon", found=given[0], expected="polygon: [[x, y], ...]"
        )
    if not planar and "polygon" in given:
        yield Problem(
            ("part", "polygon"), "a polygon is a planar part", expected="`space: planar`, or urdf, mesh, step"
        )
    if part.scale is not None and not {"mesh", "step"} & set(given):
        yield Problem(("part", "scale"), "`scale` is for meshes and STEP files", expected="no `scale` here")
    if part.polygon is not None:
        yield from _polygon_problems(part.polygon)


def _polygon_problems(polygon: tuple[tuple[float, ...], ...]) -> Iterator[Problem]:
    following = (*polygon[1:], polygon[0])
    doubled_area = sum(x * v - u * y for (x, y), (u, v) in zip(polygon, following, strict=True))
    if doubled_area < 0:
        yield Problem(("part", "polygon"), "the polygon's vertices run clockwise", expected="them counter-clockwise")
    elif doubled_area == 0:
        yield Problem(("part", "polygon"), "the polygon encloses no area: its sides cross, or lie on each other")


def _element_problems(element: ElementRecord, path: KeyPath, planar: bool) -> Iterator[Problem]:
    owner = f"{element.role} {element.name!r}"
    for key, what in (("preload", "pushes with a preload"), ("limits", "has limits of its preload")):
        if getattr(element, key) is not None and element.role != "clamp":
            yield Problem((*path, key), f"{owner} {what}; only clamps do", expected=f"`role: clamp`, or no `{key}`")
    if element.limits is not None:
        yield from order_problems(element.limits, (*path, "limits"))
    if element.tip is not None:
        yield from tip_problems(element.tip, (*path, "tip"), owner)
    has_pin = element.tip is not None and element.tip.pin is not None
    if has_pin and element.axis is None and not planar:
        yield Problem(path, f"{owner} is a pin without an axis", expected="axis: [x, y, z]")
    if element.axis is not None and (planar or not has_pin):
        reason = "a planar pin stands upright" if has_pin else "only pins have an axis"
        yield Problem((*path, "axis"), f"{owner} has an axis; {reason}", expected="no `axis` here")


def order_problems(limits: tuple[float, ...], path: KeyPath) -> Iterator[Problem]:
    """That the smaller one of two numbers comes first."""
    low, high = limits
    if low > high:
        yield Problem(path, f"{path[-1]!r} is out of order", f"[{low:g}, {high:g}]", "the smaller one first")


def tip_problems(tip: TipRecord, path: KeyPath, owner: str) -> Iterator[Problem]:
    """What a tip's keys must satisfy together; ``owner`` is whose it is, in words."""
    yield from _exactly_one(tip, TIPS, path, f"the tip of {owner}", "shape")
    given = given_keys(tip, TIPS)
    diamond = tip.pin is not None and tip.pin.shape == "diamond"
    direction = tip.along is not None or (tip.pin is not None and tip.pin.along is not None)
    if len(given) != 1:
        return
    if tip.along is not None and tip.pin is not None and tip.pin.along is not None:
        yield Problem((*path, "along"), f"the tip of {owner} has `along` twice", expected="it once")
    needs_direction = diamond or given[0] in ("pad", "line")
    kind = f"{'diamond' if diamond else 'round'} pin" if given[0] == "pin" else given[0]
    if needs_direction and not direction:
        yield Problem(path, f"the {kind} of {owner} needs a direction", expected="`along: [...]`")
    if direction and not needs_direction:
        where = (*path, "along") if tip.along is not None else (*path, "pin", "along")
        yield Problem(where, f"the {kind} of {owner} takes no direction", expected="no `along` here")


def _load_problems(load: LoadRecord, path: KeyPath) -> Iterator[Problem]:
    inline = given_keys(load, ("point", "force", "moment"))
    if load.path is not None and inline:
        yield Problem(
            (*path, inline[0]), f"load {load.name!r} has `path` and {inline[0]!r} together", expected="one of them"
        )
    if load.path is None and load.force is None and load.moment is None:
        yield Problem(path, f"load {load.name!r} has no force", expected="`force`, `moment` or `path`")
    if load.force is not None and load.point is None:
        yield Problem(path, f"load {load.name!r} has a force that acts nowhere", expected="`point: [...]`")


def _requirement_problems(layout: LayoutRecord) -> Iterator[Problem]:
    lists: list[tuple[KeyPath, tuple[str, ...]]] = [
        (("stages", index, "require"), stage.require) for index, stage in enumerate(layout.stages)
    ]
    if layout.require is not None:
        lists += [(("require", key), getattr(layout.require, key) or ()) for key in ("locators", "all")]
    for path, words in lists:
        for index, word in enumerate(words):
            if word in words[:index]:
                yield Problem((*path, index), f"{word!r} is required twice", expected="it once")

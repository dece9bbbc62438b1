"""What an assembly file must keep to beyond the types of its values."""

from __future__ import annotations

from collections.abc import Iterator

from fixture_design.io.assembly_records import AssemblyRecord, BodyShapeRecord, RegionRecord
from fixture_design.io.places import KeyPath
from fixture_design.io.problems import Problem, either

_SPATIAL = ("box", "mesh", "urdf")
SHAPES = ("polygon", *_SPATIAL)


def assembly_problems(assembly: AssemblyRecord) -> Iterator[Problem]:
    """Bodies without a shape or with one of another space, names given twice, regions out of order."""
    planar = assembly.space == "planar"
    bodies: list[tuple[KeyPath, BodyShapeRecord]] = [(("moving",), assembly.moving)]
    bodies += [(("fixed", index), body) for index, body in enumerate(assembly.fixed)]
    for path, body in bodies:
        yield from _shape_problems(body, path, planar)
    yield from _name_problems(bodies)
    if assembly.region is not None:
        yield from _region_problems(assembly.region, planar)


def _shape_problems(body: BodyShapeRecord, path: KeyPath, planar: bool) -> Iterator[Problem]:
    given = [key for key in SHAPES if getattr(body, key) is not None]
    fitting = ("polygon",) if planar else _SPATIAL
    if len(given) != 1:
        found = " and ".join(map(repr, given)) or "nothing"
        yield Problem(path, "a body has exactly one shape", found, f"one of the keys {either(SHAPES)}")
    elif given[0] not in fitting:
        space = "planar" if planar else "spatial"
        yield Problem((*path, given[0]), f"{given[0]!r} does not fit 'space: {space}'", expected=either(fitting))
    if body.scale is not None and body.mesh is None:
        yield Problem((*path, "scale"), "`scale` is for meshes", expected="no `scale` here")
    if not planar and (body.apices or body.facets):
        key = "apices" if body.apices else "facets"
        yield Problem((*path, key), "features are named in the plane only", expected=f"no `{key}` here")
    for key in ("xyz", "rpy") if planar else ("xy", "theta"):
        if body.pose is not None and getattr(body.pose, key) is not None:
            yield Problem((*path, "pose", key), f"{key!r} does not fit the space")
    for key in ("apices", "facets"):
        for name, index in getattr(body, key).items():
            if body.polygon is not None and index >= len(body.polygon):
                last = len(body.polygon) - 1
                yield Problem((*path, key, name), f"there is no vertex {index}", str(index), f"a number up to {last}")


def _name_problems(bodies: list[tuple[KeyPath, BodyShapeRecord]]) -> Iterator[Problem]:
    first: dict[str, KeyPath] = {}
    for path, body in bodies:
        for key in ("apices", "facets"):
            for name in getattr(body, key):
                place = (*path, key, name)
                if name in first:
                    yield Problem(place, f"the name {name!r} is given twice", expected="another", also=first[name])
                first.setdefault(name, place)
                if not name.strip() or not name.isprintable() or " - " in name:
                    yield Problem(place, f"{name!r} is no usable name", expected="one that prints, without ' - '")


def _region_problems(region: RegionRecord, planar: bool) -> Iterator[Problem]:
    for key in ("x", "y", "z", "theta"):
        limits = getattr(region, key)
        if limits is not None and limits[0] > limits[1]:
            found = f"[{limits[0]:g}, {limits[1]:g}]"
            yield Problem(("region", key), f"{key!r} is out of order", found, "the smaller one first")
    for key in ("z", "rotation") if planar else ("theta",):
        if getattr(region, key) is not None:
            yield Problem(("region", key), f"{key!r} does not fit 'space: {'planar' if planar else 'spatial'}'")
    if not planar and region.z is None:
        yield Problem(("region",), "the region has no 'z'", expected="z: [smallest, largest]")

"""Hand files: read into a `Hand`; and the hand that a bare URDF or SDF file stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.errors import FileFormatError
from fixture_design.grasp.hand import Fingertip, Hand, JointRule
from fixture_design.io.documents import read_document
from fixture_design.io.hand_records import FingertipRecord, HandRecord, JointRecord
from fixture_design.io.layout_reading import metres_of
from fixture_design.io.places import KeyPath
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import Problem, content_error, show
from fixture_design.io.schema_key import require_schema

#: Endings of model files.
MODEL_ENDINGS = (".urdf", ".sdf")

#: Endings of hand files.
_HAND_ENDINGS = (".yaml", ".yml", ".json")

#: A pad's `along` is this near to across `facing` [-], as a cosine.
_ACROSS = 1e-6


def read_hand(path: str | Path) -> Hand:
    """The hand in a hand file, in metres; or of a URDF or SDF file, with the hand file beside it if there is one.

    The hand file beside ``jaw.urdf`` is ``jaw.hand.yaml`` (or .yml, .json). Without one the fingertips are guessed when
    the hand is loaded.

    Raises:
        FileFormatError: the file cannot be read, does not parse or is no hand file by its name or content.
    """
    path = Path(path)
    if path.suffix.lower() in MODEL_ENDINGS:
        beside = [path.with_suffix(f".hand{ending}") for ending in _HAND_ENDINGS]
        found = next((file for file in beside if file.is_file()), None)
        return Hand(path.stem, path.absolute()) if found is None else read_hand(found)
    if path.is_file() and path.suffix.lower() not in _HAND_ENDINGS:
        expected = f"a hand file ({', '.join(_HAND_ENDINGS)}), or a model ({', '.join(MODEL_ENDINGS)})"
        raise FileFormatError("this is not a hand", source=path, expected=expected)
    document = read_document(path)
    require_schema(document, "hand")
    record = validated(HandRecord, document)
    if problems := list(_problems(record)):
        raise content_error(problems, document)
    metres = metres_of(record.units)
    return Hand(
        name=record.name or path.stem.removesuffix(".hand"),
        model=(path.absolute().parent / record.model),
        fingertips=tuple(_fingertip(tip, metres) for tip in record.fingertips),
        friction=record.friction,
        joints={joint.name: _rule(joint) for joint in record.joints},
        source=path,
    )


def _problems(record: HandRecord) -> Iterator[Problem]:
    for key, named in (("fingertips", record.fingertips), ("joints", record.joints)):
        seen: dict[str, KeyPath] = {}
        for index, item in enumerate(named):
            place: KeyPath = (key, index, "name")
            if item.name in seen:
                yield Problem(place, f"the name {item.name!r} is given twice", also=seen[item.name])
            seen.setdefault(item.name, place)
    for index, tip in enumerate(record.fingertips):
        yield from _tip_problems(tip, ("fingertips", index))


def _tip_problems(tip: FingertipRecord, path: KeyPath) -> Iterator[Problem]:
    if tip.ball is not None and tip.pad is not None:
        yield Problem(path, "a fingertip is a ball or a pad, not both", expected="one of: ball, pad; or none: a point")
    if (tip.pad is None) != (tip.along is None):
        yield Problem(path, "`pad` and `along` go together", expected="along: a direction across `facing`")
    for key in ("facing", "along"):
        if (value := getattr(tip, key)) is not None and not any(value):
            yield Problem((*path, key), f"{key!r} has zero length", show(value), "a direction")
            return
    if tip.along is not None and abs(_unit(tip.along) @ _unit(tip.facing)) > _ACROSS:
        yield Problem((*path, "along"), "'along' is not across 'facing'", show(tip.along), "a direction in the pad")


def _fingertip(tip: FingertipRecord, metres: Callable[[float], float]) -> Fingertip:
    return Fingertip(
        tip.name,
        tip.link,
        read_only([metres(value) for value in tip.at]),
        read_only(_unit(tip.facing)),
        None if tip.ball is None else metres(tip.ball),
        None if tip.pad is None else (metres(tip.pad[0]), metres(tip.pad[1])),
        None if tip.along is None else read_only(_unit(tip.along)),
        None if tip.soft is None else metres(tip.soft),
        tip.friction,
        tip.spread,
    )


def _rule(joint: JointRecord) -> JointRule:
    """As it stands: which joints slide only the model tells, so that their lengths are metres whatever the unit."""
    return JointRule(joint.lower, joint.upper, joint.effort, joint.follows, joint.multiplier, joint.offset)


def _unit(values: tuple[float, ...]) -> Point:
    direction = np.array(values, dtype=np.float64)
    direction /= np.abs(direction).max()
    return direction / np.linalg.norm(direction)

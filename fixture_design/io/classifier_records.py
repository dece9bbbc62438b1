"""The classifier file `fixture_design/classifier/1`, key by key."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fixture_design.io.record_types import NotNegative, Number, Record, Text
from fixture_design.recognition.measurement import Interpolation
from fixture_design.tolerances import FARTHEST, SMALLEST_PART

Row = Annotated[tuple[Number, ...], Field(strict=False, min_length=1)]
Rows = Annotated[tuple[Row, ...], Field(strict=False)]
Index = Annotated[int, Field(ge=0)]
Length = Annotated[float, Field(allow_inf_nan=False, ge=SMALLEST_PART, le=FARTHEST)]
Names = Annotated[tuple[Text, ...], Field(strict=False)]


class ConeRecord(Record):
    """{s : faces . s <= 0, equalities . s = 0}; unit rows, of a signal's numbers."""

    WANTED: ClassVar[str] = "{faces: [...], equalities: [...]}"
    faces: Rows
    equalities: Rows = ()


class WideningRecord(Record):
    """By how much the cones are widened: s is in one if a . s <= this for all unit faces a, for unit blocks of s."""

    WANTED: ClassVar[str] = "{force: x, displacement: x}"
    force: NotNegative
    displacement: NotNegative


class StateRecord(Record):
    """A state with its measurement set."""

    WANTED: ClassVar[str] = "a state with id, contacts, successors and cones"
    id: Text
    contacts: Names
    successors: Names
    widening: WideningRecord
    cones: Annotated[tuple[ConeRecord, ...], Field(strict=False, min_length=1)]


class TransitionRecord(Record):
    """The discriminants of a transition: for each cone of the target the faces (then equalities, twice) that it needs.

    A face is counted from 0: first the cone's faces, then its equalities, then these again with the other sign.
    """

    WANTED: ClassVar[str] = "a transition with source, target and faces"
    source: Text
    target: Text
    faces: Annotated[tuple[Annotated[tuple[Index, ...], Field(strict=False)], ...], Field(strict=False)]


class SignalsRecord(Record):
    """What is measured: unit blocks [f; m / length] (with a weight also [...; weight]) and [dx; length dtheta]."""

    WANTED: ClassVar[str] = "{measure: force, axes: fixed, length: x}"
    measure: Literal["force", "displacement", "both"]
    axes: Literal["fixed", "part"]
    length: Length
    weight: NotNegative = 0.0


class NoiseRecord(Record):
    """Stated bounds of the sensors' errors, relative to what is measured; wrenches up to `floor` [N] tell nothing."""

    WANTED: ClassVar[str] = "{force: x, displacement: x, floor: x}"
    force: NotNegative = 0.0
    displacement: NotNegative = 0.0
    floor: NotNegative = 0.0


class MadeRecord(Record):
    """How it was made."""

    WANTED: ClassVar[str] = "{version: text, friction: x, ...}"
    version: Text
    friction: NotNegative
    edges: int
    interpolation: Interpolation
    accuracy: NotNegative
    seed: int
    smallest: bool


class ClassifierRecord(Record):
    """A classifier of contact states."""

    WANTED: ClassVar[str] = "a classifier"
    schema_: Literal["fixture_design/classifier/1"] = Field(alias="schema")
    name: Text
    space: Literal["planar", "spatial"]
    units: Literal["m"]
    signals: SignalsRecord
    noise: NoiseRecord
    run: MadeRecord
    states: Annotated[tuple[StateRecord, ...], Field(strict=False, min_length=1)]
    transitions: Annotated[tuple[TransitionRecord, ...], Field(strict=False)]

"""The values that the fields of our files have: numbers that are numbers, names, vectors.

Strict: 1 is a number, true and "1" are not. Lists become tuples, so that records are frozen through and through.
"""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema

from fixture_design.tolerances import (
    FARTHEST,
    MOST_FORCE,
    MOST_FRICTION,
    MOST_GRAVITY,
    MOST_MASS,
    MOST_STIFFNESS,
)


class Record(BaseModel):
    """Base of all records: no unknown keys, no conversions, frozen.

    ``WANTED`` is what a message calls such a record: "expected <WANTED>".
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, populate_by_name=False)
    WANTED: ClassVar[str] = "a mapping"


def exactly_one(*keys: str) -> ConfigDict:
    """Configuration of a record of which its JSON Schema says that it has exactly one of these keys."""
    return ConfigDict(json_schema_extra={"oneOf": [{"required": [key]} for key in keys]})


Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(allow_inf_nan=False, ge=0)]
#: Numbers that sums and products are made of: not so large that these overflow, or that nobody can mean them.
Newtons = Annotated[float, Field(allow_inf_nan=False, ge=-MOST_FORCE, le=MOST_FORCE)]
Push = Annotated[float, Field(allow_inf_nan=False, ge=0, le=MOST_FORCE)]
PushLimits = Annotated[tuple[Push, ...], Field(strict=False, min_length=2, max_length=2)]
Mass = Annotated[float, Field(allow_inf_nan=False, gt=0, le=MOST_MASS)]
Acceleration = Annotated[float, Field(allow_inf_nan=False, ge=-MOST_GRAVITY, le=MOST_GRAVITY)]
Stiffness = Annotated[float, Field(allow_inf_nan=False, gt=0, le=MOST_STIFFNESS)]
Length = Annotated[float, Field(allow_inf_nan=False, ge=-FARTHEST, le=FARTHEST)]
Deviation = Annotated[float, Field(allow_inf_nan=False, ge=0, le=FARTHEST)]
Friction = Annotated[float, Field(allow_inf_nan=False, ge=0, le=MOST_FRICTION)]

#: [x, y] or [x, y, z]; which of them, `layout_rules` checks.
Coordinates = Annotated[tuple[Number, ...], Field(strict=False, min_length=2, max_length=3)]
#: Likewise of a force, an acceleration, and of a place.
Force = Annotated[tuple[Newtons, ...], Field(strict=False, min_length=2, max_length=3)]
Gravity = Annotated[tuple[Acceleration, ...], Field(strict=False, min_length=2, max_length=3)]
Place = Annotated[tuple[Length, ...], Field(strict=False, min_length=2, max_length=3)]
#: Exactly three numbers.
Triple = Annotated[tuple[Number, ...], Field(strict=False, min_length=3, max_length=3)]
#: Exactly two numbers.
Pair = Annotated[tuple[Number, ...], Field(strict=False, min_length=2, max_length=2)]
#: Width and height, both > 0.
Size = Annotated[tuple[Positive, ...], Field(strict=False, min_length=2, max_length=2)]

#: One line, no '#' (it numbers the contacts of one element), no blanks around it.
Name = Annotated[str, Field(pattern=r"^[^#\s]([^#\r\n\t]*[^#\s])?$")]
#: Any text that is not empty: a file (relative to the file that names it), the name of a whole layout.
Text = Annotated[str, Field(min_length=1)]


#: JSON Schema of a moment in brackets.
_NUMBERS = {"type": "array", "items": {"type": "number"}, "minItems": 1, "maxItems": 3}


def _number_as_list(value: object) -> object:
    return [value] if isinstance(value, int | float) and not isinstance(value, bool) else value


#: A moment: three numbers in space; in the plane one number, with or without brackets.
Moment = Annotated[
    tuple[Newtons, ...],
    Field(strict=False, min_length=1, max_length=3),
    BeforeValidator(_number_as_list),
    WithJsonSchema({"anyOf": [{"type": "number"}, _NUMBERS]}),
]

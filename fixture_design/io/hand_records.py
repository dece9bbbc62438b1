"""The hand file `fixture_design/hand/1`, key by key: what a URDF or SDF file does not say of a hand. See `records`."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fixture_design.grasp.hand import USUAL_GRIP, USUAL_SPREAD
from fixture_design.io.record_types import Friction, Name, Number, Positive, Record, Size, Text, Triple


class FingertipRecord(Record):
    """Where a finger touches, in the frame of its link: a point, or a ball, or a pad."""

    WANTED: ClassVar[str] = "a mapping such as {name: left, link: left_finger, at: [0, 0, 0.04], facing: [1, 0, 0]}"
    name: Name
    link: Text = Field(description="of the model file")
    at: Triple = Field(description="the point, the centre of the ball or the middle of the pad, in the link [length]")
    facing: Triple = Field(
        description="out of the finger towards the part: a pad's normal, or the middle of a ball's skin"
    )
    ball: Positive | None = Field(None, description="radius of a round tip [length]")
    pad: Size | None = Field(None, description="width (along `along`) and height of a flat tip [length]")
    along: Triple | None = Field(None, description="direction of a pad's width, across `facing`")
    soft: Positive | None = Field(
        None, description="radius of the patch that a soft skin makes where it touches in a point [length]"
    )
    friction: Friction | None = Field(None, description="coefficient, default: the hand's")
    spread: Annotated[float, Field(gt=0, le=3.1416)] = Field(
        USUAL_SPREAD, description="of points and balls: how far from `facing` they may touch [rad]"
    )


class JointRecord(Record):
    """What the model file does not say of a joint, or says wrongly."""

    WANTED: ClassVar[str] = "a mapping such as {name: left_joint, effort: 40}"
    name: Text = Field(description="of a movable joint of the model file")
    lower: Number | None = Field(None, description="[rad], or [m] of a joint that slides, whatever the unit")
    upper: Number | None = Field(None, description="[rad], or [m] of a joint that slides, whatever the unit")
    effort: Positive | None = Field(None, description="largest torque or force of its drive [N m or N]")
    follows: Text | None = Field(None, description="the joint that moves this one: multiplier * position + offset")
    multiplier: Number = Field(1.0, description="of the position of the joint it follows")
    offset: Number = Field(0.0, description="added to that [rad or m]")


class HandRecord(Record):
    """A hand: its model, its fingertips, and what is special about its joints."""

    schema_: Literal["fixture_design/hand/1"] = Field(alias="schema")
    name: Text | None = Field(None, description="default: the file's name without suffixes")
    units: Literal["m", "mm", "in"] = Field("m", description="of the lengths in this file")
    model: Text = Field(description="URDF or SDF file, relative to this file")
    friction: Friction = Field(
        USUAL_GRIP, description="coefficient of fingertips and links that have none of their own"
    )
    fingertips: Annotated[tuple[FingertipRecord, ...], Field(strict=False)] = Field(
        (), description="none: they are guessed from the leaf links"
    )
    joints: Annotated[tuple[JointRecord, ...], Field(strict=False)] = ()

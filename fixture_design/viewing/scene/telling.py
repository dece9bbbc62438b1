"""What a story shows: things, a motion, words about both; made from one kind of evidence each (`stories`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fixture_design.contacts import Contact
from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.scene.scene import Animation, Label, Thing
from fixture_design.viewing.scene.shapes import Mesh, Points3, Vector3


@dataclass(frozen=True, eq=False)
class Told:
    """What is drawn for one answer; as in `Story`."""

    caption: str = ""
    things: tuple[Thing, ...] = ()
    labels: tuple[Label, ...] = ()
    animation: Animation | None = None
    without: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Backdrop:
    """What every story of a group has behind it.

    Attributes:
        path: of the story's things.  contacts: of the group.
        surface: of the part in W, or the pieces at the contacts where there is none.
        hull: its corners that stand out, which of all points move most.
        center, size: middle and half diagonal of the part [m].
    """

    path: str
    layout: Layout
    verdict: Verdict
    contacts: Sequence[Contact]
    surface: Mesh
    hull: Points3
    center: Vector3
    size: float


#: Layers that step aside where arrows of a story would be taken for theirs.
PLAIN = ("loads", "features")

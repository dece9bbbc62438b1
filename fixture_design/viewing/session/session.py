"""What a person has done to a layout so far, as a value: each operation gives the next one.

Nothing here draws, measures or decides. The steps that were made can be undone and made again; a slide counts as one
step however many places it passed through.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fixture_design.arrays import Point
from fixture_design.contacts import Role
from fixture_design.errors import UnknownNameError
from fixture_design.layout import Element, Layout, Tip
from fixture_design.viewing.session.sliding import Ground, slid


@dataclass(frozen=True, eq=False)
class Slid:
    """The slide that is going on: the element as it stood, and how far it has come from there [m]."""

    start: Element
    u: float = 0.0
    v: float = 0.0


@dataclass(frozen=True, eq=False)
class Session:
    """A layout that is being changed.

    Attributes:
        saved: the layout that a file holds, or that it began with: nobody made that here.
        chosen: name of the element that operations are about; None where there is none.
        before: what the layout was, the oldest first.  after: what was undone, the last undone last.
        slide: of the chosen element, as long as nothing else happens.
    """

    layout: Layout
    saved: Layout
    chosen: str | None = None
    before: tuple[Layout, ...] = ()
    after: tuple[Layout, ...] = ()
    slide: Slid | None = None

    @classmethod
    def of(cls, layout: Layout) -> Session:
        """The beginning: the first element is chosen, and there is nothing to lose yet."""
        return cls(layout, layout, layout.elements[0].name if layout.elements else None)

    @property
    def element(self) -> Element | None:
        """The chosen one."""
        return next((each for each in self.layout.elements if each.name == self.chosen), None)

    @property
    def unsaved(self) -> bool:
        """Whether something would be lost."""
        return self.layout is not self.saved


def chosen(session: Session, name: str) -> Session:
    """With another element chosen.

    Raises:
        UnknownNameError: no element is called that.
    """
    names = [element.name for element in session.layout.elements]
    if name not in names:
        raise UnknownNameError("element", name, names)
    return session if name == session.chosen else replace(session, chosen=name, slide=None)


def put(session: Session, layout: Layout, choose: str | None = None) -> Session:
    """With a changed layout as the next step; what was undone is forgotten.

    Args:
        choose: the element to be chosen then; by default the same, or where that is gone its neighbour.
    """
    return replace(
        session, layout=layout, chosen=_still(session, layout, choose), before=(*session.before, session.layout),
        after=(), slide=None,
    )  # fmt: skip


def slid_to(session: Session, ground: Ground, u: float, v: float) -> Session:
    """With the chosen element slid over the surface to (u, v) [m] from where this slide began.

    Raises:
        InputError: see `sliding.slid`; nothing is chosen.
    """
    slide = session.slide or Slid(needed(session))
    place = slid(slide.start, ground, u, v)
    layout = with_element(session.layout, place)
    if session.slide is not None:  # still the same step
        return replace(session, layout=layout, slide=Slid(slide.start, u, v))
    return replace(put(session, layout), slide=Slid(slide.start, u, v))


def with_role(session: Session, role: Role) -> Session:
    """The chosen element in another role; only clamps push with a preload."""
    element = needed(session)
    pushes = {} if role == "clamp" else {"preload": None, "limits": None}
    return put(session, with_element(session.layout, replace(element, role=role, **pushes)))


def with_tip(session: Session, tip: Tip) -> Session:
    """The chosen element with another tip."""
    return put(session, with_element(session.layout, replace(needed(session), tip=tip, axis=None)))


def added(session: Session, name: str, role: Role, at: Point) -> Session:
    """With a new element with a point for a tip, which is chosen then."""
    elements = (*session.layout.elements, Element(name, role, at))
    return put(session, replace(session.layout, elements=elements), choose=name)


def removed(session: Session) -> Session:
    """Without the chosen element."""
    element = needed(session)
    return put(session, replace(session.layout, elements=tuple(e for e in session.layout.elements if e is not element)))


def undone(session: Session) -> Session:
    """The layout before the last step, if there was one."""
    if not session.before:
        return session
    return _back_to(session, session.before[-1], session.before[:-1], (*session.after, session.layout))


def redone(session: Session) -> Session:
    """The last step undone, made again."""
    if not session.after:
        return session
    return _back_to(session, session.after[-1], (*session.before, session.layout), session.after[:-1])


def as_saved(session: Session) -> Session:
    """The same, now that a file holds its layout."""
    return replace(session, saved=session.layout)


def with_element(layout: Layout, element: Element) -> Layout:
    """A layout with this element in place of the one of its name."""
    return replace(layout, elements=tuple(element if e.name == element.name else e for e in layout.elements))


def needed(session: Session) -> Element:
    """The chosen element.

    Raises:
        UnknownNameError: none is chosen.
    """
    if session.element is None:
        raise UnknownNameError("element", session.chosen or "", [e.name for e in session.layout.elements])
    return session.element


def _back_to(session: Session, layout: Layout, before: tuple[Layout, ...], after: tuple[Layout, ...]) -> Session:
    return replace(session, layout=layout, chosen=_still(session, layout, None), before=before, after=after, slide=None)


def _still(session: Session, layout: Layout, choose: str | None) -> str | None:
    """Who is chosen after a change: the same one, or where it is gone the one in its place."""
    names = [element.name for element in layout.elements]
    wanted = choose or session.chosen
    if wanted in names or not names:
        return wanted if names else None
    old = [element.name for element in session.layout.elements]
    return names[min(old.index(wanted) if wanted in old else 0, len(names) - 1)]

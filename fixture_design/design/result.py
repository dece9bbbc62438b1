"""What a design is: a layout that holds, how it came about, and how much better another one could be."""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.arrays import Point, Vector
from fixture_design.design.steps import Step
from fixture_design.layout import Answer, Layout, Verdict


@dataclass(frozen=True)
class Bound:
    """How few elements could do.

    Attributes:
        locators, clamps: no layout that does what is asked has fewer; counted with those that must stay.
        elements: nor fewer in all, supports and bodies that stay among them.
        found: elements of the layout; None without one.
        complete: whether that is so in all directions out, or only in those that were tried.
        candidates: among how many it holds.
        letting_go: whether it is that of layouts where some direction leaves all locators at once (n . t < 0); others
            that the part slides out of may have fewer.
    """

    locators: int
    clamps: int
    elements: int
    found: int | None
    complete: bool
    candidates: int
    letting_go: bool = False

    @property
    def gap(self) -> int | None:
        """How many elements fewer there might be; 0: the layout has the fewest."""
        return None if self.found is None else self.found - self.elements

    @property
    def proven(self) -> bool:
        return self.complete and self.gap == 0


@dataclass(frozen=True)
class ChangeBound:
    """How few changes could do.

    Attributes:
        found: elements moved, added or removed, and preloads changed.
        bound: no layout among the candidates takes fewer.  complete: whether that is so in all directions out.
        candidates: how many places elements could be moved or added to; None where nothing had to change.
    """

    found: int
    bound: int
    complete: bool
    candidates: int | None = None

    @property
    def proven(self) -> bool:
        return self.complete and self.found == self.bound


@dataclass(frozen=True, eq=False)
class DesignResult:
    """The outcome of a design.

    Attributes:
        satisfied: yes: the layout's verdict is; no: no layout of the candidates does what is asked, proven; undecided:
            none was found, or its verdict is undecided.
        layout, verdict: None where there is none.
        steps: how it came from the start to this.
        bound: None where nothing could be said.
        out: the direction in W in which the part comes out of the locators.
        accuracy: worst error at a key feature for errors of 1 along the locators' normals, in its tolerances; without
            features 1 / volume of the locators' rows.
        best_accuracy: no locators with as few clamps have a smaller one [-], in the directions out that were tried (all
            of them where ``bound.complete``); None unknown.
        margin: of closure, in the verdict's scale; None where nothing has to close.
        preload: what the clamps push with in all [N]; None where nobody asks.  best_preload: no layout with as few
            clamps needs less [N]; None unknown.  best_preload_here: with these locators none does, whatever the clamps.
        changes: of a repair.
        free: [dx; dtheta] about W's origin, a motion that no candidate stops; None where there is none.
        reason: why there is no layout, or not the one that was asked for.
        notes: for people.
    """

    satisfied: Answer
    layout: Layout | None
    verdict: Verdict | None = None
    steps: tuple[Step, ...] = ()
    bound: Bound | None = None
    out: Point | None = None
    accuracy: float | None = None
    best_accuracy: float | None = None
    margin: float | None = None
    preload: float | None = None
    best_preload: float | None = None
    best_preload_here: float | None = None
    changes: ChangeBound | None = None
    free: Vector | None = None
    reason: str | None = None
    notes: tuple[str, ...] = ()


def closure_margin(verdict: Verdict) -> float | None:
    """The least of the closures that are required; None where none is, or no margin is known."""
    closures = [r for r in verdict.requirements if r.require in ("form_closure", "force_closure")]
    margins = [verdict.groups[r.group].findings[r.require].margin for r in closures]
    return min((margin for margin in margins if margin is not None), default=None)

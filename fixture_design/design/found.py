"""What a search finds: sets of elements, what they are worth, and what is proven about others."""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.arrays import Indices, Point


@dataclass(frozen=True, eq=False)
class Found:
    """A set of elements that does what is asked.

    Attributes:
        locators, clamps: indices of candidates.
        out: the direction out of the locators, where one was asked for.
        accuracy: worst error at a feature in its tolerances, for errors of 1 along the locators' normals; without
            features 1 / volume of the locators' rows.  margin: a lower bound of that of closure.
    """

    locators: Indices
    clamps: Indices
    out: Point | None
    accuracy: float
    margin: float

    @property
    def count(self) -> int:
        return len(self.locators) + len(self.clamps)

    def score(self, objective: tuple[str, ...]) -> tuple[float, ...]:
        """Small is good; what is not named in the objective comes last."""
        values = {"fewest": float(self.count), "accuracy": self.accuracy, "margin": -self.margin}
        order = [word for word in objective if word in values]
        return tuple(values[word] for word in [*order, *(word for word in values if word not in order)])


@dataclass(frozen=True, eq=False)
class Outcome:
    """The best set found, and what is proven.

    Attributes:
        least_clamps: no layout that does what is asked has fewer; None where none could be bounded.
        complete: whether the bounds hold for all directions, not only for those tried.
        best_accuracy: no locators with as few clamps have a smaller one; None where there is no layout.
        least_elements: where nothing is asked of the locators, no layout has fewer elements; else None.
    """

    found: Found | None
    least_clamps: int | None
    complete: bool
    best_accuracy: float | None = None
    least_elements: int | None = None

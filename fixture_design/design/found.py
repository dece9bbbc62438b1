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
        preload: the least that the clamps push with in all [N], inf where they cannot balance the loads within their
            limits; 0 where nobody asks.  holds: False where it is inf and the loads have to be held.
        seats: False where friction may keep the part off a locator that it has to sit on.
    """

    locators: Indices
    clamps: Indices
    out: Point | None
    accuracy: float
    margin: float
    preload: float = 0.0
    holds: bool = True
    seats: bool = True

    @property
    def count(self) -> int:
        return len(self.locators) + len(self.clamps)

    def score(self, objective: tuple[str, ...]) -> tuple[float, ...]:
        """Small is good: whether the loads are held, whether the part sits, then the objective; what it does not name
        comes last.
        """
        values = {
            "fewest": float(self.count), "accuracy": self.accuracy, "margin": -self.margin, "preload": self.preload,
        }  # fmt: skip
        order = [*objective, *(word for word in values if word not in objective)]
        return (float(not self.holds), float(not self.seats), *(values[word] for word in order))


@dataclass(frozen=True, eq=False)
class Outcome:
    """The best set found, and what is proven.

    Attributes:
        least_clamps: no layout that does what is asked has fewer; None where none could be bounded.
        complete: whether the bounds hold for all directions, not only for those tried.
        best_accuracy: no locators with as few clamps have a smaller one; None where there is no layout.
        best_preload: no layout with as few clamps has a smaller one [N]; None unknown, inf: none holds the loads.
        best_preload_here: with the locators that were found none has a smaller one [N].
        least_elements: where nothing is asked of the locators, no layout has fewer elements; else None.
    """

    found: Found | None
    least_clamps: int | None
    complete: bool
    best_accuracy: float | None = None
    best_preload: float | None = None
    best_preload_here: float | None = None
    least_elements: int | None = None

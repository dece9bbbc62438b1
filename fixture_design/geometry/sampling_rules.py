"""Where candidate points may be: on which facets, how far from edges, in which boxes and outside which."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask, Point, Points
from fixture_design.errors import GeometryError, format_length


@dataclass(frozen=True, eq=False)
class Box:
    """A closed box with its sides along W's axes, lowest and highest corner in W [m]; a rectangle in the plane."""

    low: Point
    high: Point

    def holds(self, p_W: Points) -> Mask:
        return np.all((p_W >= self.low) & (p_W <= self.high), axis=1)


@dataclass(frozen=True, eq=False)
class SamplingRules:
    """What candidates must keep to.

    Attributes:
        facets: allowed ones by number, as in their names ("facet 3" is 3); None allows all.
        edge_margin: least distance from sharp edges, or from the apices of a polygon [m].
        keep_out: no point is in any of these boxes.
        keep_in: every point is in one of these boxes; none means anywhere.
    """

    facets: Sequence[int] | None = None
    edge_margin: float = 0.0
    keep_out: Sequence[Box] = ()
    keep_in: Sequence[Box] = ()

    def __post_init__(self) -> None:
        if not (np.isfinite(self.edge_margin) and self.edge_margin >= 0):
            raise GeometryError("`edge_margin` must be 0 or more", found=str(self.edge_margin), expected="metres")
        for box in (*self.keep_out, *self.keep_in):
            finite = np.isfinite(box.low).all() and np.isfinite(box.high).all()
            if box.low.shape != box.high.shape or not finite or (box.low > box.high).any():
                found = f"{box.low.tolist()} and {box.high.tolist()}"
                raise GeometryError("a box needs its lowest and its highest corner", found=found)

    def allowed(self, numbers: Sequence[int], name: str) -> set[int]:
        """The allowed ones of a part's facet numbers.

        Raises:
            GeometryError: a number that no facet has.
        """
        if self.facets is None:
            return set(numbers)
        if unknown := sorted(set(self.facets) - set(numbers)):
            expected = f"numbers of {min(numbers)} to {max(numbers)}"
            if max(numbers) - min(numbers) + 1 != len(numbers):
                expected = f"one of {', '.join(map(str, sorted(numbers)))}"
            raise GeometryError(f"{name!r} has no facet {unknown[0]}", found=str(unknown), expected=expected)
        return set(self.facets)

    def boxes(self) -> dict[str, Callable[[Points], Mask]]:
        """The rules that need nothing but points in W, shape (n, p): {name: which points may stay}."""
        rules: dict[str, Callable[[Points], Mask]] = {}
        if self.keep_out:
            rules["keep_out"] = lambda p_W: ~np.any([box.holds(p_W) for box in self.keep_out], axis=0)
        if self.keep_in:
            rules["keep_in"] = lambda p_W: np.any([box.holds(p_W) for box in self.keep_in], axis=0)
        return rules


def check_spacing(spacing: float, what: str = "`spacing`") -> None:
    """Raises GeometryError unless a length is positive and finite."""
    if not (np.isfinite(spacing) and spacing > 0):
        raise GeometryError(f"{what} must be a length > 0", found=str(spacing), expected="metres")


def nothing_left(name: str, tried: int, removed: Mapping[str, int], edge_margin: float) -> GeometryError:
    """The error of rules that leave no point: which one removed how many."""
    by = [f"{rule} {count}" for rule, count in removed.items() if count]
    found = f"of {tried} points tried, removed by {', '.join(by)}" if by else f"{tried} points tried"
    hint = f" (it is {format_length(edge_margin)})" if removed.get("edge_margin") else ""
    expected = f"rules that leave room: a smaller `edge_margin`{hint}, other facets or boxes"
    return GeometryError(f"no candidate points are left on {name!r}", found=found, expected=expected)

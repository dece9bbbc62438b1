"""The search for grasps: where fingers may go, how the hand gets there, what it runs into, and what is best.

Sets of points of the part that close are proposed (`spots`, `wanted`), the hand's configurations that fit them best are
looked up (`library`), inverse kinematics makes the fingers touch (`reach`, `attempts`), and what runs into nothing is
judged (`judging`). Of each family, the fingers on the same features, the best stays (`finds`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import Scale
from fixture_design.errors import InputError, UnsupportedError
from fixture_design.geometry import PartGeometry, SurfacePoints, load_part
from fixture_design.grasp.attempts import DRAFTS, NOT_REACHED, Attempts
from fixture_design.grasp.finds import Finds, reason_of
from fixture_design.grasp.hand import Hand
from fixture_design.grasp.hand_loading import load_hand
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.judging import Site
from fixture_design.grasp.library import Library
from fixture_design.grasp.reach import Reach
from fixture_design.grasp.result import FacingRegion, GraspResult
from fixture_design.grasp.robustness import PoseError
from fixture_design.grasp.spots import Region, antipodal, closing_sets, opposite, regions_of, spread
from fixture_design.grasp.wanted import Progress, Wanted, fitting, in_turns
from fixture_design.layout import Answer, Part

#: Sets of points tried at most.
TRIES = 160

#: Sets whose seeds are looked up.
_SETS = 1500

#: Rounds more, where grasps are enough but some leave little of the friction.
_AGAIN = 4

#: What a region is called by the best verdict there.
_CALLED = {Answer.YES: "closed", Answer.UNDECIDED: "undecided", Answer.NO: "not closed"}


@dataclass(frozen=True, eq=False)
class Search:
    """What is asked of a search.

    Attributes:
        most: grasps wanted, one a family.
        tries: sets of points looked at at most; those of families that are full or given up count.
        seed: of the random numbers.
        table: height of a table in W [m]; None without one.
        load: wrench on the part about its centre of mass that the drives are to hold [N, N m]; None without one.
        error: of the part's pose, for robustness.

    Raises:
        InputError: less than one grasp or try, a negative seed, a table or load that is not finite, or a load that is
            no wrench.
    """

    most: int = 5
    tries: int = TRIES
    seed: int = 0
    table: float | None = None
    load: Vector | None = None
    error: PoseError = field(default_factory=PoseError)

    def __post_init__(self) -> None:
        for name, least in (("most", 1), ("tries", 1), ("seed", 0)):
            if getattr(self, name) < least:
                raise InputError(f"{name!r} is too small", found=str(getattr(self, name)), expected=f">= {least}")
        if self.table is not None and not np.isfinite(self.table):
            raise InputError("'table' is no height", found=str(self.table), expected="a finite number [m]")
        if self.load is not None and (np.shape(self.load) != (6,) or not np.isfinite(self.load).all()):
            expected = "six finite numbers: force [N] and moment [N m]"
            raise InputError("'load' is no wrench", found=str(self.load), expected=expected)


def check_kinds(hand: object, part: object) -> None:
    """Names of files, as the command line takes them, are neither hands nor parts here.

    Raises:
        InputError: the one is no hand, or the other no part.
    """
    if not isinstance(part, Part):
        expected = "a Part, such as fd.read_layout(file).part"
        raise InputError("this is no part", found=repr(part), expected=expected)
    if not isinstance(hand, Hand | HandModel):
        raise InputError("this is no hand", found=repr(hand), expected="fd.read_hand(file)")


def grasp(
    hand: Hand | HandModel,
    part: Part,
    search: Search | None = None,
    geometry: PartGeometry | None = None,
    progress: Progress = lambda words, part: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> GraspResult:
    """Grasps of a part: closed by proof, reachable, running into nothing; the best of each family, best first.

    Args:
        geometry: of the part, where it is loaded already.

    Raises:
        UnsupportedError: a planar part.
        InputError: the hand or the part cannot be used.
    """
    check_kinds(hand, part)
    if part.kind == "polygon":
        raise UnsupportedError("hands are spatial, and this part is planar", expected="a layout with role `finger`")
    search = search or Search()
    model = load_hand(hand) if isinstance(hand, Hand) else hand
    count = len(model.fingertips)
    if count < 2:
        # the palm or another link may hold against it, so this is no proof that there is no grasp
        fingers = "one fingertip" if count else "no fingertips"
        reason = f"{model.name} has {fingers}, and only grasps with two or more are looked for"
        return GraspResult(Answer.UNDECIDED, (), reason=reason, notes=model.notes)
    geometry = geometry or load_part(part)
    run = _Run(model, Site.of(part, geometry, search.table), search, progress, cancelled)
    return run.with_sets() if count > 2 else run.with_pairs()


class _Run:
    """One search: what is wanted of two or three fingertips, what is reached of it, and what that is worth."""

    def __init__(
        self, model: HandModel, site: Site, search: Search, progress: Progress, cancelled: Callable[[], bool]
    ) -> None:
        self.model, self.site, self.search = model, site, search
        self.progress, self.cancelled = progress, cancelled
        self.rng = np.random.default_rng(search.seed)
        self.points = spread(site.geometry, search.seed)
        self.friction = min(model.hand.friction if tip.friction is None else tip.friction for tip in model.fingertips)
        self.attempts = Attempts(model, site, Reach.of(model), self.rng, search.tries, progress, cancelled)
        self.finds = Finds(site, search.error, search.seed, search.load, progress)

    def with_sets(self) -> GraspResult:
        """Three fingertips at a time; if that gives nothing, two."""
        library = Library.of(self.model, 3, self.rng)
        scale = Scale(self.site.geometry.box_center, self.site.geometry.half_diagonal)
        thick = 2 * max(tip.radius for tip in self.model.fingertips)

        def closing(widest: float) -> np.ndarray:
            return closing_sets(self.points, scale, self.friction, 3, (thick, widest), self.rng)[0]

        sets = closing(library.widest + thick)[:_SETS]
        wanted = fitting(library, self.site.geometry, self.points, sets, self.progress, self.cancelled)
        if not wanted:
            anywhere = len(sets) > 0 or len(closing(np.inf)) > 0
            self.attempts.outcomes[
                "no three points that close are within reach"
                if anywhere
                else f"no three points of the part that were looked at close with friction {self.friction:g}"
            ] += 1
        self._look(library, wanted)
        return self._result() if self.finds.best else self.with_pairs()

    def with_pairs(self) -> GraspResult:
        """Two fingertips on all antipodal regions, in turns."""
        library = Library.of(self.model, 2, self.rng)
        flat = any(tip.pad for tip in self.model.fingertips)
        points, pairs = opposite(self.site.geometry, self.points)
        pairs = pairs[antipodal(points, pairs, self.friction, flat)]
        regions = regions_of(self.site.geometry, points, pairs)
        if not regions:
            what = "parallel faces opposite each other" if flat else "faces within each other's friction cones"
            self.attempts.outcomes[f"the part has no {what}"] += 1
            return self._result()
        wanted = [self._of_region(points, region, library.widest) for region in regions]
        facing = [_outcome(region, "too wide") for region in regions]
        if not any(wanted):
            least, most = min(r.widths.min() for r in regions), library.widest
            reason = f"the part is {least * 1000:.3g} mm wide at least, and the hand opens to {most * 1000:.3g} mm"
            return replace(self._result(), regions=tuple(facing), reason=reason)
        self._look(library, in_turns(wanted))
        facing = [
            _outcome(region, self._became(region.features)) if some else there
            for region, some, there in zip(regions, wanted, facing, strict=True)
        ]
        return replace(self._result(), regions=tuple(facing))

    def _of_region(self, points: SurfacePoints, region: Region, widest: float) -> list[Wanted]:
        """Pairs of a region that are not too wide, those about the part's middle first."""
        fits = region.pairs[region.widths <= widest]
        middles = (points.points[fits[:, 0]] + points.points[fits[:, 1]]) / 2
        off = np.linalg.norm(middles - self.site.geometry.box_center, axis=1)
        return [Wanted.of(self.site.geometry, points, fits[number]) for number in np.argsort(off, kind="stable")]

    def _look(self, library: Library, wanted: Iterable[Wanted]) -> None:
        """Drafts are made and judged until there are as many grasps as are wanted, or enough was tried.

        What turns out undecided, or not to hold the load, does not count, and its family is tried again; so are, for
        some rounds, families whose best leaves little of the friction.
        """
        drafts = self.attempts.drafts(library, wanted)
        left = _AGAIN
        while more := list(islice(drafts, DRAFTS * max(1, self.search.most - len(self.finds.good)))):
            self.finds.judge(more)
            tight = self.finds.tight()
            found = len(self.finds.good)
            if len({*self.finds.good} - tight) >= self.search.most or (found >= self.search.most and not left):
                return
            left -= found >= self.search.most
            for features in {*self.finds.best} - {*self.finds.good} | tight:
                del self.attempts.full[features]

    def _became(self, features: tuple[str, str]) -> str:
        """What became of a region."""
        if features in self.finds.best:
            return _CALLED[self.finds.best[features].closed]
        failed = self.attempts.by_features.get(features)
        if failed is None:
            return "not tried"
        (words, _), *_ = failed.most_common(1)
        return "not reached" if words == NOT_REACHED else words

    def _result(self) -> GraspResult:
        stopped = self.attempts.stopped
        grasps = self.finds.grasps(self.search.most)
        tried = dict(self.attempts.outcomes.most_common())
        if self.finds.good:
            notes = ("the search was stopped before all was tried",) if stopped else ()
            return GraspResult(Answer.YES, grasps, (), tried, None, (*self._notes, *notes))
        reason = self.finds.reason or reason_of(self.attempts.outcomes)
        if stopped:
            what = "all was tried" if self.finds.best else "it had found any grasp"
            reason = (
                f"the search was stopped before {what}; {reason}" if tried else f"the search was stopped before {what}"
            )
        return GraspResult(Answer.UNDECIDED, grasps, (), tried, reason, self._notes)

    @property
    def _notes(self) -> tuple[str, ...]:
        return (*self.model.notes, *self.site.geometry.notes)


def _outcome(region: Region, outcome: str) -> FacingRegion:
    return FacingRegion(region.features, len(region.pairs), _width(region), outcome)


def _width(region: Region) -> tuple[float, float]:
    return float(region.widths.min()), float(region.widths.max())

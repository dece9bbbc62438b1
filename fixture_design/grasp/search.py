"""The search for grasps: where fingers may go, how the hand gets there, what it runs into, and what is best.

Sets of points of the part that close are proposed (`spots`), the hand's configurations that fit them best are looked up
(`library`), inverse kinematics makes the fingers touch (`reach`), and what runs into nothing is judged (`judging`).
Features of the part take turns, so that what is found differs; of each family, the fingers on the same features, the
best stays.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import Scale
from fixture_design.errors import InputError, UnsupportedError
from fixture_design.geometry import PartGeometry, SurfacePoints, load_part
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.hand import Hand
from fixture_design.grasp.hand_loading import load_hand
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.judging import Draft, Site, better_first, drafted, judged, obstacle, with_strength
from fixture_design.grasp.library import Library, Seed, Spots
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.reach import Reach
from fixture_design.grasp.result import FacingRegion, Grasp, GraspResult
from fixture_design.grasp.robustness import PoseError
from fixture_design.grasp.rolling import rolled
from fixture_design.grasp.skin import Skin
from fixture_design.grasp.spots import (
    Region,
    antipodal,
    closing_sets,
    feature,
    opposite,
    regions_of,
    spots_at,
    spread,
)
from fixture_design.layout import Answer, Part, Pose

#: Words and how much is done, 0 to 1.
Progress = Callable[[str, float], None]

#: Sets of points tried at most; drafts made of one family, and those of them that are judged.
TRIES, DRAFTS, JUDGED = 160, 3, 2

#: Failures in a row after which a family is given up.
PATIENCE = 24

#: Seeds tried for one pair of points, and those that fit best from which they are taken.
_SEEDS, _ALIKE = 6, 48

#: Sets whose seeds are looked up, so many each; and those of all seeds that are compared by what runs into the part.
_SETS, _LOOKED_UP, _COMPARED = 1500, 4, 600

#: Sets that miss by more than this before inverse kinematics are not tried [m].
_TOO_FAR = 0.03


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


@dataclass(frozen=True, eq=False)
class _Wanted:
    """A set of spots to be reached, the features they are on, and seeds, where they were looked up already."""

    spots: Spots
    features: tuple[str, ...]
    seeds: tuple[Seed, ...] = ()


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
    """One search, and what became of its tries."""

    def __init__(
        self, model: HandModel, site: Site, search: Search, progress: Progress, cancelled: Callable[[], bool]
    ) -> None:
        self.model, self.site, self.search = model, site, search
        self.progress, self.cancelled = progress, cancelled
        self.rng = np.random.default_rng(search.seed)
        self.outcomes: Counter[str] = Counter()
        self.answers: dict[tuple[str, ...], Answer] = {}
        self.points = spread(site.geometry, search.seed)
        self.reach = Reach.of(model)
        self.friction = min(model.hand.friction if tip.friction is None else tip.friction for tip in model.fingertips)

    def with_sets(self) -> GraspResult:
        """Three fingertips at a time; if that gives nothing, two."""
        library = Library.of(self.model, 3, self.rng)
        scale = Scale(self.site.geometry.box_center, self.site.geometry.half_diagonal)
        thick = 2 * max(tip.radius for tip in self.model.fingertips)
        sets, _ = closing_sets(self.points, scale, self.friction, 3, (thick, library.widest + thick), self.rng)
        drafts = self._tried(library, self._fitting(library, sets[:_SETS]))
        return self._result(drafts) if drafts else self.with_pairs()

    def _fitting(self, library: Library, sets: np.ndarray) -> list[_Wanted]:
        """Sets of points with the seeds that fit, first those that miss least with least of the hand in the part."""
        fits = []
        for number, chosen in enumerate(sets):
            seeds = library.seeds(spots_at(self.points, chosen), _LOOKED_UP)
            fits += [(seed.off, number, seed) for seed in seeds if seed.off <= _TOO_FAR]
        fits.sort(key=lambda fit: fit[:2])
        if not fits:
            self.outcomes["no three points that close are within reach"] += 1
        skin = Skin.of(self.model)
        ranked = []
        for done, (off, number, seed) in enumerate(fits[:_COMPARED]):
            self.progress("looking for ways to reach around the part", done / min(len(fits), _COMPARED))
            ranked.append((off + skin.depth(seed, self.site.geometry), number, seed))
        ranked.sort(key=lambda fit: fit[:2])
        return [replace(self._wanted(self.points, sets[number]), seeds=(seed,)) for _, number, seed in ranked]

    def with_pairs(self) -> GraspResult:
        """Two fingertips on all antipodal regions, in turns."""
        library = Library.of(self.model, 2, self.rng)
        flat = any(tip.pad for tip in self.model.fingertips)
        points, pairs = opposite(self.site.geometry, self.points)
        pairs = pairs[antipodal(points, pairs, self.friction, flat)]
        regions = regions_of(self.site.geometry, points, pairs)
        if not regions:
            what = "parallel faces opposite each other" if flat else "faces within each other's friction cones"
            return GraspResult(Answer.UNDECIDED, (), (), {}, f"the part has no {what}", self.model.notes)
        middle = self.site.geometry.box_center
        wanted: list[list[_Wanted]] = []
        narrow = []
        for region in regions:
            fits = region.pairs[region.widths <= library.widest]
            narrow += [region] if not len(fits) else []
            off = np.linalg.norm((points.points[fits[:, 0]] + points.points[fits[:, 1]]) / 2 - middle, axis=1)
            wanted.append([self._wanted(points, fits[number]) for number in np.argsort(off, kind="stable")])
        if len(narrow) == len(regions):
            least, most = min(r.widths.min() for r in regions), library.widest
            reason = f"the part is {least * 1000:.3g} mm wide at least, and the hand opens to {most * 1000:.3g} mm"
            facing = tuple(_outcome(region, {}, "too wide") for region in regions)
            return GraspResult(Answer.UNDECIDED, (), facing, {}, reason, self.model.notes)
        drafts = self._tried(library, _in_turns(wanted))
        result = self._result(drafts)
        done = {
            features: "closed" if answer is Answer.YES else str(answer) for features, answer in self.answers.items()
        }
        narrow_ones = {region.features for region in narrow}
        facing = tuple(
            _outcome(region, done, "too wide" if region.features in narrow_ones else "not reached")
            for region in regions
        )
        return GraspResult(result.satisfied, result.grasps, facing, result.tried, result.reason, result.notes)

    def _wanted(self, points: SurfacePoints, chosen: np.ndarray) -> _Wanted:
        names = tuple(sorted(feature(self.site.geometry, int(points.facets[number])) for number in chosen))
        return _Wanted(spots_at(points, chosen), names)

    def _tried(self, library: Library, wanted: Iterable[_Wanted]) -> list[Draft]:
        """Drafts of what is reached, until there are enough, or enough was tried."""
        drafts: list[Draft] = []
        families: Counter[tuple[str, ...]] = Counter()
        failures: Counter[tuple[str, ...]] = Counter()
        for number, one in enumerate(wanted):
            if number >= self.search.tries or self.cancelled():
                break
            if families[one.features] >= DRAFTS or failures[one.features] >= PATIENCE:
                continue
            if len(drafts) >= DRAFTS * self.search.most:
                break
            share = number / self.search.tries
            self.progress(f"{len(drafts)} grasps; trying {', '.join(one.features)}", share)
            draft = self._first(one, ((seed,) for seed in one.seeds) if one.seeds else self._ways(library, one.spots))
            if draft is not None:
                drafts.append(draft)
                families[one.features] += 1
                failures[one.features] = 0
            else:
                failures[one.features] += 1
        return drafts

    def _ways(self, library: Library, spots: Spots) -> Iterator[Iterable[Seed]]:
        """Configurations that fit two spots, each with ways round the line between them."""
        if len(self.model.free) == 1:  # one way to be as wide as that
            seeds = library.seeds(spots, 1)
        else:
            seeds = library.seeds(spots, _ALIKE)
            # which ones differs from pair to pair: those of two parallel faces all have the same nearest ones
            seeds = [seeds[number] for number in np.sort(self.rng.choice(len(seeds), min(_SEEDS, len(seeds)), False))]
        for seed in seeds:
            yield rolled(seed, spots, self.rng)

    def _first(self, wanted: _Wanted, ways: Iterable[Iterable[Seed]]) -> Draft | None:
        """The first seed that leads to a grasp; of a way that cannot be solved the others are the same but turned."""
        outcome = "nothing reaches there"
        for way in ways:
            for seed in way:
                found = self.reach.solve(wanted.spots, seed)
                if found is None:
                    break
                draft = self._drafted(seed, *found)
                if isinstance(draft, Draft):
                    self.outcomes["closed"] += 1
                    return draft
                outcome = draft
        self.outcomes[outcome] += 1
        return None

    def _drafted(self, seed: Seed, q: np.ndarray, X_PH: Pose) -> Draft | str:
        """The grasp, or what is in its way, or why it is none."""
        posture = Posture(self.model, q, composed(self.site.part.pose, X_PH))
        tips = [self.model.fingertips[tip] for tip in seed.tips]
        in_the_way = obstacle(posture, self.site, tips)
        return drafted(posture, self.site, tips) if in_the_way is None else in_the_way

    def _result(self, drafts: list[Draft]) -> GraspResult:
        judged_ones: list[Grasp] = []
        chosen = _best_of_each(drafts)
        for number, draft in enumerate(chosen):
            self.progress("judging what was found", number / len(chosen))
            judged_ones.append(judged(draft, self.site, self.search.error, self.search.seed))
        best: dict[tuple[str, ...], Grasp] = {}
        for one in better_first(judged_ones):
            best.setdefault(one.features, one)
        self.answers = {features: one.closed for features, one in best.items()}
        grasps = tuple(with_strength(one, self.search.load) for one in list(best.values())[: self.search.most])
        tried = dict(self.outcomes.most_common())
        holding = [g for g in grasps if g.closed is Answer.YES and (self.search.load is None or g.held is not None)]
        if holding:
            return GraspResult(Answer.YES, (*holding, *(g for g in grasps if g not in holding)), (), tried, None,
                               self.model.notes)  # fmt: skip
        return GraspResult(Answer.UNDECIDED, grasps, (), tried, self._reason(grasps), self.model.notes)

    def _reason(self, grasps: tuple[Grasp, ...]) -> str:
        if grasps and self.search.load is not None:
            return "no grasp that was found holds the load"
        if grasps:
            return "the verdicts of all grasps that were found are undecided"
        if not self.outcomes:
            return "nothing was within reach"
        told = "; ".join(f"{words} ({count})" for words, count in self.outcomes.most_common(4))
        return f"no grasp was found: {told}"


def _best_of_each(drafts: list[Draft]) -> list[Draft]:
    """The drafts of each family that are best by epsilon, or where it is not known by least weight."""

    def worth(draft: Draft) -> float:
        return draft.quality.least_weight if draft.quality.epsilon is None else draft.quality.epsilon

    families: dict[tuple[str, ...], list[Draft]] = {}
    for draft in sorted(drafts, key=worth, reverse=True):
        families.setdefault(draft.features, []).append(draft)
    return [draft for family in families.values() for draft in family[:JUDGED]]


def _in_turns(lists: list[list[_Wanted]]) -> Iterator[_Wanted]:
    """One of each list, then the second of each, and so on."""
    for number in range(max(map(len, lists), default=0)):
        yield from (one[number] for one in lists if number < len(one))


def _outcome(region: Region, done: dict[tuple[str, ...], str], otherwise: str) -> FacingRegion:
    width = float(region.widths.min()), float(region.widths.max())
    return FacingRegion(region.features, len(region.pairs), width, done.get(region.features, otherwise))

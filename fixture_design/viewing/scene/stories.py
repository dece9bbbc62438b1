"""One story an answer: what of its evidence can be seen."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence

from fixture_design.contacts import Contact
from fixture_design.layout import (
    USE_CLAIMS,
    Answer,
    Balance,
    Finding,
    Layout,
    LoadsHeld,
    LocatingErrors,
    Motion,
    Seating,
    Singular,
    StraightWays,
    Unbalanced,
    Verdict,
    element_name,
)
from fixture_design.viewing.scene.balance_telling import told_balance, told_weights
from fixture_design.viewing.scene.elements import element_path
from fixture_design.viewing.scene.motion_telling import told_errors, told_motion, told_unbalanced, told_way
from fixture_design.viewing.scene.scene import Story
from fixture_design.viewing.scene.shapes import Mesh, Points3, Vector3
from fixture_design.viewing.scene.telling import Backdrop, Told
from fixture_design.viewing.words import evidence_in_words

#: Claims that are denied by a motion which nothing resists: the smallest push along it is enough.
_HOLDING = ("form_closure", "force_closure")


def stories_of(
    layout: Layout,
    verdict: Verdict,
    surface: Mesh,
    hull: Points3,
    center: Vector3,
    size: float,
    tell: Collection[tuple[str, str]] | None = None,
) -> tuple[Story, ...]:
    """The answers of all groups in the order of the verdict; of groups with the same contacts the shared ones once.

    Arguments as of `scene_of` and `Backdrop`.
    """
    required = {(requirement.group, requirement.require) for requirement in verdict.requirements}
    told = dict[tuple[str, ...], str]()
    stories: list[Story] = []
    for group in verdict.groups.values():
        first = told.setdefault(group.contacts, group.name) == group.name
        inside = set(group.contacts)
        contacts = [contact for contact in verdict.contacts if contact.name in inside]
        others = tuple(_outside(layout, verdict, contacts))
        for claim, finding in group.findings.items():
            if not first and claim not in USE_CLAIMS and (group.name, claim) not in required:
                continue
            wanted = tell is None or (group.name, claim) in tell
            stage = Backdrop(f"stories/{len(stories)}", layout, verdict, contacts, surface, hull, center, size)
            shown = _told(stage, claim, finding) if contacts and wanted else Told()
            words = evidence_in_words(claim, finding, verdict.reference, verdict.length)
            stories.append(
                Story(
                    stage.path, group.name, claim, finding.answer, (group.name, claim) in required, words,
                    shown.caption, shown.things, shown.labels, shown.animation, (*shown.without, *others),
                )
            )  # fmt: skip
    return tuple(stories)


def _outside(layout: Layout, verdict: Verdict, contacts: list[Contact]) -> Iterator[str]:
    """Paths of what is not there while a group is looked at: other elements, other contacts."""
    names = {contact.name for contact in contacts}
    owners = {element_name(name) for name in names}
    for owner in (*layout.elements, *layout.bodies):
        path = element_path(layout, owner.name)
        if owner.name not in owners and path is not None:
            yield path
    for number, contact in enumerate(verdict.contacts):
        if contact.name not in names:
            yield from (f"{layer}/{number}" for layer in ("contacts", "normals", "cones"))


def _told(stage: Backdrop, claim: str, finding: Finding) -> Told:
    """By the kind of the evidence."""
    if finding.use is not None:
        return _told_use(stage, finding)
    match finding.evidence:
        case Motion():
            breaks = finding.answer is Answer.NO and claim in _HOLDING
            return told_motion(stage, finding.evidence.motion, breaks=breaks)
        case Singular():
            motion = finding.evidence.motion
            return Told() if motion is None else told_motion(stage, motion, breaks=False, both_ways=True)
        case tuple():
            return told_weights(stage, finding.evidence, finding)
    return Told()


def _told_use(stage: Backdrop, finding: Finding) -> Told:
    use = finding.use
    match use:
        case LocatingErrors():
            return told_errors(stage, use, finding.answer)
        case StraightWays():
            return told_way(stage, use)
        case LoadsHeld():
            worst = use.loads[use.worst]
            if isinstance(worst.proof, Unbalanced):
                return told_unbalanced(stage, worst.proof, worst)
            return Told() if worst.proof is None else told_balance(stage, worst.proof, worst, use.weight)
        case Seating():
            failed = [step for step in use.steps if step.answer is Answer.NO]
            proof = (failed or use.steps)[-1].proof
            if isinstance(proof, Unbalanced):
                return told_unbalanced(stage, proof, None)
            return told_balance(stage, proof, None, use.weight) if isinstance(proof, Balance) else Told()
    return Told()


def first_story(stories: tuple[Story, ...]) -> int | None:
    """The one to begin with among those with something to see: see `foremost`."""
    shown = [number for number, story in enumerate(stories) if story.shown]
    found = foremost([(stories[k].claim, stories[k].group, stories[k].answer, stories[k].required) for k in shown])
    return None if found is None else shown[found]


def foremost(answers: Sequence[tuple[str, str, Answer | None, bool]]) -> int | None:
    """Of answers, as (claim, group, answer, required), the number of the one that matters most.

    What is required and fails; what is required and undecided; what carries the loads; whether the part is held, as
    somebody asked, by everything, by anything; the first. None without any.
    """
    order: list[Callable[[str, str, Answer | None, bool], bool]] = [
        lambda claim, group, answer, required: required and answer is Answer.NO,
        lambda claim, group, answer, required: required and answer is Answer.UNDECIDED,
        lambda claim, group, answer, required: claim == "holds_loads",
        lambda claim, group, answer, required: required and claim in _HOLDING,
        lambda claim, group, answer, required: group == "all" and claim == "form_closure",
        lambda claim, group, answer, required: claim in _HOLDING,
        lambda claim, group, answer, required: True,
    ]
    return next((k for fits in order for k, each in enumerate(answers) if fits(*each)), None)

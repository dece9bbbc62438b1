"""Recognition over time: what remains possible, sample after sample."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from fixture_design.arrays import ArrayLike
from fixture_design.recognition.classifier import Classifier, Recognition


@dataclass(frozen=True, eq=False)
class Recogniser:
    """A classifier and the states that the process may be in; each step returns a new one.

    Attributes:
        possible: ids; at the start all states, or those that are known.
        latest: the last answer.

    Example:
        >>> recogniser = Recogniser.start(classifier, "N1")  # doctest: +SKIP
        >>> for wrench in wrenches:  # doctest: +SKIP
        ...     recogniser = recogniser.step(wrench)
    """

    classifier: Classifier
    possible: tuple[str, ...]
    latest: Recognition | None = None

    @classmethod
    def start(cls, classifier: Classifier, known: str | Iterable[str] | None = None) -> Recogniser:
        """Before the first sample.

        Args:
            known: the state, or the states, that the process may be in.

        Raises:
            UnknownNameError: no such state.
        """
        if known is None:
            return cls(classifier, classifier.ids)
        names = (known,) if isinstance(known, str) else tuple(known)
        return cls(classifier, tuple(classifier.state(name).id for name in names))

    def step(self, wrench: ArrayLike | None, twist: ArrayLike | None = None) -> Recogniser:
        """After one more sample: the states that it leaves of those possible before and their successors.

        Where it leaves none, all states are asked (`Recognition.expected` is False); where none at all fits, what was
        possible before stays. A sample that tells nothing leaves all successors possible.

        Raises: as `Classifier.recognize`.
        """
        answer = self.classifier.recognize(wrench, twist, previous=self.possible)
        if answer.states:
            return replace(self, possible=answer.states, latest=answer)
        return replace(self, latest=answer)

"""Logs of measurements, and the states along them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Weights, read_only
from fixture_design.errors import InputError
from fixture_design.recognition.classifier import Classifier, Recognition
from fixture_design.recognition.numbers_of import numbers_of
from fixture_design.recognition.recogniser import Recogniser
from fixture_design.recognition.sensor import Sensor
from fixture_design.tolerances import MOST_FORCE


@dataclass(frozen=True, eq=False)
class Log:
    """Measurements in a row, in the sensor's frame.

    Attributes:
        times: shape (n,) [s].
        wrenches: that the robot applies to the part, shape (n, d); zeros, which tell nothing, where none were measured.
        twists: likewise, or None.
        truth: of each row the contacts that there really were, sorted, where somebody knows; only for scoring.
        unused: columns of its file that are left out, since the parts are planar.
    """

    times: Weights
    wrenches: Rows
    twists: Rows | None = None
    truth: tuple[tuple[str, ...], ...] | None = None
    unused: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        times: ArrayLike,
        wrenches: ArrayLike | None,
        twists: ArrayLike | None = None,
        truth: Sequence[tuple[str, ...]] | None = None,
    ) -> Log:
        """A log of arrays.

        Raises:
            InputError: shapes that do not fit, no row, numbers that are not finite or beyond any force, times that run
                backwards; with the row, counted from 1.
        """
        t = numbers_of(times, "times")
        v = None if twists is None else numbers_of(twists, "twists")
        if wrenches is None and v is None:
            raise InputError("a log has wrenches, twists or both", found="neither")
        p = np.zeros_like(v) if wrenches is None else numbers_of(wrenches, "wrenches")
        if t.ndim != 1 or p.ndim != 2 or len(t) != len(p) or p.shape[1] not in (3, 6):
            raise InputError(
                "a log is n times and n wrenches of 3 or 6 numbers", found=f"arrays of shape {t.shape} and {p.shape}"
            )
        if not len(t):
            raise InputError("the log has no rows")
        if v is not None and v.shape != p.shape:
            raise InputError("twists must be as many as wrenches", found=f"arrays of shape {p.shape} and {v.shape}")
        for name, rows in (("time", t[:, None]), ("wrench", p), ("twist", v)):
            if rows is not None:
                _require_usable(name, rows)
        _require_forwards(t)
        if truth is not None and len(truth) != len(t):
            raise InputError("true contacts must be as many as wrenches", found=f"{len(truth)} for {len(t)} rows")
        contacts = None if truth is None else tuple(tuple(sorted(some)) for some in truth)
        return cls(read_only(t), read_only(p), None if v is None else read_only(v), contacts)

    def __len__(self) -> int:
        return len(self.times)


def recognize_log(
    classifier: Classifier, log: Log, sensor: Sensor | None = None, known: str | Iterable[str] | None = None
) -> list[Recognition]:
    """The answer of every row, each with the states that those before left.

    Args:
        sensor: None: the log is in the classifier's frame.  known: the state before the first row, or those it may be.

    Raises:
        InputError: a log of another dimension, or without what the classifier needs.
        UnknownNameError: no such state.
    """
    size = classifier.signals.wrench_size
    if log.wrenches.shape[1] != size:
        raise InputError(
            f"the classifier is of {'planar' if size == 3 else 'spatial'} parts, the log is not",
            found=f"wrenches of {log.wrenches.shape[1]} numbers", expected=f"{size}",
        )  # fmt: skip
    if classifier.signals.measure == "displacement" and log.twists is None:
        raise InputError("this classifier tells states from displacements, and the log has none")
    sensor = sensor or Sensor.of(classifier.signals.plane)
    if len(sensor.tare) != size:
        raise InputError(f"a sensor of {len(sensor.tare)} numbers, a log of {size}", expected="both planar or spatial")
    wrenches = sensor.wrenches(log.wrenches)
    twists = [None] * len(log) if log.twists is None else list(sensor.twists(log.twists))
    recogniser, answers = Recogniser.start(classifier, known), []
    for wrench, twist in zip(wrenches, twists, strict=True):
        recogniser = recogniser.step(wrench, twist)
        assert recogniser.latest is not None
        answers.append(recogniser.latest)
    return answers


def _require_forwards(times: Weights) -> None:
    back = np.flatnonzero(np.diff(times) < 0)
    if len(back):
        k = int(back[0]) + 1
        raise InputError(
            f"row {k + 1}: time runs backwards", found=f"{times[k]:g} s after {times[k - 1]:g} s",
            expected="times that do not decrease",
        )  # fmt: skip


def _require_usable(name: str, rows: Rows) -> None:
    bad = np.flatnonzero(~(np.isfinite(rows) & (np.abs(rows) <= MOST_FORCE)).all(axis=1))
    if len(bad):
        more = f" (and {len(bad) - 1} more rows)" if len(bad) > 1 else ""
        raise InputError(
            f"row {bad[0] + 1}: the {name} is not usable{more}",
            found=str(rows[bad[0]].tolist()), expected=f"finite numbers up to {MOST_FORCE:g}",
        )  # fmt: skip

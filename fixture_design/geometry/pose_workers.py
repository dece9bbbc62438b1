"""One number for each of many poses, in worker processes if asked: Drake's queries hold the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fixture_design.arrays import Weights
from fixture_design.errors import GeometryError
from fixture_design.layout import Pose

#: Poses that a worker gets at a time: enough that handing them over costs nothing, few enough that all stay busy.
_AT_A_TIME = 64

#: The question, in a worker.
_question: list[Callable[[Pose], float]] = []


def over_poses(question: Callable[[Pose], float], poses: Sequence[Pose], processes: int) -> Weights:
    """The answers in the order of the poses, shape (n,); the same with any number of processes.

    Workers are fresh interpreters: a fork of a process in which Drake or a viewer has threads may hang.

    Args:
        question: picklable, where there are workers.

    Raises:
        GeometryError: fewer than one process, or a worker that ended; and what the question raises.
    """
    if processes < 1:
        raise GeometryError("there must be one process or more", found=str(processes))
    if processes == 1:
        return np.array([question(pose) for pose in poses], dtype=np.float64)
    # imported here: one process is the rule, and starting must be quick
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    try:
        with ProcessPoolExecutor(processes, get_context("spawn"), _receive, (question,)) as workers:
            return np.array(list(workers.map(_answer, poses, chunksize=_AT_A_TIME)), dtype=np.float64)
    except BrokenProcessPool as cause:
        expected = "processes=1; or, in a script, `if __name__ == '__main__':` around what it does"
        raise GeometryError("a worker process ended before it had an answer", expected=expected) from cause


def _receive(question: Callable[[Pose], float]) -> None:
    _question.append(question)


def _answer(pose: Pose) -> float:
    return _question[-1](pose)

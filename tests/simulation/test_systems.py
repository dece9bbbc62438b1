"""Recognition as a Drake system says what `Recogniser` says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.io import read_log, write_log
from fixture_design.recognition import Classifier, Log, Recogniser, Sensor, recognize_log
from fixture_design.simulation import Outcome, recognition_system
from fixture_design.simulation.systems import AMBIGUOUS
from tests.simulation.peg import KEPT

PERIOD = 0.01


def stepped(system, log: Log) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """The outputs after each row, in a simulation of the system alone."""
    from pydrake.systems.analysis import Simulator

    simulator = Simulator(system)
    context = simulator.get_mutable_context()
    wrench = system.GetInputPort("wrench").FixValue(context, log.wrenches[0])
    found = []
    for k, row in enumerate(log.wrenches):
        wrench.GetMutableData().set_value(row)
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        values = [system.GetOutputPort(name).Eval(context) for name in ("state", "possible", "margins")]
        found.append((float(values[0][0]), values[1], values[2]))
    return found


def test_it_says_what_the_recogniser_says(peg_classifier: Classifier, inserted: Outcome) -> None:
    log = inserted.run.log
    ids = peg_classifier.ids
    recogniser = Recogniser.start(peg_classifier, "N1")
    singles = 0
    for row, (state, possible, margins) in zip(
        log.wrenches, stepped(recognition_system(peg_classifier, PERIOD, "N1"), log), strict=True
    ):
        recogniser = recogniser.step(row)
        assert recogniser.latest is not None
        assert tuple(name for name, chosen in zip(ids, possible, strict=True) if chosen) == recogniser.possible
        for name, margin in zip(ids, margins, strict=True):
            assert margin == recogniser.latest.margins.get(name, -np.inf)
        single = len(recogniser.possible) == 1
        singles += single
        assert state == (ids.index(recogniser.possible[0]) if single else AMBIGUOUS)


def test_a_state_that_is_known_is_shown_from_the_start(peg_classifier: Classifier) -> None:
    system = recognition_system(peg_classifier, PERIOD, "N4")
    context = system.CreateDefaultContext()
    assert system.GetOutputPort("state").Eval(context)[0] == peg_classifier.ids.index("N4")
    unknown = recognition_system(peg_classifier, PERIOD)
    assert unknown.GetOutputPort("state").Eval(unknown.CreateDefaultContext())[0] == AMBIGUOUS
    with pytest.raises(UnknownNameError, match="N77"):
        recognition_system(peg_classifier, PERIOD, "N77")
    for period in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="a period is a positive number"):
            recognition_system(peg_classifier, period)


@pytest.mark.parametrize("name", ["insertion_1", "insertion_2"])
def test_kept_logs(name: str, peg: ContactStateGraph, peg_classifier: Classifier, tmp_path) -> None:
    """Two insertions as they were simulated once: what was true then, apices apart, is in today's answers."""
    log = read_log(KEPT / f"{name}.csv", 2)
    assert log.truth is not None
    assert log.twists is not None
    contacts = {state.contacts: state.id for state in peg.states if not state.coincident}
    answers = recognize_log(peg_classifier, log, known="N1")
    told = [
        contacts[truth] in answer.states
        for truth, answer in zip(log.truth, answers, strict=True)
        if answer.told and truth in contacts
    ]
    assert len(told) > 30
    assert np.mean(told) >= 0.95
    # a sensor mounted the wrong way round is found out: the truth is no longer in the answers
    wrong = recognize_log(peg_classifier, replace(log, wrenches=-log.wrenches), Sensor.of(2), known="N1")
    held = [contacts[t] in a.states for t, a in zip(log.truth, wrong, strict=True) if a.told and t in contacts]
    assert np.mean(held) < 0.6
    write_log(log, tmp_path / "again.csv")
    again = read_log(tmp_path / "again.csv", 2)
    np.testing.assert_array_equal(again.wrenches, log.wrenches)
    np.testing.assert_array_equal(again.twists, log.twists)
    assert again.truth == log.truth

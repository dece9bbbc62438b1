"""The simulated world: statics, friction, the sensor's errors, and true contacts against plain geometry."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from fixture_design.assembly import Assembly, AssemblyBody, ContactStateGraph, state_at
from fixture_design.errors import InputError, UnsupportedError
from fixture_design.recognition import Classifier, recognize_log
from fixture_design.simulation import Outcome, Run, Setup, Simulation, Surfaces, WristSensor
from fixture_design.simulation.belief import relative
from fixture_design.simulation.rectangles import Rectangle, rounded

EXACT = WristSensor(noise=0.0, bias=0.0, delay=0.0)


@dataclass
class Pushed:
    """A target at one place."""

    start: np.ndarray
    place: np.ndarray

    def target(self, _: object) -> np.ndarray:
        return self.place


def pushed(
    graph: ContactStateGraph, classifier: Classifier, place: list[float], setup: Setup, seconds: float = 1.0
) -> Run:
    """From 2 mm above, a target below the surface, and rest at the end."""
    goal = np.array(place)
    controller = Pushed(goal + np.array([0.0, 0.007, 0.0]), goal)
    return Simulation.of(graph.assembly, classifier, setup, np.zeros(3), "N1").run(controller, seconds)


def test_a_push_on_the_top_is_as_large_as_the_impedance_says(
    peg: ContactStateGraph, peg_classifier: Classifier
) -> None:
    """A flat peg on the left block, its target 5 mm below the top: 2000 N/m times 5 mm, straight down."""
    setup = Setup(sensor=EXACT)
    run = pushed(peg, peg_classifier, [-0.025, -0.005, 0.0], setup)
    assert run.log.truth is not None
    assert run.log.truth[-1] == ("apex 3 - facet 5", "apex 4 - facet 5")
    np.testing.assert_allclose(run.log.wrenches[-1], [0.0, -10.0, 0.0], atol=0.05)


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_friction_is_that_of_the_surfaces(peg: ContactStateGraph, peg_classifier: Classifier, friction: float) -> None:
    """A leaning peg's one corner is dragged over the top: the force is on the edge of the friction cone."""
    setup = Setup(surfaces=Surfaces(friction=friction), sensor=EXACT)

    class Dragged(Pushed):
        def target(self, sample) -> np.ndarray:
            return self.place + np.array([0.01 * sample.time, 0.0, 0.0])

    start = np.array([-0.03, 0.008, 0.3])
    run = Simulation.of(peg.assembly, peg_classifier, setup, np.zeros(3), "N1").run(
        Dragged(start, start - [0.0, 0.01, 0.0]), 1.0
    )
    assert run.log.truth is not None
    assert run.log.truth[-1] == ("apex 3 - facet 5",)
    fx, fy, _ = run.log.wrenches[-1]
    assert fx / -fy == pytest.approx(friction, rel=0.05)


def test_true_contacts_are_those_of_the_geometry(peg: ContactStateGraph, inserted: Outcome) -> None:
    """Every pair that Drake loads is closed, but for the rounded corners; and there are loaded pairs of many states."""
    run = inserted.run
    assert run.log.truth is not None
    seen = set()
    for truth, pose in zip(run.log.truth, relative(run.shift, run.poses), strict=True):
        near = state_at(peg.assembly, pose, within=2.5e-4).contacts
        assert set(truth) <= set(near), pose
        seen.add(truth)
    assert len(seen) >= 4


def test_the_sensor_errs_as_it_says(peg: ContactStateGraph, peg_classifier: Classifier) -> None:
    place = [-0.025, -0.005, 0.0]
    noisy = Setup(sensor=WristSensor(noise=0.05, bias=0.0, seed=3))
    run = pushed(peg, peg_classifier, place, noisy, 4.0)
    steady = run.log.wrenches[100:] / [1.0, 1.0, 0.01]
    error = np.linalg.norm(steady - [0.0, -10.0, 0.0], axis=1) / 10.0
    assert np.sqrt((error**2).mean()) == pytest.approx(0.05, rel=0.1)
    assert abs(steady.mean(axis=0) - [0.0, -10.0, 0.0]).max() < 0.1
    again = pushed(peg, peg_classifier, place, noisy, 0.5)
    other = pushed(peg, peg_classifier, place, replace(noisy, sensor=WristSensor(bias=0.0, seed=4)), 0.5)
    np.testing.assert_array_equal(again.log.wrenches, run.log.wrenches[: len(again.log)])
    assert not np.allclose(other.log.wrenches, again.log.wrenches)


def test_a_bias_is_the_same_all_the_time(peg: ContactStateGraph, peg_classifier: Classifier) -> None:
    setup = Setup(sensor=WristSensor(noise=0.0, bias=0.3, delay=0.0, seed=5))
    run = pushed(peg, peg_classifier, [0.0, 0.01, 0.0], replace(setup), 0.5)
    free = run.log.wrenches[30:]
    assert 0 < np.abs(free[-1] / [1.0, 1.0, 0.01]).max() <= 0.31
    np.testing.assert_allclose(free, np.broadcast_to(free[-1], free.shape), atol=0.02)


def test_the_answer_holds_the_truth_while_it_is_inserted(inserted: Outcome, peg_classifier: Classifier) -> None:
    log = inserted.run.log
    assert log.truth is not None
    contacts = {state.contacts: state.id for state in peg_classifier.states}
    answers = recognize_log(peg_classifier, log, known="N1")
    told = [
        contacts[truth] in answer.states
        for truth, answer in zip(log.truth, answers, strict=True)
        if answer.told and truth in contacts
    ]
    assert len(told) > 30
    assert np.mean(told) >= 0.95


def test_what_cannot_be_simulated(peg: ContactStateGraph, peg_classifier: Classifier) -> None:
    spatial = Assembly("boxes", "spatial", AssemblyBody("box", box=np.ones(3)), (AssemblyBody("box", box=np.ones(3)),))
    with pytest.raises(UnsupportedError, match="only planar"):
        Simulation.of(spatial, peg_classifier, Setup(), np.zeros(3))
    slanted = replace(peg.assembly.moving, polygon=np.array([[-0.01, 0.0], [0.01, 0.0], [0.012, 0.06], [-0.01, 0.06]]))
    with pytest.raises(UnsupportedError, match="only rectangles"):
        Simulation.of(replace(peg.assembly, moving=slanted), peg_classifier, Setup(), np.zeros(3))
    with pytest.raises(InputError, match="no state is called 'N99'"):
        Simulation.of(peg.assembly, peg_classifier, Setup(), np.zeros(3), "N99")


def test_rectangles_and_rounded_corners() -> None:
    c, s = np.cos(0.4), np.sin(0.4)
    turned = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]) @ np.array([[c, s], [-s, c]]) + [5.0, 1.0]
    found = Rectangle.of(turned)
    assert found.angle == pytest.approx(0.4)
    assert found.sides == pytest.approx((3.0, 2.0))
    np.testing.assert_allclose(found.centre, turned.mean(axis=0))
    ball = rounded(turned, 0, 0.1)
    for first, second in ((0, 1), (0, 3)):
        along = (turned[second] - turned[first]) / np.linalg.norm(turned[second] - turned[first])
        away = ball - turned[0]
        assert abs(along[0] * away[1] - along[1] * away[0]) == pytest.approx(0.1)
    with pytest.raises(UnsupportedError, match="3 vertices"):
        Rectangle.of(turned[:3])


def test_every_run_begins_anew_and_moves_the_target_when_told(
    peg: ContactStateGraph, peg_classifier: Classifier
) -> None:
    @dataclass
    class Counted(Pushed):
        asked: int = 0

        def target(self, sample) -> np.ndarray:
            self.asked += 1
            return self.place

    goal = np.array([-0.025, -0.005, 0.0])
    simulation = Simulation.of(peg.assembly, peg_classifier, Setup(), np.zeros(3), "N1")
    found = []
    for every, asked in ((1, 10), (1, 10), (2, 5), (3, 4)):
        controller = Counted(goal + np.array([0.0, 0.007, 0.0]), goal)
        found.append(simulation.run(controller, 0.1, every))
        assert controller.asked == asked
    np.testing.assert_array_equal(found[0].log.wrenches, found[1].log.wrenches)
    np.testing.assert_array_equal(found[0].poses, found[1].poses)
    assert found[0].possible == found[1].possible
    for duration, every, words in ((0.0, 1, "a period or more"), (-1.0, 1, "a period or more"), (1.0, 0, "every=0")):
        with pytest.raises(InputError, match=words):
            simulation.run(Pushed(goal, goal), duration, every)


@pytest.mark.parametrize("name", ["noise", "bias", "delay", "seed"])
def test_a_sensor_s_errors_are_not_negative(name: str) -> None:
    with pytest.raises(InputError, match=f"wrist sensor's {name}"):
        WristSensor(**{name: -1 if name == "seed" else -1.0})


def test_classifiers_that_do_not_fit_the_world(peg: ContactStateGraph, peg_classifier: Classifier) -> None:
    signals = peg_classifier.signals
    for wrong, words in (
        (replace(peg_classifier, name="other"), "another assembly; found 'other'"),
        (replace(peg_classifier, signals=replace(signals, axes="part")), "fixed axes"),
    ):
        with pytest.raises(InputError, match=words):
            Simulation.of(peg.assembly, wrong, Setup(), np.zeros(3))

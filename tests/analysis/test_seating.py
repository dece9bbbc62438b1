"""Seating: hand statics of a 3-2-1, clamps that unseat, and steps that the checker does not accept."""

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.layout import Answer, Stage
from fixture_design.verification.use_proofs import USE_PROOFS
from tests.analysis.forces import WEIGHT, asked, block

THREE = {"K1": 200.0, "K2": 100.0, "K3": 80.0}


def test_three_clamps_seat_a_block():
    finding = asked(block(THREE), "seated")
    assert finding.answer is Answer.YES
    gravity, *_, last = finding.use.steps
    assert [step.clamp for step in finding.use.steps] == [None, "K1", "K2", "K3"]
    assert gravity.idle == ("S4", "S5", "S6")
    expected = {"S3": WEIGHT / 2 + 100, "S1": WEIGHT / 4 + 50, "S2": WEIGHT / 4 + 50, "S4": 50, "S5": 50, "S6": 80}
    for name, force in expected.items():
        assert last.reactions[name] == pytest.approx((force, force))


def test_nothing_presses_the_sides():
    finding = asked(block({"K1": 200.0}), "seated")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason == "nothing presses the part against S4, S5, S6"


def test_a_clamp_beside_the_supports_unseats():
    """K2 and K3 press the sides first; then a clamp above a corner, outside of the supports' triangle."""
    finding = asked(block({"K2": 100.0, "K3": 80.0, "corner": 200.0}), "seated")
    assert finding.answer is Answer.NO
    last = finding.use.steps[-1]
    assert last.clamp == "corner"
    assert last.lifted == ("S1",)
    assert last.cause == "corner moves the part off S1"
    assert asked(block({"K2": 100.0, "K3": 80.0, "corner": 1.0}), "seated").answer is Answer.YES


def test_friction_drags_no_other_cause_along():
    for friction in (0.0, 0.05, 0.15):
        finding = asked(block({"K2": 100.0, "K3": 80.0, "corner": 400.0}, friction=friction), "seated")
        assert finding.answer is Answer.NO
        assert finding.use.steps[-1].lifted == ("S1",)


def test_the_weight_itself_may_tip():
    layout = block()
    part = replace(layout.part, center=np.array([0.19, 0.09, 0.025]))
    finding = asked(replace(layout, part=part), "seated")
    assert finding.answer is Answer.NO
    assert finding.use.steps[0].clamp is None
    assert "S1" in finding.use.steps[0].lifted


def test_friction_leaves_open_what_is_pressed():
    finding = asked(block(THREE, friction=0.3), "seated")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason.startswith("friction leaves open")
    for step in finding.use.steps:
        assert all(least <= most for least, most in step.reactions.values())
    little = asked(block(THREE, friction=0.01), "seated")
    assert little.answer is Answer.YES
    least, most = little.use.steps[-1].reactions["S6"]
    assert 0 < least < 80 < most


def test_a_clamp_needs_a_preload():
    finding = asked(block({"K1": 200.0, "K2": None}), "seated")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason == "clamp K2 has no preload"


@pytest.mark.parametrize("active", ["clamp", "K1"])
def test_no_locators(active):
    layout = block(THREE, stages=(Stage("clamps", (active,)),))
    finding = asked(layout, "seated", "clamps")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason == "there are no locators for the part to sit on"


def test_without_gravity_and_clamps_nothing_presses():
    finding = asked(block(gravity=None), "seated")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason == "nothing presses the part against S1, S2, S3, S4, S5, S6"


def test_supports_come_up_later():
    """A support under the corner would hold what the locators do not, but it is not there yet."""
    layout = block({"corner": 200.0})
    support = Contact.on_facet("H", "support", [0.199, 0.099, 0], [0, 0, -1])
    assert asked(replace(layout, contacts=(*layout.contacts, support)), "seated").answer is Answer.NO


def test_a_preload_of_nothing_changes_nothing():
    finding = asked(block({"K2": 100.0, "K3": 80.0, "K1": 0.0}), "seated")
    assert finding.answer is Answer.YES


def test_the_checker_finds_wrong_steps():
    layout = block(THREE)
    finding = asked(layout, "seated")
    *steps, last = finding.use.steps

    def fault(*changed):
        use = replace(finding.use, steps=(*changed,))
        return USE_PROOFS["seated"](replace(finding, use=use), layout.contacts)

    assert fault(*steps, last) is None
    assert "steps missing" in fault(*steps)
    assert "their order" in fault(*steps[1:], last)
    more = last.reactions | {"S6": (90.0, 90.0)}
    assert "S6 is pressed with 80" in fault(*steps, replace(last, reactions=more))
    fewer = {name: motions for name, motions in last.presses.items() if name != "S6"}
    assert "S6 is pressed" in fault(*steps, replace(last, presses=fewer))
    swapped = last.presses | {"S6": last.presses["S1"]}
    assert "resists" in fault(*steps, replace(last, presses=swapped))
    assert "needs a balance" in fault(*steps, replace(last, proof=None))

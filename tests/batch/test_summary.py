"""Counts, worst cases and confidence intervals."""

import json
import pickle

import pytest
from scipy import stats

from fixture_design.batch.interval import wilson_interval
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.outcome import outcome_of, smallest_margin
from fixture_design.batch.reading import layout_of
from fixture_design.batch.summary import Summary
from fixture_design.cli.batch_summary import sweep_in_words
from tests.batch.layouts import planar


@pytest.mark.parametrize(("successes", "count"), [(0, 1), (1, 1), (0, 50), (50, 50), (7, 9), (970, 1000)])
def test_wilson_agrees_with_scipy(successes: int, count: int) -> None:
    found = stats.binomtest(successes, count).proportion_ci(0.95, "wilson")
    assert wilson_interval(successes, count) == pytest.approx((found.low, found.high), abs=1e-12)


def test_wilson_of_nothing() -> None:
    assert wilson_interval(0, 0) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("record", "outcome"),
    [
        ({"satisfied": "yes"}, "yes"),
        ({"satisfied": None}, "nothing required"),
        ({"satisfied": "undecided"}, "undecided"),
        ({"error": {"kind": "ContentError"}}, "bad input"),
        ({"error": {"kind": "PenetrationError"}}, "bad input"),
        ({"error": {"kind": "ValueError"}}, "internal error"),
        ({"error": {"kind": "WorkerError"}}, "internal error"),
    ],
)
def test_outcomes(record: dict, outcome: str) -> None:
    assert outcome_of(record) == outcome


def test_the_smallest_margin_is_that_of_what_is_required() -> None:
    record = {
        "groups": {"all": {"form_closure": {"margin": 0.1}, "accessible": {"margin": -0.1}, "seated": {}}},
        "requirements": [{"group": "all", "require": "form_closure"}, {"group": "all", "require": "seated"}],
    }
    assert smallest_margin(record) == 0.1


@pytest.mark.parametrize(("leaving", "smallest"), [(0.0, 0.1), (0.05, 0.1), (-0.2, -0.2)])
def test_sliding_out_is_no_small_margin(leaving: float, smallest: float) -> None:
    record = {
        "groups": {"all": {"form_closure": {"margin": 0.1}, "loadable": {"margin": leaving}}},
        "requirements": [{"group": "all", "require": "form_closure"}, {"group": "all", "require": "loadable"}],
    }
    assert smallest_margin(record) == smallest


def test_the_worst_variant_has_the_worst_outcome_then_the_smallest_margin() -> None:
    summary = Summary()
    text = json.dumps(planar(sweep={"friction": [0.1, 0.5], "samples": 5, "seed": 1}))
    item = Item("x", text.encode(), 1, sampled=True)
    for number, (outcome, margin) in enumerate([("yes", 0.1), ("yes", 0.01), ("no", 0.5), ("no", -0.2), ("yes", 0.0)]):
        summary.add(item._replace(variant=number), Entry(b'{"name": "x[%d]"}' % number, outcome, margin))
    (sweep,) = summary.as_dict()["sweeps"]
    assert (sweep["count"], sweep["holds"], sweep["fraction"]) == (5, 3, 0.6)
    friction = layout_of(item._replace(variant=3)).friction
    worst = {"name": "x[3]", "outcome": "no", "margin": -0.2, "off": {"friction": friction}}
    assert sweep["worst"] == worst
    assert sweep["interval"][0] < 0.6 < sweep["interval"][1]
    assert summary.as_dict()["outcomes"]["yes"] == 3


def swept(outcomes: list[tuple[str, float | None]]) -> tuple[dict, str]:
    """One sweep as plain values and in words."""
    summary = Summary()
    item = Item("x", json.dumps(planar(sweep={"at": 0.1, "samples": 5})).encode(), 1, sampled=True)
    for number, (outcome, margin) in enumerate(outcomes):
        summary.add(item._replace(variant=number), Entry(b'{"name": "x[%d]"}' % number, outcome, margin))
    (sweep,) = summary.sweeps.values()
    return sweep.as_dict(), sweep_in_words(sweep)


def test_where_nothing_is_required_nothing_fails() -> None:
    assert "nothing is required of its 2 variants" in swept([("nothing required", None)] * 2)[1]


def test_errors_are_no_variants_that_fail() -> None:
    found, said = swept([("yes", 0.1), ("internal error", None), ("yes", 0.2), ("bad input", None)])
    assert (found["count"], found["errors"], found["fraction"]) == (4, 2, 1.0)
    assert found["worst"]["name"] == "x[0]"
    assert "2 of 2 variants hold" in said
    assert "2 of 4 are errors" in said
    assert swept([("bad input", None)])[0]["fraction"] is None


def test_a_sweep_keeps_no_record_and_no_text() -> None:
    summary = Summary()
    item = Item("x", json.dumps(planar(sweep={"at": 0.1, "samples": 5})).encode() + b" " * 100_000, 1, 0)
    summary.add(item, Entry(b'{"name": "x[0]", "long": "%s"}' % (b"y" * 100_000), "no", 0.1))
    assert len(pickle.dumps(summary)) < 5_000

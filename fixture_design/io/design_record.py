"""A design's result as plain values, for `--json`."""

from __future__ import annotations

from pathlib import Path

from fixture_design.design import Bound, ChangeBound, DesignResult, Step
from fixture_design.io.layout_writing import layout_data
from fixture_design.io.verdict_record import verdict_to_dict

Data = dict[str, object]


def design_to_dict(result: DesignResult, folder: Path) -> Data:
    """The result; file names in its layout are relative to ``folder``."""
    return {
        "schema": "fixture_design/design/1",
        "satisfied": str(result.satisfied),
        "reason": result.reason,
        "layout": None if result.layout is None else layout_data(result.layout, folder),
        "verdict": None if result.verdict is None else verdict_to_dict(result.verdict),
        "steps": [_step(step) for step in result.steps],
        "bound": None if result.bound is None else _bound(result.bound),
        "changes": None if result.changes is None else _changes(result.changes),
        "out": _numbers(result.out),
        "accuracy": result.accuracy,
        "best_accuracy": result.best_accuracy,
        "margin": result.margin,
        "preload": result.preload,
        "best_preload": result.best_preload,
        "best_preload_here": result.best_preload_here,
        "free": _numbers(result.free),
        "notes": list(result.notes),
    }


def _step(step: Step) -> Data:
    data: Data = {"action": step.action, "element": step.element, "why": step.why}
    if step.motion is not None:
        data["motion"] = _numbers(step.motion)
    if step.preload is not None:
        data["preload"] = step.preload
    if step.circuit:
        data["circuit"] = list(step.circuit)
    return data


def _bound(bound: Bound) -> Data:
    return {
        "locators": bound.locators,
        "clamps": bound.clamps,
        "elements": bound.elements,
        "found": bound.found,
        "gap": bound.gap,
        "proven": bound.proven,
        "complete": bound.complete,
        "candidates": bound.candidates,
        "letting_go": bound.letting_go,
    }


def _changes(changes: ChangeBound) -> Data:
    return {
        "found": changes.found, "bound": changes.bound, "proven": changes.proven, "complete": changes.complete,
        "candidates": changes.candidates,
    }  # fmt: skip


def _numbers(values: object) -> list[float] | None:
    return None if values is None else [float(x) for x in values]  # type: ignore[attr-defined]

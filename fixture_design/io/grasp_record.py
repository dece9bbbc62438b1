"""What a search for grasps found as plain values, for `--json`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fixture_design.grasp.result import FacingRegion, Grasp, GraspResult
from fixture_design.grasp.torques import Held
from fixture_design.grasp.weakest import Weakest
from fixture_design.io.layout_writing import layout_data
from fixture_design.io.pose_angles import roll_pitch_yaw
from fixture_design.io.verdict_record import verdict_to_dict

Data = dict[str, object]

GRASP_SCHEMA = "fixture_design/grasp/1"


def grasps_to_dict(result: GraspResult, folder: Path) -> Data:
    """The result; file names in its layouts are relative to ``folder``."""
    return {
        "schema": GRASP_SCHEMA,
        "satisfied": str(result.satisfied),
        "reason": result.reason,
        "grasps": [grasp_to_dict(grasp, folder) for grasp in result.grasps],
        "regions": [_region(region) for region in result.regions],
        "tried": dict(result.tried or {}),
        "notes": list(result.notes),
    }


def grasp_to_dict(grasp: Grasp, folder: Path) -> Data:
    """One grasp: where the hand is, what it touches, what it is worth. Lengths in metres; numbers without a bound are
    null.
    """
    posture = grasp.posture
    return {
        "hand": posture.model.name,
        "closed": str(grasp.closed),
        "positions": posture.positions(),
        "pose": {"xyz": _numbers(posture.X_WH.translation), "rpy": roll_pitch_yaw(posture.X_WH)},
        "features": list(grasp.features),
        "quality": {"least_weight": grasp.quality.least_weight, "epsilon": grasp.quality.epsilon},
        "robust": grasp.robust,
        "tight": grasp.tight,
        "weakest": None if grasp.weakest is None else _weakest(grasp.weakest),
        "held": None if grasp.held is None else _held(grasp.held),
        "links": dict(grasp.links),
        "layout": layout_data(grasp.layout, folder),
        "verdict": verdict_to_dict(grasp.verdict),
        "notes": list(grasp.notes),
    }


def _region(region: FacingRegion) -> Data:
    return {
        "features": list(region.features),
        "pairs": region.pairs,
        "width": list(region.width),
        "outcome": region.outcome,
    }


def _weakest(weakest: Weakest) -> Data:
    return {"force": _bounded(weakest.force), "direction": _numbers(weakest.direction)}


def _held(held: Held) -> Data:
    forces = {name: _numbers(force) for name, force in held.forces.items()}
    moments = {name: _numbers(moment) for name, moment in held.moments.items()}
    return {"factor": _bounded(held.factor), "torques": dict(held.torques), "forces": forces, "moments": moments}


def _bounded(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _numbers(values: np.ndarray) -> list[float]:
    return [float(value) + 0.0 for value in values]

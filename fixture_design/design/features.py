"""Key features as rows: what accuracy is measured by."""

from __future__ import annotations

import numpy as np

from fixture_design.contacts import face_vectors, unit_normal
from fixture_design.design.candidates import Candidates
from fixture_design.design.locating import Features
from fixture_design.design.task import Task


def features_of(task: Task, candidates: Candidates) -> Features | None:
    """The rows of the key features, in their tolerances, and of each candidate its row's length."""
    if not task.key_features:
        return None
    points = np.array([feature.point for feature in task.key_features]) - candidates.scale.reference
    directions = np.array([unit_normal(feature.direction) for feature in task.key_features])
    rows = face_vectors(points, directions)
    p = points.shape[1]
    rows[:, p:] /= candidates.scale.length
    several = candidates.normals.reshape(-1, p)
    levers = face_vectors((candidates.points - candidates.scale.reference).reshape(-1, p), several)
    levers[:, p:] /= candidates.scale.length
    lengths = np.linalg.norm(levers, axis=1)
    tolerances = np.array([feature.tolerance for feature in task.key_features])
    return Features(rows / tolerances[:, None], np.where(lengths > 0, lengths, 1.0))

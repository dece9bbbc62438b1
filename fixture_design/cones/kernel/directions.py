"""Singular values of a few or of thousands of rows, with a whole basis of R^d to go with them."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Rows, Vector


def singular_directions(rows: Rows) -> tuple[Vector, Rows]:
    """All d singular values of rows, shape (m, d), and the d right singular vectors as rows, largest value first.

    With fewer rows than d the last values are zero and their vectors span what the rows do not reach. The left vectors,
    which would be m x m, are not computed.
    """
    missing = rows.shape[1] - len(rows)
    padded = np.vstack([rows, np.zeros((missing, rows.shape[1]))]) if missing > 0 else rows
    _, values, right = np.linalg.svd(padded, full_matrices=False)
    return values, right

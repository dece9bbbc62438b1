"""What both kernels ask of their input, in the same words: finite unit rows (or zero rows), a sensible zero."""

from __future__ import annotations

import numpy as np

from fixture_design.errors import ConeError

#: Rows are unit up to this [-]: the zero tests are relative to them.
UNIT = 1e-6


def require_finite(rows: np.ndarray) -> None:
    """Raises ConeError for rows with NaN or infinite entries."""
    finite = np.isfinite(rows).all(axis=-1)
    if not finite.all():
        bad = int(np.argmin(np.atleast_1d(finite)))
        raise ConeError(f"row {bad} is not finite: {np.atleast_2d(rows)[bad]}")


def require_unit_rows(rows: np.ndarray) -> None:
    """Raises ConeError for rows that are neither unit nor zero."""
    require_finite(rows)
    with np.errstate(over="ignore"):
        squared = np.einsum("ij,ij->i", rows, rows)
    odd = (np.abs(squared - 1.0) > 2 * UNIT) & rows.any(axis=1)
    if odd.any():
        bad = int(np.argmax(odd))
        raise ConeError(f"row {bad} has the length {np.sqrt(squared[bad]):e}, not 1")


def require_tolerance(zero: float) -> None:
    """Raises ConeError for a zero that is none."""
    if not 0.0 < zero < 1.0:
        raise ConeError(f"a zero of relative size {zero}: it must lie between 0 and 1")

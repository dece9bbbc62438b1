"""What a caller gave, as an array of numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from fixture_design.errors import InputError


def numbers_of(values: Any, name: str) -> np.ndarray:
    """The values as float64.

    Raises:
        InputError: words, rows of unequal length, or whatever else makes no array.
    """
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise InputError(f"{name} must be numbers", found=f"{values!r:.60}") from cause

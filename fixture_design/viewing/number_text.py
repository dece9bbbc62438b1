"""Rows of numbers as they stand in tables."""

from __future__ import annotations

import numpy as np


def numbers_text(values: np.ndarray) -> str:
    """ "(1, -0.5, 0)", four digits each."""
    return "(" + ", ".join(f"{value + 0.0:.4g}" for value in np.round(values, 12)) + ")"


def millimetres(point: np.ndarray) -> str:
    """A point given in metres, to 0.1 um: "(12.5, 0, -3.125)"."""
    return "(" + ", ".join(f"{value + 0.0:.4f}".rstrip("0").rstrip(".") for value in np.round(point * 1e3, 4)) + ")"

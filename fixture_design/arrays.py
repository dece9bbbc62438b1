"""Shape aliases: what an array holds, in its type. d is 3 in the plane (x, y, theta) and 6 in space.

The annotations are checked at run time while testing (jaxtyping with beartype) and are only documentation otherwise.
Dimensions (d, p) are one number within a signature; counts are not, since most functions take rows of several kinds:
where two counts must agree, the signature says so with a name of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

#: One vector of the wrench or twist space, or of any other R^d.
Vector = Float[np.ndarray, "d"]
#: Vectors as rows.
Rows = Float[np.ndarray, "_ d"]
#: One weight per row.
Weights = Float[np.ndarray, "_"]
#: A selection of rows.
Mask = Bool[np.ndarray, "_"]
#: Which rows (columns) each ray (row) makes active.
Incidence = Bool[np.ndarray, "_ _"]
#: Indices.
Indices = Int[np.ndarray, "_"]
#: A point, direction or normal: [x, y] in the plane, [x, y, z] in space.
Point = Float[np.ndarray, "p"]
#: Points as rows.
Points = Float[np.ndarray, "_ p"]
#: The two ends of segments [m].
Ends = Float[np.ndarray, "_ 2 p"]

#: What the public functions take where they want numbers: an array, or lists of them.
ArrayLike = np.ndarray | Sequence[Any]

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def read_only(values: ArrayLike) -> np.ndarray:
    """A float64 copy that nobody can write to, so that frozen dataclasses are frozen."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def cross_products(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """a X b along the last axis, of length 3: for a few vectors ten times faster than `np.cross`, the same digits."""
    if first.ndim == second.ndim == 1:
        a, b, c = first.tolist()
        x, y, z = second.tolist()
        return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
    ahead = first[..., _NEXT] * second[..., _LAST]
    return ahead - first[..., _LAST] * second[..., _NEXT]

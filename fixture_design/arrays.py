"""Shape aliases: what an array holds, in its type. d is 3 in the plane (x, y, theta) and 6 in space.

The annotations are checked at run time while testing (jaxtyping with beartype) and are only documentation otherwise.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

#: One vector of the wrench or twist space, or of any other R^d.
Vector = Float[np.ndarray, "d"]
#: Vectors as rows.
Rows = Float[np.ndarray, "m d"]
#: One weight per row.
Weights = Float[np.ndarray, "m"]
#: A selection of rows.
Mask = Bool[np.ndarray, "m"]
#: Which rows (columns) each ray (row) makes active.
Incidence = Bool[np.ndarray, "k m"]
#: Indices.
Indices = Int[np.ndarray, "n"]
#: A point, direction or normal: [x, y] in the plane, [x, y, z] in space.
Point = Float[np.ndarray, "p"]
#: Points as rows.
Points = Float[np.ndarray, "n p"]


def read_only(values: object) -> np.ndarray:
    """A float64 copy that nobody can write to, so that frozen dataclasses are frozen."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array

"""How sure a share of samples is (E. B. Wilson, 1927)."""

from __future__ import annotations

from math import sqrt

#: Standard deviations of a two-sided interval of 95 % [-].
Z_95 = 1.959963984540054


def wilson_interval(successes: int, count: int, z: float = Z_95) -> tuple[float, float]:
    """The confidence interval of a probability of which ``successes`` of ``count`` independent samples are known.

    (p + z^2 / 2n -+ z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n): unlike p -+ z sqrt(p (1 - p) / n) it is not
    empty where all samples agree.

    Returns:
        (0, 1) without samples: nothing is known.

    Example:
        >>> [round(end, 3) for end in wilson_interval(100, 100)]
        [0.963, 1.0]
    """
    if count == 0:
        return 0.0, 1.0
    share, spread = successes / count, z * z / count
    middle = (share + spread / 2) / (1 + spread)
    half = z / (1 + spread) * sqrt(share * (1 - share) / count + spread / (4 * count))
    return max(0.0, middle - half), min(1.0, middle + half)

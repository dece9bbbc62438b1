"""Second-order cones as Jordan algebras, over the last axis of arrays, and the scaling of Nesterov and Todd."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


def dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...w,...w->...", a, b)


def squares(x: np.ndarray) -> np.ndarray:
    """t^2 - |z|^2, without its cancellation."""
    z = np.sqrt(dots(x[..., 1:], x[..., 1:]))
    return (x[..., 0] - z) * (x[..., 0] + z)


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a o b = [a . b; a0 b1 + b0 a1]."""
    result = a[..., :1] * b + b[..., :1] * a
    result[..., 0] = dots(a, b)
    return result


def divided(a: np.ndarray, d: np.ndarray) -> np.ndarray:
    """u with a o u = d."""
    first = (a[..., 0] * d[..., 0] - dots(a[..., 1:], d[..., 1:])) / squares(a)
    result = (d - first[..., None] * a) / a[..., :1]
    result[..., 0] = first
    return result


@dataclass(frozen=True, eq=False)
class Scaling:
    """W = eta [w0, w1; w1, I + w1 w1^T / (1 + w0)] a cone, with W s = W^-1 x."""

    eta: np.ndarray
    w: np.ndarray

    @staticmethod
    def of(x: np.ndarray, s: np.ndarray) -> Scaling:
        size_x, size_s = np.sqrt(squares(x)), np.sqrt(squares(s))
        x, s = x / size_x[..., None], s / size_s[..., None]
        w = x - s
        w[..., 0] = x[..., 0] + s[..., 0]
        w /= np.sqrt(2 * (1 + dots(x, s)))[..., None]
        w[..., 0] = np.sqrt(1 + dots(w[..., 1:], w[..., 1:]))
        return Scaling(np.sqrt(size_x / size_s), w)

    def times(self, v: np.ndarray) -> np.ndarray:
        along = dots(self.w[..., 1:], v[..., 1:])
        result = v + self.w * (v[..., 0] + along / (1 + self.w[..., 0]))[..., None]
        result[..., 0] = self.w[..., 0] * v[..., 0] + along
        return self.eta[..., None] * result

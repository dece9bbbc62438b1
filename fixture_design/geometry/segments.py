"""Edges against triangles and edges against edges: where they cross and how far apart they are, many at a time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Weights, cross_products
from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.shapes import Corners, PerPoint

#: The two ends of each segment.
Segments = Float[np.ndarray, "e 2 3"]

#: A crossing this far outside a triangle or segment still counts, relative to its size [-]: rather twice than never.
_BEYOND = 1e-9

#: Sine of an angle below which a segment runs in the plane of a triangle, and two segments are parallel [-].
_PARALLEL = 1e-12


def crossings(segments: Segments, corners: Corners) -> tuple[Indices, Indices, Weights]:
    """Where segments cross triangles: for each crossing the segment, the triangle, and how far along it, 0 to 1.

    A segment in the plane of a triangle does not cross it. A crossing on the edge between two triangles counts twice.
    Source: Moller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997.
    """
    number, triangle = box_pairs(boxes_of(segments), boxes_of(corners), 0.0)
    start, along = segments[number, 0], segments[number, 1] - segments[number, 0]
    first, second = corners[triangle, 1] - corners[triangle, 0], corners[triangle, 2] - corners[triangle, 0]
    cross = cross_products(along, second)
    volume = np.einsum("ij,ij->i", first, cross)
    size = np.linalg.norm(along, axis=1) * np.linalg.norm(cross_products(first, second), axis=1)
    through = np.abs(volume) > _PARALLEL * size
    divisor = np.where(through, volume, 1.0)
    away = start - corners[triangle, 0]
    turned = cross_products(away, first)
    u = np.einsum("ij,ij->i", away, cross) / divisor
    v = np.einsum("ij,ij->i", along, turned) / divisor
    at = np.einsum("ij,ij->i", second, turned) / divisor
    hit = through & (u >= -_BEYOND) & (v >= -_BEYOND) & (u + v <= 1 + _BEYOND)
    hit &= (at >= -_BEYOND) & (at <= 1 + _BEYOND)
    return number[hit], triangle[hit], np.clip(at[hit], 0.0, 1.0)


def stretches(number: Indices, at: Weights) -> tuple[Indices, Weights]:
    """The middles of the stretches into which crossings cut their segments: segment's index and how far along it."""
    cut = np.unique(number)
    number = np.concatenate([number, cut, cut])
    at = np.concatenate([at, np.zeros(len(cut)), np.ones(len(cut))])
    order = np.lexsort((at, number))
    number, at = number[order], at[order]
    lasting = (number[1:] == number[:-1]) & (at[1:] - at[:-1] > _BEYOND)
    return number[1:][lasting], ((at[1:] + at[:-1]) / 2)[lasting]


def segment_distances(first: Segments, second: Segments) -> tuple[PerPoint, Float[np.ndarray, "e 3"]]:
    """The distance between each segment and its partner [m], and the nearest point of the first one.

    Source: Ericson, Real-time collision detection, 2004, section 5.1.9.
    """
    along, other = first[:, 1] - first[:, 0], second[:, 1] - second[:, 0]
    away = first[:, 0] - second[:, 0]
    a, e = np.einsum("ij,ij->i", along, along), np.einsum("ij,ij->i", other, other)
    b, c, f = (np.einsum("ij,ij->i", *pair) for pair in ((along, other), (along, away), (other, away)))
    sine = a * e - b * b
    skew = sine > _PARALLEL * a * e
    s = np.where(skew, np.clip((b * f - c * e) / np.where(skew, sine, 1.0), 0.0, 1.0), 0.0)
    t = (b * s + f) / e
    s = np.where(t < 0, np.clip(-c / a, 0.0, 1.0), np.where(t > 1, np.clip((b - c) / a, 0.0, 1.0), s))
    t = np.clip(t, 0.0, 1.0)
    nearest = first[:, 0] + s[:, None] * along
    return np.linalg.norm(nearest - second[:, 0] - t[:, None] * other, axis=1), nearest

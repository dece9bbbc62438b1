"""Histograms of margins, as SVG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.tolerances import DEFAULT
from fixture_design.viewing.markup import Markup, tag

#: Bars of a histogram, and its size [px].
_BARS, _WIDTH, _HEIGHT = 40, 480, 120
#: Margins that differ by less than this part of them are one bar: there are no numbers between for others [-].
_ONE = 1e-9
#: Room for the numbers below [px].
_FOOT = 18


def histogram(margins: Sequence[float], title: str) -> Markup:
    """How often which margin occurs; bars of margins up to zero are in the colour of a no."""
    values = np.asarray(margins, dtype=np.float64)
    low, high = float(values.min()), float(values.max())
    if high - low <= _ONE * max(abs(low), abs(high), DEFAULT.tie):
        low, high = low - 0.5 * abs(low or 1.0), high + 0.5 * abs(high or 1.0)
    counts, edges = np.histogram(values, _BARS, (low, high))
    step = _WIDTH / _BARS
    bars = []
    for index, count in enumerate(counts.tolist()):
        height = _HEIGHT * count / int(counts.max())
        said = f"{edges[index]:.3g} to {edges[index + 1]:.3g}: {count}"
        bars.append(
            tag("rect", tag("title", said), x=round(index * step, 2), y=round(_HEIGHT - height, 2),
                width=round(step - 1, 2), height=round(height, 2), class_="good" if edges[index] >= 0 else "bad")
        )  # fmt: skip
    labels = [
        tag("text", f"{value:.3g}", x=x, y=_HEIGHT + _FOOT - 4, text_anchor=anchor)
        for value, x, anchor in ((low, 0, "start"), ((low + high) / 2, _WIDTH / 2, "middle"), (high, _WIDTH, "end"))
    ]
    drawing = tag("svg", *bars, *labels, width=_WIDTH, height=_HEIGHT + _FOOT, role="img", aria_label=title)
    return tag("figure", tag("figcaption", title), drawing)

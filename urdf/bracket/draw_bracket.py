"""Draws bracket.svg, the README's picture: the bracket in its fixture, as seen from above, with the verdict.

Run it from any folder: ``python urdf/bracket/draw_bracket.py``. It uses the toolkit itself: what it draws is what was
verified. Contacts on hidden faces are drawn through the part, dashed.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import fixture_design as fd
from fixture_design.geometry import load_part

HERE = Path(__file__).resolve().parent
WIDTH, HEIGHT, SCALE = 760, 500, 6800.0
#: Where the viewer stands, and the light.
VIEW, LIGHT = np.array([1.0, -1.6, 1.15]), np.array([0.35, -0.5, 0.85])
COLOURS = {"locator": "#0072b2", "clamp": "#d55e00"}
ARROW = 0.011


def main() -> None:
    """Verify the layout and write the picture."""
    layout = fd.read_layout(HERE / "bracket.layout.yaml")
    verdict = fd.verify(layout)
    part = load_part(layout.part)
    view = VIEW / np.linalg.norm(VIEW)
    right = np.cross([0, 0, 1], view)
    right /= np.linalg.norm(right)
    up = np.cross(view, right)
    centre = part.box_center

    def flat(points: np.ndarray) -> np.ndarray:
        moved = np.atleast_2d(points) - centre
        return np.column_stack([WIDTH * 0.44 + SCALE * moved @ right, HEIGHT * 0.46 - SCALE * moved @ up])

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}"',
        'font-family="sans-serif" font-size="14">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        *_surface(part, view, flat),
    ]
    for contact in verdict.contacts:
        normal = contact.normals[0] / np.linalg.norm(contact.normals[0])
        lines += _arrow(contact, normal, hidden=bool(normal @ view < 0), flat=flat)
    lines += _legend(verdict)
    (HERE / "bracket.svg").write_text("\n".join([*lines, "</svg>\n"]), encoding="utf-8")


def _surface(part, view, flat):
    """Front triangles from far to near, each with its sharp edges, so that nearer ones cover what they hide."""
    corners = part.vertices[part.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = LIGHT / np.linalg.norm(LIGHT)
    sharp = _sharp_edges(part.triangles, normals)
    order = np.argsort(corners.mean(axis=1) @ view)
    for index in order[(normals @ view)[order] > 0]:
        shade = int(150 + 85 * max(0.0, float(normals[index] @ light)))
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in flat(corners[index]))
        colour = f"rgb({shade - 12},{shade - 6},{shade})"
        yield f'<polygon points="{points}" fill="{colour}" stroke="{colour}" stroke-width="0.7"/>'
        for edge in sharp[index]:
            (x1, y1), (x2, y2) = flat(part.vertices[sorted(edge)])
            yield f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="#333" stroke-width="1.1"/>'


def _sharp_edges(triangles, normals):
    """For each triangle its edges at which the surface turns by more than the strips of the hole do."""
    owners = {}
    for index, triangle in enumerate(triangles):
        for first, second in zip(triangle, np.roll(triangle, -1), strict=True):
            owners.setdefault(frozenset((int(first), int(second))), []).append(index)
    sharp = [[] for _ in triangles]
    for edge, (one, other) in owners.items():
        if normals[one] @ normals[other] < 0.9:
            sharp[one].append(edge)
            sharp[other].append(edge)
    return sharp


def _arrow(contact, normal, *, hidden, flat):
    (x1, y1), (x2, y2) = flat(np.array([contact.point + ARROW * normal, contact.point]))
    colour, dash = COLOURS[contact.role], ' stroke-dasharray="5 4" opacity="0.75"' if hidden else ""
    along = np.array([x2 - x1, y2 - y1])
    along /= np.linalg.norm(along)
    side = np.array([-along[1], along[0]])
    tip = np.array([x2, y2])
    head = [tip, tip - 10 * along + 4.5 * side, tip - 10 * along - 4.5 * side]
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in head)
    yield f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="3"{dash}/>'
    yield f'<polygon points="{points}" fill="{colour}"{dash}/>'
    lx, ly = np.array([x1, y1]) - 12 * along
    yield (
        f'<text x="{lx:.1f}" y="{ly + 5:.1f}" text-anchor="middle" fill="{colour}" font-weight="bold" '
        f'stroke="#fff" stroke-width="3" paint-order="stroke">{contact.name}</text>'
    )


def _legend(verdict):
    rows = [(f"{r.group}: {r.require.replace('_', ' ')}", str(r.answer)) for r in verdict.requirements]
    x, y = WIDTH - 250, 36
    yield f'<text x="{x}" y="{y}" font-weight="bold">{verdict.name}</text>'
    for index, (text, answer) in enumerate(rows, start=1):
        bold = f'<tspan font-weight="bold">{answer}</tspan>'
        yield f'<text x="{x}" y="{y + 22 * index}" fill="#333">{text}: {bold}</text>'
    y += 22 * (len(rows) + 1) + 6
    for index, (role, colour) in enumerate(COLOURS.items()):
        yield f'<rect x="{x}" y="{y + 22 * index - 11}" width="14" height="14" fill="{colour}"/>'
        yield f'<text x="{x + 22}" y="{y + 22 * index + 1}" fill="#333">{role}s push along their arrows</text>'


if __name__ == "__main__":
    main()

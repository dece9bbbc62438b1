"""What people look at: the scene in three dimensions, evidence in words, the sheet to sign, the contact state graph.

Nothing here decides anything; it shows what a verdict holds. A layout and its verdict make a *scene*, one plain
description; `preview_page` is an HTML file of it, `picture` a PNG (`urdf/bracket/held.png` and `free.png` are two),
`session` a live one in Drake's Meshcat. All of it is loaded when it is first asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fixture_design.packages import loaded_later

if TYPE_CHECKING:
    from fixture_design.viewing.graph_drawing import graph_picture, write_graph_picture
    from fixture_design.viewing.previews import Preview, preview
    from fixture_design.viewing.report import write_report
    from fixture_design.viewing.scene import Scene, scene_of
    from fixture_design.viewing.scene_page import preview_page
    from fixture_design.viewing.scene_picture import picture
    from fixture_design.viewing.session import interactive
    from fixture_design.viewing.words import evidence_in_words

_HOME = {
    "Preview": "previews",
    "Scene": "scene",
    "evidence_in_words": "words",
    "graph_picture": "graph_drawing",
    "interactive": "session",
    "picture": "scene_picture",
    "preview": "previews",
    "preview_page": "scene_page",
    "scene_of": "scene",
    "write_graph_picture": "graph_drawing",
    "write_report": "report",
}

__all__ = [
    "Preview",
    "Scene",
    "evidence_in_words",
    "graph_picture",
    "interactive",
    "picture",
    "preview",
    "preview_page",
    "scene_of",
    "write_graph_picture",
    "write_report",
]

__getattr__ = loaded_later(__name__, _HOME)

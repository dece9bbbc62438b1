"""A contact-state graph as one page that loads nothing: its picture, with the contacts of each state on hovering."""

from __future__ import annotations

from fixture_design.assembly import ContactStateGraph
from fixture_design.viewing.graph_drawing import COINCIDENT, MARKED, graph_picture
from fixture_design.viewing.markup import Markup, table, tag

_POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
_STYLE = """
body { font: 14px/1.4 system-ui, sans-serif; margin: 1.5rem; color: #1c1f23; } h1 { font-size: 20px; margin: 0; }
.graph svg { max-width: 100%; height: auto; }
.graph { border: 1px solid #d5d8dc; margin: 1rem 0; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: .15rem .8rem .15rem 0; border-bottom: 1px solid #e4e4e4; }
"""


def graph_page(graph: ContactStateGraph) -> str:
    """The graph's picture and its states, one HTML file."""
    head = tag(
        "head", Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'),
        tag("title", f"{graph.assembly.name}: contact states"), tag("style", Markup(_STYLE)),
    )  # fmt: skip
    complete = "" if graph.complete else "; the search was interrupted, there may be more"
    said = f"{len(graph.states)} contact states, {len(graph.transitions)} direct transitions{complete}."
    marked = any(state.coincident for state in graph.states)
    frame = tag("p", tag("b", "Orange frame", style=f"color: {MARKED}"), f": {COINCIDENT}.") if marked else ""
    rows = [[state.id, "; ".join(state.contacts) or "no contact"] for state in graph.states]
    body = tag(
        "body", tag("h1", graph.assembly.name), tag("p", said), frame, tag("div", graph_picture(graph), class_="graph"),
        table(["state", "contacts"], rows),
    )  # fmt: skip
    return "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n"

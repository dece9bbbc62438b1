"""What people look at: evidence in words, the sheet to sign, the contact state graph.

Nothing here decides anything; it shows what a verdict holds.
"""

from fixture_design.viewing.card import CARD_STYLE, card
from fixture_design.viewing.graph_picture import graph_picture, write_graph_picture
from fixture_design.viewing.report import refuse_inputs, write_report
from fixture_design.viewing.words import evidence_in_words

__all__ = [
    "CARD_STYLE",
    "card",
    "evidence_in_words",
    "graph_picture",
    "refuse_inputs",
    "write_graph_picture",
    "write_report",
]

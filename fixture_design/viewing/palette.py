"""The colours of everything that is drawn, by eyes of any kind: Okabe and Ito's palette, told apart by shape as well.

Source: M. Okabe and K. Ito, "Color Universal Design", 2008.
"""

from __future__ import annotations

from fixture_design.contacts import Role
from fixture_design.layout import Answer

ORANGE, SKY_BLUE, GREEN, YELLOW = "#e69f00", "#56b4e9", "#009e73", "#f0e442"
BLUE, VERMILLION, PURPLE, BLACK = "#0072b2", "#d55e00", "#cc79a7", "#000000"

ROLE_COLORS: dict[Role, str] = {"locator": BLUE, "support": SKY_BLUE, "clamp": VERMILLION, "finger": GREEN}
#: The same, dark enough for words on white.
ROLE_INKS: dict[Role, str] = {"locator": "#005a8e", "support": "#1f6f9f", "clamp": "#a84600", "finger": "#00674c"}
#: The part, its edges, the ground that pictures stand on.
PART, EDGES, GROUND = "#b4bac2", "#3b424a", "#ffffff"
#: What contacts do to the part, what else acts on it, where it can go, points that matter.
PUSH, LOAD, MOTION, FEATURE = PURPLE, BLACK, ORANGE, YELLOW

ANSWER_COLORS: dict[Answer | None, str] = {
    Answer.YES: GREEN, Answer.NO: VERMILLION, Answer.UNDECIDED: "#8a6d00", None: "#777777",
}  # fmt: skip
#: The same, for eyes that see no colours at all.
ANSWER_SIGNS: dict[Answer | None, str] = {Answer.YES: "✓", Answer.NO: "✗", Answer.UNDECIDED: "?", None: "-"}


def answer_sign(answer: Answer | None, required: bool) -> str:
    """The sign of an answer that somebody asked for; a middle dot for others, which are neither good nor bad."""
    return ANSWER_SIGNS[answer] if required else "·"


def answer_color(answer: Answer | None, required: bool) -> str:
    """Its colour, grey for what nobody asked for."""
    return ANSWER_COLORS[answer if required else None]


def rgb(color: str) -> tuple[float, float, float]:
    """ "#e69f00" as red, green and blue from 0 to 1."""
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return red, green, blue

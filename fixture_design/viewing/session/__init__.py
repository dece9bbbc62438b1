"""The interactive session: a layout changed in a browser or by a script, with its verdict at every moment.

`session` is what was done so far, as a value; `steering` does what is asked for by name and judges it; `live` is the
loop that asks Drake's Meshcat (`panel`), and draws. `interactive` starts it beside a script or a notebook.
"""

from fixture_design.viewing.session.interactive import Interactive, begun, interactive
from fixture_design.viewing.session.live import Live
from fixture_design.viewing.session.session import Session
from fixture_design.viewing.session.steering import Steering

__all__ = ["Interactive", "Live", "Session", "Steering", "begun", "interactive"]

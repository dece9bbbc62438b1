"""Grasps: the same theory with a hand. A grasp is a fixture with fingers.

`hand` has the nouns, `hand_model` a hand that can be moved, `touching` the layout that it makes of a part; `quality`
and `torques` say how good that is; `search` finds grasps. All of it is loaded when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from fixture_design.packages import called_as, loaded_later

if TYPE_CHECKING:
    from fixture_design.grasp.hand import Fingertip, Hand, HandError, JointRule
    from fixture_design.grasp.hand_loading import load_hand
    from fixture_design.grasp.hand_model import HandModel
    from fixture_design.grasp.hybrid import hybrid_sets
    from fixture_design.grasp.placed import grasp_at, posed
    from fixture_design.grasp.posture import Posture
    from fixture_design.grasp.quality import Quality
    from fixture_design.grasp.result import Grasp, GraspResult
    from fixture_design.grasp.robustness import PoseError
    from fixture_design.grasp.search import Search, grasp
    from fixture_design.grasp.touching import Touching

_HOME = {
    "Fingertip": "hand",
    "Grasp": "result",
    "GraspResult": "result",
    "Hand": "hand",
    "HandError": "hand",
    "HandModel": "hand_model",
    "JointRule": "hand",
    "PoseError": "robustness",
    "Posture": "posture",
    "Quality": "quality",
    "Search": "search",
    "Touching": "touching",
    "grasp": "search",
    "grasp_at": "placed",
    "hybrid_sets": "hybrid",
    "load_hand": "hand_loading",
    "posed": "placed",
}

__all__ = [
    "Fingertip",
    "Grasp",
    "GraspResult",
    "Hand",
    "HandError",
    "HandModel",
    "JointRule",
    "PoseError",
    "Posture",
    "Quality",
    "Search",
    "Touching",
    "grasp",
    "grasp_at",
    "hybrid_sets",
    "load_hand",
    "posed",
]

__getattr__ = loaded_later(__name__, _HOME)

# as `fd.grasp` it is this package once anything has imported it
called_as(__name__, lambda *given, **named: import_module(f"{__name__}.search").grasp(*given, **named))

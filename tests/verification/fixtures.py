"""Sound fixtures on a plate of random size, and what spoils them: one function a flaw, with what must be said of it."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.io import layout_from_data
from fixture_design.layout import Layout, Verdict
from tests.geometry.parts import prism, write

Data = dict[str, Any]


@dataclass(frozen=True)
class Plate:
    """A plate from the origin to ``size`` [m] with two round holes on its middle line."""

    folder: Path
    size: tuple[float, float, float]
    hole: float

    @property
    def holes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        x, y, _ = self.size
        return (0.3 * x, 0.5 * y), (0.7 * x, 0.5 * y)

    def file(self) -> Path:
        x, y, z = self.size
        outline = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]]
        turn = np.linspace(0, 2 * np.pi, 33)[:-1]
        circles = [
            [[u + self.hole / 2 * float(np.cos(a)), v + self.hole / 2 * float(np.sin(a))] for a in turn]
            for u, v in self.holes
        ]
        return write(self.folder, prism(outline, z, circles), "plate.obj")


def random_plate(folder: Path, rng: np.random.Generator) -> Plate:
    x, y, z = (float(rng.uniform(low, high)) for low, high in ((0.1, 0.2), (0.07, 0.1), (0.02, 0.04)))
    return Plate(folder, (x, y, z), 0.012)


def sound(plate: Plate, rng: np.random.Generator) -> Data:
    """Three rests below, two locators in front, one at the left; a clamp against each datum; a cutter on top."""
    x, y, z = plate.size
    mid = z / 2
    by = float(rng.uniform(0.1, 0.15))
    rests = [(by * x, by * y, 0.0), ((1 - by) * x, by * y, 0.0), (0.5 * x, (1 - by) * y, 0.0)]
    sides = [(by * x, 0.0, mid), ((1 - by) * x, 0.0, mid), (0.0, 0.5 * y, mid)]
    locators = [
        {"name": f"L{k}", "role": "locator", "at": list(at), "tip": {"sphere": 0.004}, "tolerance": 1e-5}
        for k, at in enumerate([*rests, *sides], start=1)
    ]
    clamps = [
        {"name": "K2", "role": "clamp", "at": [0.5 * x, y, mid], "preload": 500.0},
        {"name": "K3", "role": "clamp", "at": [x, 0.5 * y, mid], "preload": 400.0},
        {"name": "K1", "role": "clamp", "at": [0.5 * x, 0.35 * y, z], "preload": 900.0},
    ]
    side = float(rng.uniform(60, 100))
    return {
        "schema": "fixture_design/layout/1",
        "part": {"mesh": "plate.obj", "mass": float(rng.uniform(0.5, 2.0)), "center": [x / 2, y / 2, mid]},
        "gravity": [0, 0, -9.81],
        "friction": 0.15,
        "elements": locators + clamps,
        "key_features": [
            {"name": "bore", "point": [*plate.holes[0], z], "direction": [0, 0, 1], "tolerance": 5e-5},
            {"name": "edge", "point": [x, y, z], "direction": [1, 0, 0], "tolerance": 1e-4},
        ],
        "loads": [{"name": "cutting", "point": [0.6 * x, 0.5 * y, z], "force": [side, -side, -50.0]}],
        "stages": [
            {
                "name": "placed",
                "active": ["locator"],
                "gravity": True,
                "require": ["deterministic", "strongly_accessible", "loadable", "accurate"],
            },
            {
                "name": "clamped",
                "active": ["locator", "clamp"],
                "gravity": True,
                "loads": ["cutting"],
                "require": ["seated", "holds_loads", "force_closure"],
            },
        ],
    }


def layout_of(data: Data, plate: Plate) -> Layout:
    plate.file()
    return layout_from_data(data, plate.folder / "fixture.yaml")


def element(data: Data, name: str) -> Data:
    return next(e for e in data["elements"] if e["name"] == name)


@dataclass(frozen=True)
class Flaw:
    """What spoils a sound fixture: the requirement that must not hold, and words that the reason must have."""

    stage: str
    requirement: str
    words: tuple[str, ...]
    spoil: Callable[[Data, Plate], None]
    answers: tuple[str, ...] = ("no",)


def _jam(data: Data, plate: Plate) -> None:
    """A locator opposite to another, and one opposite to the third: the part is in a slot both ways."""
    x, y, z = plate.size
    data["elements"].append({"name": "J1", "role": "locator", "at": [0.5 * x, y, z / 2]})
    data["elements"].append({"name": "J2", "role": "locator", "at": [x, 0.5 * y, z / 2]})
    data["elements"].append({"name": "J3", "role": "locator", "at": [0.5 * x, 0.3 * y, z]})


def _rocks(data: Data, plate: Plate) -> None:
    """Four rests, one of them off by more than the bore allows."""
    x, y, _ = plate.size
    element(data, "L3")["at"] = [0.1 * x, 0.9 * y, 0]
    data["elements"].insert(3, {"name": "R4", "role": "locator", "at": [0.9 * x, 0.9 * y, 0], "tolerance": 2e-4})
    data["key_features"] = [{"name": "bore", "point": [x, y, 0], "direction": [0, 0, 1], "tolerance": 5e-5}]


def _unseats(data: Data, plate: Plate) -> None:
    """The clamp from above pushes outside the rests' triangle."""
    x, y, z = plate.size
    element(data, "L3")["at"] = [0.5 * x, 0.5 * y, 0]
    element(data, "K1")["at"] = [0.5 * x, 0.95 * y, z]


def _side_clamp_lifts(data: Data, plate: Plate) -> None:
    """A side clamp far above the side locators, which tips the part up."""
    x, y, z = plate.size
    for name in ("L4", "L5"):
        element(data, name)["at"][2] = 0.1 * z
    element(data, "K2")["at"] = [0.5 * x, y, 0.95 * z]
    element(data, "K2")["preload"] = 5000.0
    element(data, "K1")["preload"] = 10.0


def _reversed(data: Data, plate: Plate) -> None:
    """The load the other way is more than friction and preloads hold."""
    load = deepcopy(data["loads"][0])
    load["name"] = "reversed"
    load["force"] = [-2000.0, 3000.0, 100.0]
    data["loads"].append(load)
    data["stages"][1]["loads"].append("reversed")


def _weak_clamp(data: Data, plate: Plate) -> None:
    """The cutter pulls up more than the clamp from above pushes."""
    element(data, "K1")["preload"] = 20.0
    data["loads"][0]["force"] = [0.0, 0.0, 400.0]


def _drill_tips(data: Data, plate: Plate) -> None:
    """A drill beside the rests' triangle, with a weak clamp."""
    x, y, z = plate.size
    element(data, "L3")["at"] = [0.5 * x, 0.6 * y, 0]
    element(data, "K1")["at"] = [0.5 * x, 0.3 * y, z]
    element(data, "K1")["preload"] = 50.0
    element(data, "K2")["preload"] = 50.0
    element(data, "K3")["preload"] = 50.0
    data["loads"][0] = {"name": "cutting", "point": [0.5 * x, 0.95 * y, z], "force": [0, 0, -3000.0]}


def _moment_turns(data: Data, plate: Plate) -> None:
    """A cutter's moment turns the part away from its side locators."""
    data["loads"][0]["moment"] = [0.0, 0.0, -400.0]


def _pin_too_many(data: Data, plate: Plate) -> None:
    """Two round pins in two holes instead of a round one and a diamond one: located twice along their line."""
    z = plate.size[2]
    data["elements"] = [e for e in data["elements"] if e["name"] not in ("L4", "L5", "L6")]
    for k, hole in enumerate(plate.holes, start=1):
        pin = {"diameter": plate.hole, "clearance": 0.0, "shape": "round"}
        tip = {"pin": pin}
        data["elements"].append(
            {"name": f"P{k}", "role": "locator", "at": [*hole, z / 2], "tip": tip, "axis": [0, 0, 1], "tolerance": 1e-4}
        )
    data["key_features"] = [
        {"name": "bore", "point": [*plate.holes[0], 0], "direction": [1, 0, 0], "tolerance": 2e-5},
    ]


def _loose(data: Data, plate: Plate) -> None:
    """Side locators so close together that the far edge is off by ten times their tolerance."""
    x, _, _ = plate.size
    element(data, "L5")["at"][0] = element(data, "L4")["at"][0] + 0.05 * x
    data["key_features"] = [
        {"name": "edge", "point": [x, 0, 0], "direction": [0, 1, 0], "tolerance": 5e-5},
    ]


def _rough_rest(data: Data, plate: Plate) -> None:
    """A rest that is known to a millimetre, under the bore."""
    x = plate.size[0]
    element(data, "L2")["tolerance"] = 1e-3
    data["key_features"] = [{"name": "bore", "point": [x, 0, 0], "direction": [0, 0, 1], "tolerance": 5e-5}]


def _missing(data: Data, plate: Plate) -> None:
    """Five locators."""
    data["elements"] = [e for e in data["elements"] if e["name"] != "L6"]


def _clamp_in_the_way(data: Data, plate: Plate) -> None:
    """Locators at the right and behind as well: the part goes straight up only, where the clamp K1 is."""
    x, y, z = plate.size
    data["elements"].insert(6, {"name": "W1", "role": "locator", "at": [x, 0.3 * y, z / 2], "tolerance": 1e-5})
    data["elements"].insert(7, {"name": "W2", "role": "locator", "at": [0.3 * x, y, z / 2], "tolerance": 1e-5})


def _in_line(data: Data, plate: Plate) -> None:
    """Three rests in one line: the part turns about it."""
    x = plate.size[0]
    element(data, "L3")["at"] = [0.5 * x, element(data, "L1")["at"][1], 0]


def _overhang(data: Data, plate: Plate) -> None:
    """A locator on top of the part: it goes neither up nor out at the front."""
    x, y, z = plate.size
    data["elements"].insert(6, {"name": "O1", "role": "locator", "at": [0.5 * x, 0.2 * y, z], "tolerance": 1e-5})
    data["elements"].insert(7, {"name": "O2", "role": "locator", "at": [x, 0.4 * y, z / 2], "tolerance": 1e-5})
    data["elements"].insert(8, {"name": "O3", "role": "locator", "at": [0.4 * x, y, z / 2], "tolerance": 1e-5})


def _no_friction(data: Data, plate: Plate) -> None:
    """Two clamps of three, without friction: nothing holds the part down."""
    data["elements"] = [e for e in data["elements"] if e["name"] != "K1"]
    data["friction"] = 0.0


def _loose_pins(data: Data, plate: Plate) -> None:
    """A round and a diamond pin with too much clearance for the bore."""
    _pin_too_many(data, plate)
    for name in ("P1", "P2"):
        pin = element(data, name)
        pin["tip"]["pin"] |= {"diameter": plate.hole - 2e-4, "clearance": 2e-4}
        pin["tolerance"] = 1e-6
    element(data, "P2")["tip"]["pin"] |= {"shape": "diamond", "along": [0, 1, 0]}


def _bad_row(data: Data, plate: Plate) -> None:
    """A cutter's path with one point where it pulls too hard."""
    x, y, z = plate.size
    rows = ["x,y,z,fx,fy,fz"] + [f"{0.1 * k * x},{y / 2},{z},50,-50,{900 if k == 3 else -50}" for k in range(1, 9)]
    (plate.folder / "path.csv").write_text("\n".join(rows) + "\n")
    element(data, "K1")["preload"] = 300.0
    data["loads"] = [{"name": "cutting", "path": "path.csv"}]


def _idle(data: Data, plate: Plate) -> None:
    """Nothing presses the part to the left."""
    data["elements"] = [e for e in data["elements"] if e["name"] != "K3"]
    data["friction"] = 0.0


def _oily(data: Data, plate: Plate) -> None:
    """Away from the locators only friction holds, and there is little."""
    data["friction"] = 0.02
    data["loads"][0]["force"] = [600.0, 0.0, 0.0]


FLAWS: dict[str, Flaw] = {
    "jam": Flaw("placed", "strongly_accessible", ("both ways",), _jam),
    "jam, no straight way": Flaw("placed", "loadable", ("no straight way",), _jam),
    "overhang": Flaw("placed", "loadable", ("no straight way",), _overhang),
    "clamp in the way": Flaw("placed", "loadable", ("K1 must be out of the way",), _clamp_in_the_way, ("yes",)),
    "rocks": Flaw("placed", "accurate", ("over-located", "R4"), _rocks, ("no", "undecided")),
    "pin too many": Flaw("placed", "accurate", ("over-located", "P1", "P2"), _pin_too_many, ("no", "undecided")),
    "close together": Flaw("placed", "accurate", ("edge",), _loose),
    "rough rest": Flaw("placed", "accurate", ("L2",), _rough_rest),
    "loose pins": Flaw("placed", "accurate", ("bore", "P1"), _loose_pins),
    "five locators": Flaw("placed", "deterministic", ("rank 5",), _missing),
    "rests in line": Flaw("placed", "deterministic", ("rank 5",), _in_line),
    "clamp beside the rests": Flaw("clamped", "seated", ("K1",), _unseats),
    "side clamp tips": Flaw("clamped", "seated", ("K2",), _side_clamp_lifts),
    "reversed load": Flaw("clamped", "holds_loads", ("reversed",), _reversed),
    "weak clamp": Flaw("clamped", "holds_loads", ("cutting",), _weak_clamp),
    "drill tips": Flaw("clamped", "holds_loads", ("cutting",), _drill_tips),
    "moment turns": Flaw("clamped", "holds_loads", ("cutting",), _moment_turns),
    "one row of a path": Flaw("clamped", "holds_loads", ("cutting, row 3",), _bad_row),
    "oil": Flaw("clamped", "holds_loads", ("cutting",), _oily),
    "nothing presses": Flaw("clamped", "seated", ("L6",), _idle, ("no", "undecided")),
    "nothing holds it down": Flaw("clamped", "force_closure", ("can move",), _no_friction),
}


def answer_to(verdict: Verdict, flaw: Flaw) -> str | None:
    finding = verdict.groups[flaw.stage].findings[flaw.requirement]
    return None if finding.answer is None else str(finding.answer)

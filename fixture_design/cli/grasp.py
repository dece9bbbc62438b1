"""`fixture-design grasp HAND PART`: how a hand may hold a part, or what it does where it is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from fixture_design.cli.exit_codes import of_answer
from fixture_design.cli.grasp_layouts import carried, written
from fixture_design.cli.grasp_report import grasps_in_words
from fixture_design.cli.long_work import interruptible
from fixture_design.cli.messages import say
from fixture_design.cli.progress import shown
from fixture_design.errors import FileFormatError, InputError
from fixture_design.io import TASK_ENDINGS, dumps, read_layout, task_of_part, write_layout
from fixture_design.io.outputs import check_outputs
from fixture_design.layout import Layout, Part, Pose

if TYPE_CHECKING:
    from fixture_design.grasp import GraspResult, Hand

#: Endings of what --html writes.
_PAGES = (".html", ".htm", ".png")

_HAND = "Hand file, or a URDF or SDF file (with NAME.hand.yaml beside it, or its fingertips are guessed)."
_PART = "Part (STL, OBJ, ..., URDF), or a layout whose part it is, where it stands."
_OUT = "Layout file of the best grasp to write; one that is refused is named so."
_LOAD = "Force (N), and moment about the centre of mass (N m), on the part: fx,fy,fz or fx,fy,fz,mx,my,mz."


def grasp(
    hand: Annotated[Path, typer.Argument(help=_HAND, metavar="HAND", readable=False)],
    part: Annotated[Path, typer.Argument(help=_PART, metavar="PART", readable=False)],
    out: Annotated[Path | None, typer.Option("--out", "-o", help=_OUT)] = None,
    scale: Annotated[float, typer.Option(help="Factor that makes a part file's vertices metres.")] = 1.0,
    most: Annotated[int, typer.Option(help="Grasps wanted, on different features.", min=1)] = 5,
    tries: Annotated[int, typer.Option(help="Places looked at at most.", min=1)] = 160,
    seed: Annotated[int, typer.Option(help="Of the random numbers.", min=0)] = 0,
    table: Annotated[float | None, typer.Option(help="Height z of a table that the hand stays above (m).")] = None,
    load: Annotated[str | None, typer.Option(help=_LOAD, metavar="NUMBERS")] = None,
    joint: Annotated[
        list[str] | None,
        typer.Option("--joint", help="A joint's position; no search; others: their middle.", metavar="NAME=VALUE"),
    ] = None,
    pose: Annotated[
        str | None, typer.Option(help="Of the hand: x,y,z[,roll,pitch,yaw]; no search.", metavar="NUMBERS")
    ] = None,
    html: Annotated[
        Path | None, typer.Option("--html", help="Page (or PNG) of the best grasp, hand and all.", metavar="OUT.html")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
) -> None:
    """Find grasps that close, that the hand reaches and that run into nothing; or judge the hand where it is.

    Exit code: 0 there is a grasp that is closed (and holds the load), 1 there is none, 3 none was found or it is
    undecided, 2 bad input.
    """
    from fixture_design.io import read_hand  # noqa: PLC0415 - pulls in the hands

    wrench = None if load is None else _load(load)
    if table is not None and not np.isfinite(table):
        raise InputError("--table cannot be used", found=f"{table:g}", expected="a height in metres")
    given, X_WH = _joints(joint or []), _pose(pose)
    read = read_hand(hand)
    of_part = _layout_of(part, scale)
    held_part = of_part.part
    assert held_part is not None  # refused without one
    check_outputs((out, html), (hand, part, read.model, held_part.file))
    if html is not None and html.suffix.lower() not in _PAGES:
        raise FileFormatError("pages are HTML, and pictures PNG", source=html, expected="a name with .html or .png")
    with interruptible() as cancelled:
        try:
            if joint or pose is not None:
                result = _judged(read, held_part, given, X_WH, wrench, table)
            else:
                from fixture_design.grasp.search import Search  # noqa: PLC0415 - slow, and only for a search
                from fixture_design.grasp.search import grasp as search_grasps  # noqa: PLC0415 - likewise

                asked = Search(most, tries, seed, table, wrench)
                result = search_grasps(read, held_part, asked, progress=shown, cancelled=cancelled)
        except InputError as error:
            raise error.within(part) from error
        finally:
            shown("", 1.0)
        result = carried(result, of_part, wrench)
        _write(result, out, html)
        if as_json:
            from fixture_design.io.grasp_record import grasps_to_dict  # noqa: PLC0415 - pulls in the hands

            typer.echo(dumps(grasps_to_dict(result, Path.cwd() if out is None else out.absolute().parent)))
        else:
            for line in grasps_in_words(result):
                typer.echo(line)
        raise typer.Exit(cancelled.code if cancelled() else of_answer(result.satisfied))


def _layout_of(path: Path, scale: float) -> Layout:
    """The layout of a file, or one that has nothing but the part that a file is."""
    if path.suffix.lower() not in TASK_ENDINGS:
        return Layout(path.stem, part=task_of_part(path, scale).part)
    if scale != 1:
        raise FileFormatError("`--scale` is for part files", source=path, expected="`scale` in the layout's `part`")
    layout = read_layout(path)
    if layout.part is None:
        raise FileFormatError("the layout has no part to grasp", source=path, expected="part: ...")
    return layout


def _judged(
    hand: Hand, part: Part, joints: dict[str, float], X_WH: Pose, load: np.ndarray | None, table: float | None
) -> GraspResult:
    """The one grasp that the hand makes where it is."""
    from fixture_design.geometry import load_part  # noqa: PLC0415 - Drake and trimesh
    from fixture_design.grasp import Posture, load_hand, posed  # noqa: PLC0415 - likewise

    model = load_hand(hand)
    return posed(Posture(model, model.positions(joints), X_WH), part, load_part(part), load, table)


def _joints(texts: Sequence[str]) -> dict[str, float]:
    given: dict[str, float] = {}
    for name, value in map(_assignment, texts):
        if name in given:
            raise InputError("--joint is given twice", found=f"{name}={value:g}", expected="each joint once")
        given[name] = value
    return given


def _pose(pose: str | None) -> Pose:
    numbers = [0.0] * 6 if pose is None else _numbers(pose, (3, 6), "--pose")
    return Pose.from_xyz_rpy(numbers[:3], numbers[3:] or [0.0, 0.0, 0.0])


def _assignment(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    try:
        return name.strip(), float(value if equals else "none")
    except ValueError as cause:
        raise InputError("--joint cannot be read", found=repr(text), expected="NAME=VALUE") from cause


def _load(text: str) -> np.ndarray:
    numbers = _numbers(text, (3, 6), "--load")
    return np.array(numbers + [0.0] * (6 - len(numbers)))


def _numbers(text: str, counts: tuple[int, ...], option: str) -> list[float]:
    expected = f"{' or '.join(map(str, counts))} numbers with commas between them"
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError as cause:
        raise InputError(f"{option} cannot be read", found=repr(text), expected=expected) from cause
    if len(numbers) not in counts or not np.isfinite(numbers).all():
        raise InputError(f"{option} cannot be used", found=repr(text), expected=expected)
    return numbers


def _write(result: GraspResult, out: Path | None, html: Path | None) -> None:
    if not result.grasps:
        for path in filter(None, (out, html)):
            stays = ", which stays as it was" if path.exists() else ""
            say(f"nothing is written to {path}{stays}: there is no grasp to write")
        return
    if out is not None:
        write_layout(written(result), out)
    if html is not None:
        from fixture_design.viewing import preview  # noqa: PLC0415 - only for a page

        preview(result).save(html)

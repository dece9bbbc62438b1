"""`fixture-design recognize CLASSIFIER LOG.csv`: the contact states along a log of forces."""

from __future__ import annotations

from itertools import groupby
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fixture_design.cli.exit_codes import ExitCode
from fixture_design.cli.messages import say
from fixture_design.cli.numbers import numbers
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.io import dumps
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from fixture_design.recognition import Classifier, Log, Recognition, Sensor


def recognize(
    classifier: Annotated[Path, typer.Argument(help="Classifier file.", metavar="CLASSIFIER", readable=False)],
    log: Annotated[
        Path,
        typer.Argument(
            help="Columns t, fx, ..., mz, dx, ..., rz (s, N, N m, m, rad).", metavar="LOG.csv", readable=False
        ),
    ],
    start: Annotated[
        str | None, typer.Option("--start", help="The state before the first row, or several.", metavar="N1,N2")
    ] = None,
    sensor: Annotated[
        str | None,
        typer.Option(
            "--sensor",
            help="The sensor's pose at the part's origin (m, rad).",
            metavar="X,Y,THETA or X,Y,Z,ROLL,PITCH,YAW",
        ),
    ] = None,
    tare: Annotated[
        str | None, typer.Option("--tare", help="The wrench that the sensor shows without a load.", metavar="FX,...,MZ")
    ] = None,
    tare_rows: Annotated[
        int, typer.Option("--tare-rows", help="Rows at the start without a load: their mean is the tare.", min=0)
    ] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
) -> None:
    """Tell for every row of a log which contact states remain possible, after those before and by the graph.

    Forces are those that the robot applies to the part: pressed onto a floor, fy < 0 (in space fz < 0). A sensor that
    shows what the part applies to the robot has the other sign.

    Exit code: 0, 3 some rows fit no state, 2 bad input.
    """
    from fixture_design.io import read_classifier, read_log  # noqa: PLC0415 - a tenth of any start
    from fixture_design.recognition import recognize_log  # noqa: PLC0415 - as above

    known = read_classifier(classifier)
    rows = read_log(log, known.signals.plane, known.signals.measure)
    if rows.unused:
        say(f"{log}: {', '.join(rows.unused)}: not used, {known.name} is planar")
    before = None if start is None else [name.strip() for name in start.split(",")]
    mounted = _sensor(known, rows, sensor, tare, tare_rows)
    _require_states(known, before)
    try:
        answers = recognize_log(known, rows, mounted, before)
    except InputError as error:
        raise error.within(log) from error
    if as_json:
        typer.echo(dumps(_record(known, rows, answers)))
    else:
        _print(known, rows, answers)
    if not all(answer.states for answer in answers):
        raise typer.Exit(ExitCode.UNDECIDED)


def _require_states(known: Classifier, names: list[str] | None) -> None:
    try:
        for name in names or ():
            known.state(name)
    except UnknownNameError as error:
        raise error.within("--start") from error


def _sensor(known: Classifier, rows: Log, pose: str | None, tare: str | None, tare_rows: int) -> Sensor:
    from fixture_design.recognition import Sensor  # noqa: PLC0415 - as above

    plane = known.signals.plane
    where, zero = numbers(pose, "--sensor"), numbers(tare, "--tare")
    size = 3 * (plane - 1)
    if where is not None and len(where) != size:
        raise InputError(f"--sensor takes {size} numbers here", found=pose)
    if where is not None and (turns := [angle for angle in where[plane:] if abs(angle) > 2 * pi]):
        raise InputError("--sensor takes angles in radians", found=f"{turns[0]:g}", expected="at most a full turn")
    if zero is not None and len(zero) != size:
        raise InputError(f"--tare takes {size} numbers here", found=tare)
    if zero is not None and tare_rows:
        raise InputError("--tare and --tare-rows exclude each other")
    if tare_rows > len(rows):
        raise InputError(f"--tare-rows {tare_rows}: the log has {len(rows)} rows")
    if tare_rows:
        zero = rows.wrenches[:tare_rows].mean(axis=0).tolist()
    if where is None:
        return Sensor.of(plane, None, zero)
    if plane == 2:
        return Sensor.of(plane, Pose.from_xy_theta(where[:2], where[2]), zero)
    return Sensor.of(plane, Pose.from_xyz_rpy(where[:3], where[3:]), zero)


def _record(known: Classifier, rows: Log, answers: list[Recognition]) -> dict[str, object]:
    return {
        "name": known.name,
        "states": {state.id: list(state.contacts) for state in known.states},
        "rows": [
            {
                "t": float(time), "states": list(answer.states), "expected": answer.expected, "told": answer.told,
                "margins": dict(answer.margins),
            }
            for time, answer in zip(rows.times, answers, strict=True)
        ],
    }  # fmt: skip


def _print(known: Classifier, rows: Log, answers: list[Recognition]) -> None:
    """Rows with the same answer in one line."""
    row = 0
    for _, group in groupby(answers, key=lambda a: (a.states, a.expected, a.told)):
        same = list(group)
        count = len(same)
        where = f"row {row + 1}" if count == 1 else f"rows {row + 1} to {row + count}"
        typer.echo(f"{where}, t = {rows.times[row]:g} s: {_words(known, same[0])}")
        row += count


def _words(known: Classifier, answer: Recognition) -> str:
    states = answer.states
    if not answer.told:
        return f"nothing was measured that tells; still possible: {', '.join(states)}"
    if not states:
        return "no state fits"
    surprise = "" if answer.expected else ", which no known transition leads to"
    if answer.state is None:
        return f"{len(states)} states are possible: {', '.join(states)}{surprise}"
    contacts = "; ".join(known.state(answer.state).contacts) or "no contact"
    return f"{answer.state} ({contacts}){surprise}"

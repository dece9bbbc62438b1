"""Classifier files `fixture_design/classifier/1`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fixture_design.cones import ConeUnion, PolyhedralConvexCone
from fixture_design.io.classifier_problems import classifier_problems
from fixture_design.io.classifier_records import ClassifierRecord, StateRecord
from fixture_design.io.documents import read_document
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import content_error
from fixture_design.io.schema_key import require_schema
from fixture_design.io.text_file import write_text
from fixture_design.recognition import (
    Classifier,
    Made,
    MeasurementSet,
    Noise,
    Signals,
    StateClass,
    Transition,
    Widening,
)
from fixture_design.version import VERSION


def classifier_to_dict(classifier: Classifier) -> dict[str, Any]:
    """The classifier as its file has it."""
    signals, noise, made = classifier.signals, classifier.noise, classifier.made
    return {
        "schema": "fixture_design/classifier/1",
        "name": classifier.name,
        "space": "planar" if signals.plane == 2 else "spatial",
        "units": "m",
        "signals": {
            "measure": signals.measure, "axes": signals.axes, "length": signals.length, "weight": signals.weight,
        },
        "noise": {"force": noise.force, "displacement": noise.displacement, "floor": noise.floor},
        "run": {
            "version": VERSION, "friction": made.friction, "edges": made.edges, "interpolation": made.interpolation,
            "accuracy": made.accuracy, "seed": made.seed, "smallest": made.smallest,
        },
        "states": [_state(state) for state in classifier.states],
        "transitions": [
            {"source": some.source, "target": some.target, "faces": [list(faces) for faces in some.faces]}
            for some in classifier.transitions
        ],
    }  # fmt: skip


def write_classifier(classifier: Classifier, path: str | Path) -> None:
    """Writes a classifier file, a line for each state and transition; the file is replaced at once.

    Raises:
        FileFormatError: the file cannot be written.
    """
    data = classifier_to_dict(classifier)
    lines = []
    for key, value in data.items():
        if key in ("states", "transitions"):
            items = ",\n".join("    " + json.dumps(item, allow_nan=False, ensure_ascii=False) for item in value)
            lines.append(f'  "{key}": [\n{items}\n  ]' if items else f'  "{key}": []')
        else:
            lines.append(f'  "{key}": {json.dumps(value, allow_nan=False, ensure_ascii=False)}')
    write_text(Path(path), "{\n" + ",\n".join(lines) + "\n}\n")


def read_classifier(path: str | Path) -> Classifier:
    """The classifier in a file.

    Raises:
        FileFormatError: the file cannot be read, or is no classifier.
    """
    document = read_document(path)
    require_schema(document, "classifier")
    record = validated(ClassifierRecord, document)
    plane = 2 if record.space == "planar" else 3
    some = record.signals
    signals = Signals(some.measure, some.axes, plane, some.length, some.weight)
    if problems := classifier_problems(record, signals.size):
        raise content_error(problems, document)
    made = record.run
    return Classifier(
        name=record.name,
        signals=signals,
        states=tuple(
            StateClass(state.id, state.contacts, _measured(state, signals.size), state.successors)
            for state in record.states
        ),
        transitions=tuple(Transition(each.source, each.target, each.faces) for each in record.transitions),
        noise=Noise(record.noise.force, record.noise.displacement, record.noise.floor),
        made=Made(made.friction, made.edges, made.interpolation, made.accuracy, made.seed, made.smallest),
    )


def _state(state: StateClass) -> dict[str, Any]:
    widening = state.measured.widening
    return {
        "id": state.id,
        "contacts": list(state.contacts),
        "successors": list(state.successors),
        "widening": {"force": widening.force, "displacement": widening.displacement},
        "cones": [
            {"faces": cone.faces.tolist(), "equalities": cone.equalities.tolist()} for cone in state.measured.cones
        ],
    }


def _measured(state: StateRecord, size: int) -> MeasurementSet:
    cones = [PolyhedralConvexCone.from_faces(cone.faces, cone.equalities, dimension=size) for cone in state.cones]
    return MeasurementSet(ConeUnion.of(cones), Widening(state.widening.force, state.widening.displacement))

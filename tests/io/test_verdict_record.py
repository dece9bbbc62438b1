"""Verdicts as JSON: every kind of witness, nothing that JSON cannot hold, and a schema that fits."""

import json
import subprocess
import sys
from types import UnionType
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from fixture_design.cones import PolyhedralConvexCone
from fixture_design.contacts import Contact
from fixture_design.errors import FileFormatError, UnknownNameError
from fixture_design.io import dumps, error_record, json_schema, verdict_to_dict
from fixture_design.io.records import LayoutRecord
from fixture_design.io.verdict_schema import FailureRecord, VerdictRecord
from fixture_design.layout import (
    Answer,
    Evidence,
    Finding,
    GroupVerdict,
    Motion,
    RequirementVerdict,
    Singular,
    Verdict,
    Weights,
)

KINDS: UnionType = VerdictRecord | FailureRecord
FLAT = Weights({"L1": (1.0, -0.0)}, (("L1", 0),), (), 1e-17)
TAKEN = Weights({"L1": (0.5,)}, (), (("L1", 0, 1),), 0.0)


def verdict(evidence: Evidence | None, **finding: Any) -> Verdict:
    """A verdict of one group with one finding."""
    cone = PolyhedralConvexCone.from_faces([[0.0, -0.0, -1.0]])
    group = GroupVerdict(
        "all", ("L1",), {"form_closure": Finding(Answer.YES, 0.25, evidence, 1e-17, **finding)}, (cone,), cone, ("L1",)
    )
    empty = GroupVerdict("locators", (), {"form_closure": Finding(None)})
    return Verdict(
        name="x",
        source="x.yaml",
        space="planar",
        satisfied=Answer.NO,
        groups={"locators": empty, "all": group},
        contacts=(Contact.on_facet("L1", "locator", [-0.0, 1], [0, 1], 0.5),),
        requirements=(RequirementVerdict("all", "form_closure", Answer.YES), RequirementVerdict("all", "seated", None)),
        notes=("a note",),
        reference=np.array([0.0, 1.0]),
        length=2.0,
        run={"version": "0", "kernel": "numpy", "tolerances": {"tie": 1e-9}},
    )


@pytest.mark.parametrize(
    ("evidence", "witness"),
    [
        (None, None),
        (Motion(np.array([-0.0, 1.0, 2.0]), 0.0), {"motion": [0.0, 1.0, 2.0]}),
        ((FLAT,), {"weights": {"L1": [1.0, 0.0]}, "basis": [["L1", 0]]}),
        ((TAKEN,), {"branches": [{"choice": [["L1", 0, 1]], "weights": {"L1": [0.5]}, "basis": []}]}),
        (
            (FLAT, TAKEN),
            {
                "branches": [
                    {"choice": [], "weights": {"L1": [1.0, 0.0]}, "basis": [["L1", 0]]},
                    {"choice": [["L1", 0, 1]], "weights": {"L1": [0.5]}, "basis": []},
                ]
            },
        ),
        (Singular(3, None, ((),), 0.0), {"rank": 3}),
        (
            Singular(2, np.array([0.0, 0.0, 1.0]), ((("L1", 0, 0),),), 0.0),
            {"rank": 2, "motion": [0.0, 0.0, 1.0], "choices": [[["L1", 0, 0]]]},
        ),
    ],
)
def test_witnesses(evidence: Evidence | None, witness: object) -> None:
    data = verdict_to_dict(verdict(evidence))
    text = dumps(data)
    assert "-0.0" not in text
    assert json.loads(text)["groups"]["all"]["form_closure"]["witness"] == witness
    TypeAdapter(KINDS).validate_json(text)


def test_the_whole_object() -> None:
    cone = {"faces": [[0.0, 0.0, -1.0]], "equalities": [], "spans": None, "lines": None}
    nothing = {"verdict": None, "margin": None, "witness": None, "residual": None}
    finding = {"verdict": "yes", "margin": 0.25, "witness": {"rank": 3}, "residual": 1e-17, "edges": 8, "reason": "why"}
    unset = {"admissible_displacements": None, "admissible_forces": None, "bidirectional": []}
    sets = {"admissible_displacements": {"cones": [cone]}, "admissible_forces": cone, "bidirectional": ["L1"]}
    assert verdict_to_dict(verdict(Singular(3, None, ((),), 0.0), edges=8, reason="why")) == {
        "schema": "fixture_design/verdict/1",
        "name": "x",
        "source": "x.yaml",
        "space": "planar",
        "units": "m",
        "satisfied": "no",
        "groups": {
            "locators": {"contacts": [], "form_closure": nothing} | unset,
            "all": {"contacts": ["L1"], "form_closure": finding} | sets,
        },
        "contacts": [
            {"name": "L1", "role": "locator", "point": [0.0, 1.0], "normals": [[[0.0, 1.0]]], "distance": None,
             "feature": None, "friction": 0.5, "provenance": {"kind": "exact", "normal_error": 0.0}}
        ],
        "requirements": [
            {"group": "all", "require": "form_closure", "verdict": "yes"},
            {"group": "all", "require": "seated", "verdict": None},
        ],
        "loads": [],
        "notes": ["a note"],
        "run": {"version": "0", "kernel": "numpy", "tolerances": {"tie": 1e-9}, "reference": [0.0, 1.0], "length": 2.0},
    }  # fmt: skip


def test_brief_leaves_out_evidence_sets_and_contacts() -> None:
    data = verdict_to_dict(verdict((FLAT,), edges=8, reason="why"), brief=True)
    assert "contacts" not in data
    assert data["groups"] == {
        "locators": {"contacts": [], "form_closure": {"verdict": None}},
        "all": {"contacts": ["L1"], "form_closure": {"verdict": "yes", "reason": "why"}},
    }
    TypeAdapter(KINDS).validate_json(dumps(data))


def test_numbers_that_json_does_not_have_are_a_fault() -> None:
    with pytest.raises(ValueError, match="not finite"):
        verdict_to_dict(verdict(Motion(np.array([np.nan, 0, 0]), 0.0)))
    with pytest.raises(ValueError, match="Out of range float values"):
        dumps({"a": float("inf")})


def test_a_layout_that_failed() -> None:
    data = error_record("a/x.yaml", FileFormatError("it is broken", source="a/x.yaml"))
    assert data == {
        "schema": "fixture_design/verdict/1",
        "name": "x",
        "source": "a/x.yaml",
        "error": {"kind": "FileFormatError", "message": "a/x.yaml: it is broken"},
    }
    TypeAdapter(KINDS).validate_json(dumps(data))


def test_schema_of_layouts() -> None:
    schema = json_schema("layout")
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["required"] == ["schema"]
    assert set(schema["properties"]) == {field.alias or name for name, field in LayoutRecord.model_fields.items()}
    assert schema["additionalProperties"] is False
    contact = schema["$defs"]["ContactRecord"]
    assert {"required": ["any_of"]} in contact["oneOf"]
    assert "[length]" in contact["properties"]["point"]["description"]
    element = schema["$defs"]["ElementRecord"]
    assert element["properties"]["tip"]["anyOf"] == [{"const": "point"}, {"$ref": "#/$defs/TipRecord"}]
    assert element["properties"]["role"]["enum"] == ["locator", "support", "clamp", "finger"]
    assert '"null"' not in json.dumps(schema)


def test_schema_of_verdicts() -> None:
    schema = json_schema("verdict")
    assert len(schema["anyOf"]) == 2
    assert "satisfied" in schema["$defs"]["VerdictRecord"]["required"]
    assert '"null"' in json.dumps(schema)


def test_schema_of_nothing() -> None:
    with pytest.raises(UnknownNameError) as caught:
        json_schema("layuot")
    kinds = "assembly, classifier, graph, hand, layout, task, verdict"
    assert str(caught.value) == f"no file kind is called 'layuot'; did you mean 'layout'? there are: {kinds}"


def test_reading_files_loads_no_geometry() -> None:
    heavy = "pydrake", "trimesh", "yourdfpy", "scipy", "meshcat"
    code = f"import sys, fixture_design.io; print([name for name in {heavy} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"

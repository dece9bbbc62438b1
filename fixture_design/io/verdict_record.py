"""A verdict as the JSON object `fixture_design/verdict/1`: plain numbers and lists, SI units, no -0.0, no NaN.

What was not computed is null or absent, never an empty list. The keys are those of `verdict_schema`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.cones import PolyhedralConvexCone
from fixture_design.contacts import Contact
from fixture_design.io.use_record import loads_to_list, use_to_dict
from fixture_design.io.witness_record import plain_numbers, witness_to_dict
from fixture_design.layout import Finding, GroupVerdict, Verdict

VERDICT_SCHEMA = "fixture_design/verdict/1"

Data = dict[str, object]


def verdict_to_dict(verdict: Verdict, brief: bool = False) -> Data:
    """The verdict's JSON object; ``brief`` leaves out witnesses, margins, residuals, sets and contacts' details.

    Raises:
        ValueError: a number that is NaN or infinite, which a verdict may not have.
    """
    data: Data = {
        "schema": VERDICT_SCHEMA,
        "name": verdict.name,
        "source": None if verdict.source is None else str(verdict.source),
        "space": verdict.space,
        "units": "m",
        "satisfied": _answer(verdict.satisfied),
        "groups": {name: _group(group, brief) for name, group in verdict.groups.items()},
    }
    if not brief:
        data["contacts"] = [_contact(contact) for contact in verdict.contacts]
    data["requirements"] = [
        {"group": row.group, "require": row.require, "verdict": _answer(row.answer)} for row in verdict.requirements
    ]
    return data | {"loads": loads_to_list(verdict.groups, brief), "notes": list(verdict.notes), "run": _run(verdict)}


def error_record(source: str | Path, error: Exception, name: str | None = None) -> Data:
    """The object that stands for a layout that could not be verified; ``name`` is the file's stem by default."""
    failure = {"kind": type(error).__name__, "message": str(error)}
    return {"schema": VERDICT_SCHEMA, "name": name or Path(source).stem, "source": str(source), "error": failure}


def _answer(answer: str | None) -> str | None:
    return None if answer is None else str(answer)


def _group(group: GroupVerdict, brief: bool) -> Data:
    data: Data = {"contacts": list(group.contacts)}
    data |= {name: _finding(finding, brief) for name, finding in group.findings.items()}
    if brief:
        return data
    displacements, forces = group.admissible_displacements, group.admissible_forces
    return data | {
        "admissible_displacements": None
        if displacements is None
        else {"cones": [cone_to_dict(cone) for cone in displacements]},
        "admissible_forces": None if forces is None else cone_to_dict(forces),
        "bidirectional": list(group.bidirectional),
    }


def _finding(finding: Finding, brief: bool) -> Data:
    data: Data = {"verdict": _answer(finding.answer)}
    if not brief:
        data |= {
            "margin": plain_numbers(finding.margin),
            "witness": witness_to_dict(finding.evidence) if finding.use is None else use_to_dict(finding.use),
            "residual": plain_numbers(finding.residual),
        }
        if finding.edges is not None:
            data["edges"] = int(finding.edges)
        if finding.tangents is not None:
            data["tangents"] = {name: plain_numbers(tangents) for name, tangents in finding.tangents.items()}
    if finding.reason is not None:
        data["reason"] = finding.reason
    return data


def cone_to_dict(cone: PolyhedralConvexCone) -> Data:
    """Both forms; null for vectors that were not computed."""
    face, span = cone.face_form, cone.span_form
    return {
        "faces": plain_numbers(face.faces if face else None),
        "equalities": plain_numbers(face.equalities if face else None),
        "spans": plain_numbers(span.spans if span else None),
        "lines": plain_numbers(span.lines if span else None),
    }


def _contact(contact: Contact) -> Data:
    provenance = contact.provenance
    source: Data = {"kind": provenance.kind, "normal_error": plain_numbers(provenance.normal_error)}
    data: Data = {
        "name": contact.name,
        "role": contact.role,
        "point": plain_numbers(contact.point),
        "normals": [[plain_numbers(normal) for normal in clause] for clause in contact.clauses],
        "distance": plain_numbers(contact.distance),
        "feature": contact.feature,
        "friction": plain_numbers(contact.friction),
        "provenance": source,
    }
    # keys of soft tips, pins and edges alone
    lengths = {"torsion": contact.torsion, "clearance": contact.clearance}
    linked: Data = {} if contact.linked is None else {"linked": contact.linked}
    if provenance.slip_error is not None:
        data["provenance"] = {**source, "slip_error": plain_numbers(provenance.slip_error)}
    if contact.slips and provenance.normal_error:
        data["slips"] = [plain_numbers(slips) for slips in contact.slips]
    return data | {key: plain_numbers(length) for key, length in lengths.items() if length} | linked


def _run(verdict: Verdict) -> Data:
    measured = {"reference": plain_numbers(verdict.reference), "length": plain_numbers(verdict.length)}
    return {str(key): _plain(value) for key, value in verdict.run.items()} | measured


def _plain(value: Any) -> object:
    """Settings of a run, whatever they are, as JSON has them."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray | np.floating | float):
        return plain_numbers(value)
    if value is None or isinstance(value, bool | int | str):
        return value
    return int(value) if isinstance(value, np.integer) else str(value)

"""What is looked at together gets the records that `verify` gives one by one."""

import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fixture_design.batch.alike import Alike
from fixture_design.batch.alike.plan import QUESTIONS
from fixture_design.batch.alike.structure import cut, numbers_of, structure_of
from fixture_design.batch.item import Item
from fixture_design.batch.items import items_of as items_in
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.reading import layout_of
from fixture_design.batch.records import Detail, Looked, entry_of, look_at
from fixture_design.batch.worker import verifying
from fixture_design.contacts import Contact
from fixture_design.layout import (
    Answer,
    Evidence,
    Finding,
    GroupVerdict,
    Layout,
    Motion,
    RequirementVerdict,
    Singular,
    Verdict,
    Weights,
)
from fixture_design.verification import check
from tests.batch.layouts import LAYOUT

COUNT = 25
REQUIRE = {"locators": ["deterministic", "strongly_accessible"], "all": ["form_closure", "force_closure"]}
Make = Callable[[np.random.Generator], list[dict[str, object]]]


def smooth(rng: np.random.Generator, count: int, plane: int, **keys: object) -> list[dict[str, object]]:
    """Contacts around an ellipsoid, some of them opposite each other so that many close."""
    directions = rng.normal(size=(count, plane))
    directions[count // 2 :] = -directions[: count - count // 2] + 0.3 * rng.normal(size=directions[count // 2 :].shape)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    axes = np.array([0.05, 0.04, 0.03])[:plane]
    points, normals = np.round(directions * axes, 6).tolist(), np.round(directions / axes, 4).tolist()
    return [
        {"name": f"C{k}", "role": "clamp" if k % 4 == 3 else "locator", "point": p, "normal": n} | keys
        for k, (p, n) in enumerate(zip(points, normals, strict=True))
    ]


def boxed(rng: np.random.Generator, count: int) -> list[dict[str, object]]:
    """Contacts on the faces of a box, at coordinates of a few digits: degenerate more often than not."""
    contacts = []
    for k in range(count):
        axis, side = int(rng.integers(3)), int(rng.integers(2)) * 2 - 1
        normal, point = [0, 0, 0], rng.integers(-3, 4, size=3).tolist()
        normal[axis], point[axis] = side, 4 * side
        contacts.append({"name": f"C{k}", "role": "locator", "point": point, "normal": normal})
    return contacts


def with_ors(rng: np.random.Generator) -> list[dict[str, object]]:
    contacts = smooth(rng, 6, 2)
    for contact in contacts[:3]:
        normal = contact.pop("normal")
        other = np.round(np.array(normal) + 8 * rng.normal(size=2), 3).tolist()
        contact[("any_of", "all_of", "normals")[contacts.index(contact)]] = (
            [[normal, other]] if contact is contacts[2] else [normal, other]
        )
    return contacts


FAMILIES: dict[str, Make] = {
    "smooth": lambda rng: smooth(rng, 12, 3),
    "planar": lambda rng: smooth(rng, 5, 2),
    "few": lambda rng: smooth(rng, 4, 3),
    "friction": lambda rng: smooth(rng, 5, 3, friction=round(float(rng.uniform(0, 0.8)), 3)),
    "planar friction": lambda rng: smooth(rng, 4, 2, friction=0.3),
    "boxed": lambda rng: boxed(rng, 9),
    "boxed planes": lambda rng: boxed(rng, 7),
    "ors": with_ors,
}


def items_of(family: str, seed: int = 5, **keys: object) -> list[Item]:
    rng = np.random.default_rng(seed)
    space = "planar" if "planar" in family or family == "ors" else "spatial"
    texts = []
    for number in range(COUNT):
        head = {"schema": LAYOUT, "name": f"n{number}", "space": space, "require": REQUIRE}
        texts.append(json.dumps({**head, "contacts": FAMILIES[family](rng), **keys}))
    return [Item(f"lib.jsonl:{k}", text.encode(), k) for k, text in enumerate(texts, start=1)]


def record(line: bytes) -> dict:
    found = json.loads(line)
    found.get("run", {}).pop("time", None)
    return found


@pytest.mark.parametrize("family", FAMILIES)
def test_brief_records_are_those_of_verify(family: str) -> None:
    items = items_of(family)
    together = Alike("brief").entries(items)
    assert len(together) > COUNT // 3
    answers = Counter()
    for place, entry in together:
        expected = entry_of(items[place], PartCache(), "brief")
        assert record(entry.line) == record(expected.line)
        assert list(record(entry.line)) == list(record(expected.line))
        assert entry.outcome == expected.outcome
        answers[record(entry.line)["groups"]["all"]["force_closure"]["verdict"]] += 1
    if family in {"smooth", "planar", "friction", "ors"}:
        assert len(answers) == 2  # a family that always says the same would test little


def test_stages_units_and_numbers_of_any_form() -> None:
    stages = [
        {"name": "a", "active": ["C0", "clamp"], "gravity": True, "require": ["accessible"]},
        {"name": "b", "active": ["support"]},
        {"name": "c", "active": ["support"], "require": ["form_closure"]},
    ]
    for units in ("m", "mm", "in"):
        items = items_of("smooth", stages=stages, units=units, friction=1e-1)[:6]
        together = Alike("brief").entries(items)
        assert len(together) >= 3
        for place, entry in together:
            assert record(entry.line) == record(entry_of(items[place], PartCache(), "brief").line)


@pytest.mark.parametrize("family", ["smooth", "planar", "few", "boxed", "boxed planes"])
def test_full_records_have_the_margins_of_verify_and_evidence_that_proves(family: str) -> None:
    items = items_of(family)
    together = Alike("full").entries(items)
    assert len(together) > COUNT // 3
    for place, entry in together:
        found, expected = record(entry.line), entry_of(items[place], PartCache(), "full")
        compare(found, record(expected.line))
        assert entry.margin == pytest.approx(expected.margin, rel=1e-7, abs=1e-10)
        layout = layout_of(items[place])
        assert check(verdict_from(found, layout.contacts)) == []


@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.parametrize("units", ["m", "mm"])
def test_variants_of_a_sweep_are_those_of_verify(tmp_path: Path, detail: Detail, units: str) -> None:
    contacts = smooth(np.random.default_rng(2), 8, 3)
    sweep = {"at": 0.02, "samples": 30, "seed": 1}
    layout = {"schema": LAYOUT, "units": units, "contacts": contacts, "require": REQUIRE, "sweep": sweep}
    (tmp_path / "x.json").write_text(json.dumps(layout))
    items = list(items_in([tmp_path / "x.json"]))
    together = Alike(detail).entries(items)
    assert len(together) == 30
    for place, entry in together:
        expected = entry_of(items[place], PartCache(), detail)
        found = record(entry.line)
        assert found["name"] == f"x[{place}]"
        if detail == "brief":
            assert found == record(expected.line)
        else:
            compare(found, record(expected.line))


BOX = [(0.1, 0.0, 0.0), (-0.1, 0.0, 0.0), (0.0, 0.08, 0.0), (0.0, -0.08, 0.0), (0.0, 0.0, 0.05), (0.0, 0.0, -0.05)]


def on_box(tmp_path: Path, rng: np.random.Generator, **keys: object) -> dict[str, object]:
    """Balls on the faces of a box, a few of them on its edges and corners."""
    (tmp_path / "box.obj").write_text(OBJ)
    half, elements = np.array([0.1, 0.08, 0.05]), []
    for k in range(9):
        face = BOX[(k if k < 6 else int(rng.integers(6)))]
        inside = np.where(rng.random(3) < 0.05, half, rng.uniform(-0.8, 0.8, 3) * half)
        at = np.where(np.abs(face) > 0, face, np.round(inside, 5))
        elements.append({"name": f"E{k}", "role": "locator" if k < 7 else "clamp", "at": at.tolist()})
    stages = [{"name": "s", "active": ["clamp", "E1"], "require": ["accessible"]}]
    return {"schema": LAYOUT, "part": {"mesh": "box.obj"}, "elements": elements, "stages": stages, **keys}


OBJ = "".join(f"v {x * 0.1} {y * 0.08} {z * 0.05}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)) + "".join(
    f"f {a} {b} {c}\nf {a} {c} {d}\n"
    for a, b, c, d in ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
)


@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_layouts_on_parts_are_decided_alike(tmp_path: Path, detail: Detail, friction: float) -> None:
    rng, parts, alike = np.random.default_rng(8), PartCache(), Alike(detail)
    layouts = [on_box(tmp_path, rng, name=f"b{n}", require=REQUIRE, friction=friction) for n in range(10)]
    items = [Item(str(tmp_path / f"l:{n}"), json.dumps(layout).encode(), n) for n, layout in enumerate(layouts)]
    waiting = {place: looked for place, item in enumerate(items) if isinstance(looked := look_at(item, parts), Looked)}
    together = dict(alike.entries_of_found(waiting, items))
    assert len(waiting) == 10
    assert len(together) > 4 or (detail == "full" and friction > 0)
    for place, entry in together.items():
        found, expected = record(entry.line), record(entry_of(items[place], parts, detail).line)
        if detail == "brief":
            assert found == expected
            continue
        compare(found, expected)
        assert check(verdict_from(found, waiting[place].found.contacts)) == []


@pytest.mark.parametrize("detail", ["brief", "full"])
def test_a_worker_gives_every_place_once(tmp_path: Path, detail: Detail) -> None:
    """Layouts on parts, alike or not, between layouts of contacts and errors."""
    rng = np.random.default_rng(9)
    layouts: list[dict[str, object]] = []
    for n in range(6):
        layouts += [on_box(tmp_path, rng, name=f"b{n}", require=REQUIRE), {"schema": "x"}]
        layouts += [{"schema": LAYOUT, "contacts": smooth(rng, 8, 3), "require": REQUIRE}]
        layouts += [on_box(tmp_path, rng, name=f"l{n}", require={"locators": ["loadable"]})]
    items = [Item(str(tmp_path / f"l:{n}"), json.dumps(layout).encode(), n) for n, layout in enumerate(layouts)]
    known = [pair for some in verifying(detail)(items) for pair in some]
    assert sorted(place for place, _ in known) == list(range(len(items)))
    for place, entry in known:
        found, expected = record(entry.line), record(entry_of(items[place], PartCache(), detail).line)
        assert (found["name"], found["source"], list(found)) == (expected["name"], expected["source"], list(expected))
        assert entry.outcome == ("bad input" if place % 4 == 1 else found["satisfied"])
        assert found.get("satisfied") == expected.get("satisfied")


def compare(found: dict, expected: dict) -> None:
    """Everything but the witnesses is the same; these are of the same kind."""
    for name, group in expected["groups"].items():
        assert list(found["groups"][name]) == list(group)
        for claim, finding in group.items():
            if not isinstance(finding, dict):
                continue
            other = found["groups"][name][claim]
            assert list(other) == list(finding)
            assert other["verdict"] == finding["verdict"]
            assert other["margin"] == pytest.approx(finding["margin"], rel=1e-7, abs=1e-10)
            assert list(other["witness"]) == list(finding["witness"])
            assert other["witness"].get("rank") == finding["witness"].get("rank")
    rest = [{key: value for key, value in record.items() if key != "groups"} for record in (found, expected)]
    assert rest[0] == rest[1]


def verdict_from(record: dict, contacts: tuple[Contact, ...]) -> Verdict:
    """The verdict that a full record tells, for the checker."""
    groups = {
        name: GroupVerdict(name, tuple(group["contacts"]), {c: finding_from(group[c]) for c in QUESTIONS})
        for name, group in record["groups"].items()
    }
    rows = tuple(
        RequirementVerdict(row["group"], row["require"], row["verdict"] and Answer(row["verdict"]))
        for row in record["requirements"]
    )
    satisfied = record["satisfied"] and Answer(record["satisfied"])
    scale = np.array(record["run"]["reference"]), record["run"]["length"]
    return Verdict(
        name=record["name"], source=None, space=record["space"], satisfied=satisfied, groups=groups,
        contacts=contacts, requirements=rows, notes=(), reference=scale[0], length=scale[1], run={},
    )  # fmt: skip


def finding_from(data: dict) -> Finding:
    if data["verdict"] is None:
        return Finding(None)
    witness, residual = data["witness"], data["residual"]
    evidence: Evidence
    if "rank" in witness:
        motion = np.array(witness["motion"]) if "motion" in witness else None
        evidence = Singular(witness["rank"], motion, ((),), residual)
    elif "motion" in witness:
        evidence = Motion(np.array(witness["motion"]), residual)
    else:
        weights = {name: tuple(values) for name, values in witness["weights"].items()}
        evidence = (Weights(weights, tuple(map(tuple, witness["basis"])), (), residual),)
    return Finding(Answer(data["verdict"]), data["margin"], evidence, residual)


LINE = b'{"name": "a", "contacts": [{"name": "C 1, 2", "point": [1, -2.5e-3, 0]}]}'
CHANGED = [
    LINE.replace(b"1, -2", b"01, -2"),
    LINE.replace(b"1, -2", b"+1, -2"),
    LINE.replace(b"1, -2", b"1., -2"),
    LINE.replace(b"1, -2", b"1 -2"),
    LINE.replace(b"1, -2", b"1,  -2"),
    LINE.replace(b"[1, ", b"1[, "),
    LINE.replace(b"C 1, 2", b"C 1, 3"),
    LINE.replace(b"C 1, 2", b"C 1\\u002c 2"),
    LINE.replace(b'"a"', b'""'),
    LINE.replace(b'"a"', b'"\xc3\xa9"'),
    LINE.replace(b'"a"', b'"a\t"'),
    LINE.replace(b'"name": "a"', b'"nam": "a"'),
    LINE.replace(b"}]}", b"}]"),
    LINE.replace(b"0]", b"true]"),
    LINE.replace(b"0]", b"NaN]"),
]


def test_a_line_is_alike_only_if_nothing_but_numbers_and_name_differ() -> None:
    first = cut(LINE)
    assert first is not None
    structure = structure_of(first)
    assert structure is not None
    assert structure.paths == tuple(("contacts", 0, "point", k) for k in range(3))
    same = cut(LINE.replace(b'"a"', b'"b"').replace(b"-2.5e-3", b"7"))
    assert same is not None
    assert structure.name_in(same.quoted) == "b"
    assert structure.filled % same.numbers == same.outside
    assert numbers_of(same) == [1, 7, 0]
    for text in CHANGED:
        other = cut(text)
        if other is None or numbers_of(other) is None or len(other.numbers) != 3:
            continue
        assert structure.name_in(other.quoted) is None or structure.filled % other.numbers != other.outside, text


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(b'"point": [', b'"point": [1e999, ', 1),
        lambda text: text.replace(b'"normal": [', b'"normal": [0.0, 0.0, 0.0], "x": [', 1),
        lambda text: text.replace(b'"role": "locator"', b'"role": "locater"', 1),
        lambda text: text[:-1],
        lambda text: text.replace(b'"n3"', b'"n3", "name": "twice"'),
        lambda text: text.replace(b'"friction": 0.1', b'"friction": -0.1'),
        lambda text: text.replace(b'"friction": 0.1', b'"friction": 1' + b"0" * 400),
    ],
)
def test_a_bad_layout_among_good_ones_is_left_to_verify(change: Callable[[bytes], bytes]) -> None:
    items = items_of("smooth", friction=0.1)
    items[3] = items[3]._replace(text=change(items[3].text or b""))
    assert items[3].text != items_of("smooth", friction=0.1)[3].text
    together = dict(Alike("brief").entries(items))
    assert 3 not in together
    assert len(together) > COUNT // 3 or b"0" * 400 in items[3].text  # a number no float holds stops its pile


def test_zero_normals_and_far_points_are_left_to_verify() -> None:
    items = items_of("smooth")
    layouts = [json.loads(item.text or b"") for item in items]
    layouts[1]["contacts"][0]["normal"] = [0, 0, 0]
    layouts[2]["contacts"][0]["point"] = [1e12, 0, 0]
    layouts[4]["contacts"][1] = {**layouts[4]["contacts"][0], "name": "C1"}
    for contact in layouts[5]["contacts"]:
        contact["point"] = [x + 1e5 for x in contact["point"]]
    items = [item._replace(text=json.dumps(layout).encode()) for item, layout in zip(items, layouts, strict=True)]
    together = dict(Alike("brief").entries(items))
    assert not {1, 2, 4, 5} & set(together)
    assert 6 in together


@pytest.mark.parametrize("detail", ["brief", "full"])
def test_bad_layouts_among_good_ones_cost_these_nothing(detail: Detail) -> None:
    """A zero normal must not reach what computes evidence for all of a pile."""
    items = items_of("smooth")
    layouts = [json.loads(item.text or b"") for item in items]
    layouts[1]["contacts"][0]["normal"] = [0, 0, 0]
    layouts[2]["contacts"][0]["point"] = [1e300, 0, 0]
    layouts[3]["contacts"][0]["normal"] = [1e-320, 0, 0]
    items = [item._replace(text=json.dumps(layout).encode()) for item, layout in zip(items, layouts, strict=True)]
    together = Alike(detail).entries(items)
    assert {place for place, _ in together} >= {0, *range(4, COUNT)}
    assert not {1, 2} & {place for place, _ in together}


def near_ties(rng: np.random.Generator, plane: int, friction: float) -> list[bytes]:
    """Layouts of one kind on the faces of a box, degenerate but for errors about as large as ties."""
    count = int(rng.integers(7, 11) if plane == 3 else rng.integers(4, 7))
    points, normals = rng.integers(-3, 4, size=(count, plane)).astype(float), np.zeros((count, plane))
    for k in range(count):
        axis, side = k % plane, (-1) ** (k // plane)
        normals[k, axis], points[k, axis] = side, 4 * side
    size = 10 ** rng.uniform(-11.3, -8)
    texts = []
    for number in range(12):
        off = [size * rng.normal(size=points.shape) * (rng.random(points.shape) < 0.4) for _ in range(2)]
        contacts = [
            {"name": f"C{k}", "role": "locator", "point": p.tolist(), "normal": n.tolist()}
            for k, (p, n) in enumerate(zip(points + off[0], normals + off[1], strict=True))
        ]
        head = {"schema": LAYOUT, "name": f"n{number}", "space": "planar" if plane == 2 else "spatial"}
        texts.append(json.dumps({**head, "friction": friction, "contacts": contacts, "require": REQUIRE}).encode())
    return texts


@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("plane", [2, 3])
def test_near_ties_have_the_answers_of_verify(plane: int, friction: float, detail: Detail) -> None:
    """Whoever a layout is looked at with, its answers are the same ones."""
    rng, told = np.random.default_rng([plane, int(10 * friction)]), 0
    for _ in range(6):
        items = [Item(f"l:{k}", text, k) for k, text in enumerate(near_ties(rng, plane, friction), start=1)]
        for place, entry in Alike(detail).entries(items):
            told += 1
            found, expected = record(entry.line), record(entry_of(items[place], PartCache(), detail).line)
            for name, group in expected["groups"].items():
                answers = {q: found["groups"][name][q]["verdict"] for q in QUESTIONS}
                assert answers == {q: group[q]["verdict"] for q in QUESTIONS}
    assert told > 5 or (friction > 0 and detail == "full")


def test_margins_do_not_depend_on_who_looks_at_a_layout() -> None:
    """To the last digit: a layout may be looked at together with others, or be left over."""
    for family in ("smooth", "few", "planar", "boxed"):
        items = items_of(family, seed=11)
        for place, entry in list(Alike("full").entries(items))[:8]:
            found, expected = record(entry.line), record(entry_of(items[place], PartCache(), "full").line)
            for name, group in expected["groups"].items():
                for question in QUESTIONS:
                    assert found["groups"][name][question]["margin"] == group[question]["margin"], (family, place)


def test_names_that_look_like_marks() -> None:
    """A contact may be called as the blanks of a record are."""
    names = ["@source", "123.000007", "@m0", "@name", "@@input", "124.000017", "%s"]
    items = items_of("smooth")
    texts = [item.text or b"" for item in items]
    for k, name in enumerate(names):
        texts = [text.replace(b'"C%d"' % k, json.dumps(name).encode()) for text in texts]
    items = [item._replace(text=text) for item, text in zip(items, texts, strict=True)]
    for detail in ("brief", "full"):
        together = Alike(detail).entries(items)  # type: ignore[arg-type]
        assert len(together) > COUNT // 3
        for place, entry in together[:5]:
            found, expected = record(entry.line), record(entry_of(items[place], PartCache(), detail).line)  # type: ignore[arg-type]
            assert {n: g["contacts"] for n, g in found["groups"].items()} == {
                n: g["contacts"] for n, g in expected["groups"].items()
            }
            assert [c["name"] for c in found.get("contacts", ())] == [c["name"] for c in expected.get("contacts", ())]
            assert found["source"] == items[place].source


def test_interleaved_sets_of_names_are_all_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nine kinds of one shape, one after the other: each is read as a layout once."""
    items = []
    for number, item in enumerate(items_of("smooth") * 4):
        text = (item.text or b"").replace(b'"C', b'"K%d ' % (number % 9))
        items.append(item._replace(source=f"l:{number}", text=text))
    read: list[str] = []

    def counted(item: Item, **keys: bool) -> Layout:
        read.append(item.source)
        return layout_of(item, **keys)

    monkeypatch.setattr("fixture_design.batch.alike.look.layout_of", counted)
    assert len(Alike("brief").entries(items)) > 90
    assert len(read) == 9


def test_a_source_that_is_no_text() -> None:
    items = [item._replace(source="l\udcff.jsonl:1") for item in items_of("smooth")[:4]]
    assert all(b"l\\udcff.jsonl" in entry.line for _, entry in Alike("brief").entries(items))

"""Which files a batch is about, and which layouts are in them."""

import json
import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from fixture_design.batch.digest import file_hash
from fixture_design.batch.inputs import input_files
from fixture_design.batch.items import items_of, total_share
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.reading import layout_of
from fixture_design.batch.records import entry_of
from fixture_design.errors import FileFormatError, InputError
from tests.batch.layouts import lines, planar


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("b.yaml", "a.json", "deep/c.yml", "deep/d.jsonl", "x.txt", ".hidden/e.yaml", ".f.yaml"):
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text("schema: fixture_design/layout/1\n")
    (tmp_path / "verdicts.jsonl").write_text('{"schema": "fixture_design/verdict/1"}\n')
    (tmp_path / "task.yaml").write_text("schema: fixture_design/task/1\n")
    (tmp_path / "broken.yaml").write_text("{[")
    return tmp_path


def test_a_folder_has_its_layouts_in_order(folder: Path) -> None:
    found = [str(file.relative_to(folder)) for file in input_files([folder])]
    assert found == ["a.json", "b.yaml", "broken.yaml", os.path.join("deep", "c.yml"), os.path.join("deep", "d.jsonl")]


def test_paths_keep_their_order_and_come_once(folder: Path) -> None:
    b, a = folder / "b.yaml", folder / "a.json"
    assert input_files([b, folder / "*.json", a, folder / "b.yaml"]) == [b, a]
    assert input_files([folder])[0] == a


def test_a_named_file_is_taken_whatever_it_holds(folder: Path) -> None:
    assert input_files([folder / "task.yaml"]) == [folder / "task.yaml"]


def test_globs_go_into_folders(folder: Path) -> None:
    assert input_files([f"{folder}/**/*.jsonl"], besides=folder / "verdicts.jsonl") == [folder / "deep/d.jsonl"]


def test_a_name_with_brackets_is_a_name_where_it_is_there(tmp_path: Path) -> None:
    file = tmp_path / "x[1].yaml"
    file.touch()
    assert input_files([file]) == [file]


@pytest.mark.parametrize(
    ("path", "words"),
    [("nowhere.yaml", "there is no such file or folder"), ("*.toml", "no file matches this pattern"),
     ("x[", "no file matches"), ("empty", "no layouts in this folder")],
)  # fmt: skip
def test_wrong_paths(folder: Path, path: str, words: str) -> None:
    (folder / "empty").mkdir()
    with pytest.raises(FileFormatError, match=words):
        input_files([folder / "b.yaml", folder / path])


def test_no_paths() -> None:
    with pytest.raises(FileFormatError, match="nothing to look at"):
        input_files([])


def test_lines_are_items_with_their_numbers(tmp_path: Path) -> None:
    file = lines(tmp_path / "lib.jsonl", [planar("one"), "", planar(), "{broken"])
    items = list(items_of([file]))
    assert [item.source for item in items] == [f"{file}:{n}" for n in (1, 3, 4)]
    assert [layout_of(item).name for item in items[:2]] == ["one", "lib:3"]
    assert sum(item.share for item in items) <= total_share([file])
    with pytest.raises(InputError) as caught:
        layout_of(items[2])
    assert str(caught.value).startswith(f"{file}:4: column 2: not valid JSON")


def test_places_in_a_line_are_without_a_line_number(tmp_path: Path) -> None:
    (item,) = items_of([lines(tmp_path / "lib.jsonl", [planar(friction=-1)])])
    with pytest.raises(InputError, match=r"lib.jsonl:1: friction: 'friction' is out of range"):
        layout_of(item)


def test_files_are_relative_to_the_jsonl(tmp_path: Path) -> None:
    layout = {"schema": "fixture_design/layout/1", "part": {"mesh": "parts/a.stl"}}
    (item,) = items_of([lines(tmp_path / "lib.jsonl", [layout])])
    part = layout_of(item).part
    assert part is not None
    assert part.file == tmp_path / "parts/a.stl"


def test_items_are_read_when_they_are_asked_for(tmp_path: Path) -> None:
    file = lines(tmp_path / "lib.jsonl", [planar(str(n), sweep={"at": 0.1, "samples": 1_000_000}) for n in range(3)])
    assert [item.variant for item in islice(items_of([file]), 3)] == [0, 1, 2]


def test_files_that_cannot_be_read_are_items(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.jsonl")
    os.mkfifo(tmp_path / "pipe.yaml")
    for item in items_of([tmp_path / "pipe.jsonl", tmp_path / "pipe.yaml"]):
        with pytest.raises(FileFormatError, match="no regular file"):
            layout_of(item)


def test_folders_that_are_links_are_looked_into_and_circles_end(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "elsewhere" / "deep").mkdir(parents=True)
    (tmp_path / "elsewhere" / "deep" / "x.yaml").write_text("schema: fixture_design/layout/1\n")
    (tmp_path / "lib" / "linked").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "elsewhere" / "deep" / "round").symlink_to(tmp_path / "elsewhere")
    assert input_files([tmp_path / "lib"]) == [tmp_path / "lib" / "linked" / "deep" / "x.yaml"]


def test_a_folder_that_cannot_be_read_is_not_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(folder: object, **keys: Any) -> Iterator[object]:
        keys["onerror"](PermissionError(13, "Permission denied", str(tmp_path / "secret")))
        return iter(())

    monkeypatch.setattr(os, "walk", refuse)
    with pytest.raises(FileFormatError, match="secret: the folder cannot be read: Permission denied"):
        input_files([tmp_path])


def test_a_folder_without_layouts_among_those_of_a_pattern(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    (tmp_path / "b" / "x.json").write_text("{}")
    assert input_files([tmp_path / "*"]) == [tmp_path / "b" / "x.json"]
    with pytest.raises(FileFormatError, match="no layouts in what matches"):
        input_files([tmp_path / "a*"])


def test_an_empty_file_of_lines_is_an_error_and_not_nothing(tmp_path: Path) -> None:
    (tmp_path / "e.jsonl").write_text("\n\n")
    (item,) = items_of([tmp_path / "e.jsonl"])
    record = json.loads(entry_of(item, PartCache(), "brief").line)
    assert record["error"]["kind"] in {"FileFormatError", "LayoutError"}


def test_a_sweep_whose_key_is_escaped_is_one(tmp_path: Path) -> None:
    text = json.dumps(planar("s", sweep={"at": 0.1, "samples": 3})).replace('"sweep"', '"\\u0073weep"')
    assert "sweep" not in text
    (tmp_path / "s.json").write_text(text)
    assert [item.variant for item in items_of([tmp_path / "s.json"])] == [0, 1, 2]


def test_a_changed_mesh_or_buffer_is_another_input(tmp_path: Path) -> None:
    """Also where the file that names it has not changed."""
    (tmp_path / "box.obj").write_text("v 0 0 0\n")
    (tmp_path / "p.urdf").write_text(
        '<robot name="p"><link name="l"><visual><geometry><mesh filename="box.obj"/></geometry></visual></link></robot>'
    )
    (tmp_path / "b.bin").write_bytes(b"12")
    (tmp_path / "m.gltf").write_text(json.dumps({"buffers": [{"uri": "b.bin"}, {"uri": "data:,x"}, {"uri": "no.bin"}]}))
    before = [file_hash(tmp_path / name) for name in ("p.urdf", "m.gltf")]
    assert "missing" not in before
    assert before == [file_hash(tmp_path / name) for name in ("p.urdf", "m.gltf")]
    (tmp_path / "box.obj").write_text("v 1 0 0\n")
    (tmp_path / "b.bin").write_bytes(b"34")
    after = [file_hash(tmp_path / name) for name in ("p.urdf", "m.gltf")]
    assert before[0] != after[0]
    assert before[1] != after[1]
    (tmp_path / "box.obj").unlink()
    assert file_hash(tmp_path / "p.urdf") == "missing"

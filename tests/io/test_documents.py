"""Files that cannot be read or do not parse: one sentence that says where and what to do."""

import os
import time
from pathlib import Path

import pytest
import yaml

from fixture_design.errors import FileFormatError
from fixture_design.io import read_document, yaml_reader

HEAD = "schema: fixture_design/layout/1\n"


def message(path: Path, content: str | bytes) -> str:
    """What reading a file of this content says, from the file's name on."""
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(FileFormatError) as caught:
        read_document(path)
    text = str(caught.value)
    assert text.startswith(str(path))
    return text.removeprefix(str(path.parent) + os.sep)


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        ("", "a.yaml: the file is empty; expected a mapping that starts with `schema:`"),
        ("# only this\n", "a.yaml: the file is empty; expected a mapping that starts with `schema:`"),
        ("---\n", "a.yaml: the file is empty; expected a mapping that starts with `schema:`"),
        ("- 1\n", "a.yaml: line 1: the file holds no mapping; found a list; expected `key: value` lines"),
        (
            "hello\n",
            "a.yaml: line 1: the file holds no mapping; found the single value 'hello'; expected `key: value` lines",
        ),
        (
            HEAD + "---\na: 1\n",
            "a.yaml: line 2, column 1: a second document starts here ('---'); expected one document in a file",
        ),
        (
            HEAD + "part:\n\tmesh: a\n",
            "a.yaml: line 3, column 1: not valid YAML: a tab in the indentation; YAML wants spaces",
        ),
        (
            HEAD + "g: [0, 0\nname: x\n",
            "a.yaml: line 3, column 5: not valid YAML: a list opened with '[' is not continued with ',' or closed with "
            "']' (it starts in line 2)",
        ),
        (
            HEAD + "name: @x\n",
            "a.yaml: line 2, column 7: not valid YAML: text cannot start with '@'; put quotes around it",
        ),
        (
            HEAD + "name: 'abc\n",
            "a.yaml: line 3, column 1: not valid YAML: a quote is opened and not closed (it starts in line 2)",
        ),
        (
            HEAD + "name: a: b\n",
            "a.yaml: line 2, column 8: not valid YAML: a ':' where none can be; check the indentation, and put quotes "
            "around text that contains ': '",
        ),
        (
            "a: 1\nb: 2\na: 3\n",
            "a.yaml: line 3, column 1: the key 'a' is given twice, in lines 1 and 3; expected each key once",
        ),
        ("1: a\n", "a.yaml: line 1, column 1: a key must be text, not '1'; expected quotes: '1'"),
        ("? [1]\n: a\n", "a.yaml: line 1, column 3: a key must be text, not a list, mapping or alias"),
        (
            "a: &x {b: 1}\nc:\n  <<: *x\n",
            "a.yaml: line 3, column 3: merge keys ('<<') are not part of YAML 1.2; expected the keys written out",
        ),
        ("a: &x [1, *x]\n", "a.yaml: line 1, column 11: the alias *x contains itself"),
        ("a: *x\n", "a.yaml: line 1, column 4: the alias *x has no anchor &x before it"),
        ("a: " + "[" * 5000, "a.yaml: line 1, column 104: lists and mappings are nested more than 100 deep"),
        (
            b"\x80\x01" * 9,
            "a.yaml: line 1: the file is not UTF-8 text; found byte 0x80; expected a YAML or JSON file in UTF-8",
        ),
        (b"a: 1\nb: \0", "a.yaml: line 2: the file is not text; found the character U+0000; expected a YAML or JSON "
         "file"),
        ("a: 1".encode("utf-16"), "a.yaml: the file is UTF-16 text; expected UTF-8: save it with that encoding"),
    ],
)  # fmt: skip
def test_yaml_that_is_refused(tmp_path: Path, content: str | bytes, wanted: str) -> None:
    assert message(tmp_path / "a.yaml", content) == wanted


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        ("", "a.json: the file is empty; expected a mapping that starts with `schema:`"),
        ('{"a": 1,\n "a": 2}', "a.json: line 2, column 2: the key 'a' is given twice, in lines 1 and 2; expected each "
         "key once"),
        ('{"a":\n -Infinity}', "a.json: line 2, column 2: -Infinity is not JSON; expected a finite number"),
        ('{"a": 1 "b": 2}', "a.json: line 1, column 9: not valid JSON: Expecting ',' delimiter"),
        ("[" * 500 + "]" * 500, "a.json: line 1, column 102: lists and mappings are nested more than 100 deep"),
        ("[" * 90000 + "]" * 90000, "a.json: lists and mappings are nested too deep"),
        ('{"a": ' + "9" * 5000 + "}", "a.json: a number has thousands of digits"),
    ],
)  # fmt: skip
def test_json_that_is_refused(tmp_path: Path, content: str, wanted: str) -> None:
    assert message(tmp_path / "a.json", content) == wanted


def test_json_with_tabs_escapes_and_places(tmp_path: Path) -> None:
    path = tmp_path / "a.JSON"
    path.write_text('{\n\t"a": {"b,{": [1, -2.5e3, true, null, "\\ud83d\\ude00\\"]"]},\n\t"c": []\n}', encoding="utf-8")
    document = read_document(path)
    assert document.values == {"a": {"b,{": [1, -2500.0, True, None, '😀"]']}, "c": []}
    assert document.place.describe(("a", "b,{", 1)) == "line 2, a.'b,{'[1]"
    place = document.place.at(("a", "b,{", 4))
    assert (place.line, place.column) == (2, 39)


def test_places_in_yaml(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("\ufeffa:\n  - {b: 1}\n  - &x\n    b: 2\nc: *x\n", encoding="utf-8")
    document = read_document(path)
    assert document.values == {"a": [{"b": 1}, {"b": 2}], "c": {"b": 2}}
    assert document.place.describe(("a", 1, "b")) == "line 4, a[1].b"
    assert document.place.describe(("c",)) == "line 5, c"
    assert document.place.describe(("c", "b")) == "line 4, c.b", "the inside of an alias stands at its anchor"
    assert document.place.describe(("a", 0, "missing")) == "line 2, a[0].missing"


def test_files_that_are_not_there(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text("a: 1")
    for name, wanted in [
        ("part.yml", "there is no such file; expected one of part.yaml"),
        ("other.yaml", "there is no such file"),
    ]:
        with pytest.raises(FileFormatError) as caught:
            read_document(tmp_path / name)
        assert str(caught.value) == f"{tmp_path / name}: {wanted}"
    with pytest.raises(FileFormatError, match="this is a folder; expected a file"):
        read_document(tmp_path)
    with pytest.raises(FileFormatError, match=r"expected an existing folder: '.*nowhere' is not there"):
        read_document(tmp_path / "nowhere" / "a.yaml")
    with pytest.raises(FileFormatError, match="cannot be read: embedded null byte"):
        read_document("a\0.yaml")


def test_a_file_that_may_not_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "read_bytes", refuse)
    with pytest.raises(FileFormatError, match=r"a\.yaml: the file may not be read \(permission denied\)"):
        read_document(tmp_path / "a.yaml")


def test_an_alias_bomb_is_refused_at_once(tmp_path: Path) -> None:
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    start = time.perf_counter()
    text = message(tmp_path / "a.yaml", "\n".join(lines))
    assert text == "a.yaml: line 6, column 5: with its aliases written out this has more than 1000000 values"
    assert time.perf_counter() - start < 1


def test_aliases_of_usual_size_share_their_value(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("a: &x [0, 0, 1]\nb: *x\n")
    values = read_document(path).values
    assert values["a"] is values["b"]


def test_the_slow_parser_reads_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("a: [1e-3, {b: 'x', c: }]\nd: &x !!str 1\ne: *x\nf: |\n  text\n")
    fast = read_document(path)
    monkeypatch.setattr(yaml_reader, "_LOADER", yaml.SafeLoader)
    slow = read_document(path)
    assert fast == slow
    assert slow.values == {"a": [1e-3, {"b": "x", "c": None}], "d": "1", "e": "1", "f": "text\n"}

"""Broken STL files: each says what is broken, and whole ones pass, however they are written."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import FileFormatError
from fixture_design.geometry.mesh_file import read_mesh
from fixture_design.geometry.stl_check import stl_problem
from tests.geometry.parts import SHARED

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype="<f4")
TETRAHEDRON = CORNERS[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]]


def binary(count: int = 4, head: bytes = b"") -> bytes:
    triangles = b"".join(struct.pack("<12fH", 0, 0, 0, *corners.ravel(), 0) for corners in TETRAHEDRON)
    return head.ljust(80, b" ") + struct.pack("<I", count) + triangles


def text() -> str:
    facets = [
        "facet normal 0 0 0\n outer loop\n"
        + "".join(f"  vertex {x:g} {y:g} {z:g}\n" for x, y, z in corners)
        + " endloop\nendfacet\n"
        for corners in TETRAHEDRON
    ]
    return f"solid t\n{''.join(facets)}endsolid t\n"


NOISE = np.random.default_rng(7).bytes(3000)
UNFINISHED = text().removesuffix("endsolid t\n")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ["the STL file is empty"]),
        (b" \n\n", ["not STL", "nothing but blanks"]),
        (UNFINISHED, ["cut off", "`endsolid`", "4 whole facets", "'endfacet'"]),
        (text()[:250], ["cut off", "`endsolid`", "2 whole facets", "'vertex'"]),
        (text() + UNFINISHED, ["cut off", "8 whole facets"]),  # of which a reader would give four
        (text().replace("vertex 1 0 0", "vertex 1 x 0"), ["cannot be read as STL", "line 6: 'vertex 1 x 0'"]),
        (binary()[:200], ["cut off", "200 bytes", "2.32 triangles", "expected 284 bytes for the 4 triangles"]),
        (binary(head=b"solid t")[:200], ["cut off", "200 bytes", "expected 284 bytes"]),
        (binary()[:100], ["cut off", "100 bytes", "expected 284 bytes"]),
        (binary() + b"more", ["too long", "288 bytes", "expected 284 bytes for the 4 triangles"]),
        (binary(count=3), ["too long", "4 triangles", "for the 3 triangles"]),
        (binary(count=2**32 - 1), ["cut off", "for the 4294967295 triangles"]),
        (binary()[:60], ["not STL", "blanks"]),
        (b"\0" * 60, ["not STL", "60 bytes", "header of 84 bytes"]),
        (NOISE, ["not STL", "no coordinates"]),
        ("<!doctype html><html>404</html>", ["not STL", "'<!doctype html>"]),
    ],
)
def test_what_is_broken(tmp_path: Path, content: bytes | str, words: list[str]) -> None:
    file = tmp_path / "part.stl"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(FileFormatError) as caught:
        read_mesh(file)
    for word in ["part.stl", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "content",
    [
        binary(),
        binary(head=b"solid t"),
        text(),
        text().upper(),
        text().replace("\n", "\r\n"),
        "\n\n" + text() + "\n\n",
        "\ufeff" + text(),
        text().removesuffix("\n"),
        text() + "; " * 100_000,
    ],
)
def test_whole_files_pass(tmp_path: Path, content: bytes | str) -> None:
    file = tmp_path / "part.STL"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    assert stl_problem(file) is None
    assert len(read_mesh(file).triangles) == 4


def test_real_files_pass() -> None:
    files = [file for file in SHARED.rglob("*") if file.suffix.lower() == ".stl"]
    if not files:
        pytest.skip("no shared data beside the repository")
    assert [file for file in files if stl_problem(file)] == []

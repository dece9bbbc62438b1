"""What is wrong with a file that should be STL: empty, cut off, of the wrong length, or something else altogether.

Its reader finds no triangles in any of these, and stops without a word at a solid that has no end.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

#: A binary file: 80 bytes of anything and the number of triangles; then for each its normal, its corners, 2 bytes more.
_HEADER, _TRIANGLE = 84, 50

#: Bytes that are looked at to tell text from binary; a count of triangles and coordinates have zero bytes.
_LOOK = 1024
#: Bytes at the end of a text file that should have its `endsolid`.
_TAIL = 65536

#: Coordinates of parts, in any unit, are within these; random bytes are not.
_PLAUSIBLE_COORDINATES = (1e-20, 1e12)

_WORDS_BEFORE_NUMBERS = {"facet": 2, "vertex": 1}
_KEYWORDS = {"solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid", "color"}


@dataclass(frozen=True)
class StlProblem:
    """What is wrong, what was found and what should be there, as in `InputError`."""

    problem: str
    found: str | None
    expected: str | None


def stl_problem(file: Path) -> StlProblem | None:
    """Why the file cannot be a whole STL file; None if its ends look right, whatever is between them."""
    size = file.stat().st_size
    if not size:
        return StlProblem("the STL file is empty", "0 bytes", "a closed triangle mesh")
    with file.open("rb") as opened:
        head = opened.read(_LOOK)
        opened.seek(max(0, size - _TAIL))
        tail = opened.read().lower()
    if size == _whole(head):
        return None
    if b"\0" not in head:
        whole = tail.rfind(b"endsolid") > tail.rfind(b"endfacet")
        return None if whole else _text_problem(file)
    return _binary_problem(head, size)


def faulty_line(file: Path) -> str | None:
    """The first line of a text STL file that is none: "line 7: 'vertex 1 2'"; None if there is no such line."""
    for number, line in enumerate(_lines(file), start=1):
        words = line.lower().split()
        before = _WORDS_BEFORE_NUMBERS.get(words[0]) if words else None
        named = words[0] in ("solid", "endsolid") if words else True
        wrong = not named and (words[0] not in _KEYWORDS or (before and not _three_numbers(words[before:])))
        if wrong:
            return f"line {number}: {line.strip()!r:.60}"
    return None


def _text_problem(file: Path) -> StlProblem | None:
    text = "\n".join(_lines(file)).lower()
    if text.rfind("endsolid") > text.rfind("endfacet"):
        return None
    if "solid" not in text or "facet" not in text:
        start = text.strip()[:30]
        found = f"text that starts with {start!r}, and no facet" if start else "nothing but blanks"
        return StlProblem("the file is not STL", found, "`solid` and facets, or a binary STL file")
    last = text.rstrip().rpartition("\n")[2].strip()
    return StlProblem(
        "the STL file is cut off: its last solid has no `endsolid`",
        f"{text.count('endfacet')} whole facets, at the end {last!r:.60}",
        "the whole file",
    )


def _whole(head: bytes) -> int:
    """Bytes of a binary file that has as many triangles as its header counts."""
    return _HEADER + _TRIANGLE * int.from_bytes(head[_HEADER - 4 : _HEADER], "little")


def _binary_problem(head: bytes, size: int) -> StlProblem:
    if size < _HEADER:
        return StlProblem("the file is not STL", f"{size} bytes", f"a header of {_HEADER} bytes, then triangles")
    wanted = _whole(head)
    if not _plausible(head):
        return StlProblem("the file is not STL", "bytes that are no coordinates", "an STL file, text or binary")
    there = (size - _HEADER) / _TRIANGLE
    return StlProblem(
        f"the binary STL file is {'cut off' if size < wanted else 'too long'}: its length does not fit its header",
        f"{size} bytes, which is {there:.6g} triangles",
        f"{wanted} bytes for the {(wanted - _HEADER) // _TRIANGLE} triangles that the header counts",
    )


def _plausible(head: bytes) -> bool:
    """Whether the first triangle has coordinates; a file that ends before is given the benefit of the doubt."""
    if len(head) < _HEADER + _TRIANGLE:
        return True
    sizes = np.abs(np.frombuffer(head, "<f4", 12, _HEADER))
    low, high = _PLAUSIBLE_COORDINATES
    return bool(((sizes == 0) | ((sizes > low) & (sizes < high))).all())


def _lines(file: Path) -> list[str]:
    return file.read_text(encoding="utf-8", errors="replace").splitlines()


def _three_numbers(words: list[str]) -> bool:
    try:
        return len([float(word) for word in words]) == 3
    except ValueError:
        return False

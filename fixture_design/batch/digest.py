"""What exactly a record is about: a hash of the layout's text and of every file that it names."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from stat import S_ISREG
from typing import Any

from fixture_design.batch.item import Item
from fixture_design.batch.reading import values_of
from fixture_design.errors import InputError
from fixture_design.geometry.input_files import files_named_in

#: Files whose hashes are kept; a library of layouts names the same few again and again.
_KEPT = 4096
#: Keys whose values are names of files, as they stand in a layout's text: without one no file is looked for.
_FILE_KEYS = (b"urdf", b"mesh", b"step", b"path")


def text_hash(item: Item) -> str:
    """SHA-256 of an item's text and its variant's number: known without reading what the text says."""
    return _of_text(item).hexdigest()


def _of_text(item: Item) -> Any:
    digest = hashlib.sha256(b"" if item.text is None else item.text)
    if item.variant is not None:
        digest.update(b"\0variant %d" % item.variant)
    return digest


def input_hash(item: Item) -> str:
    """SHA-256 of an item's text, its variant's number, and the files it names with their meshes."""
    digest = _of_text(item)
    if item.text is not None and any(key in item.text for key in _FILE_KEYS):
        for file in files_named(values_of(item), Path(item.source).parent):
            digest.update(b"\0" + file_hash(file).encode())
    return digest.hexdigest()


def files_named(values: Mapping[str, Any], folder: Path) -> Iterator[Path]:
    """The files that a layout's plain values name, whatever else is wrong with them."""
    part = values.get("part")
    named = [(part, key) for key in ("urdf", "mesh", "step")]
    for key, inside in (("bodies", "urdf"), ("loads", "path")):
        entries = values.get(key)
        named += [(entry, inside) for entry in (entries if isinstance(entries, list) else [])]
    for owner, key in named:
        name = owner.get(key) if isinstance(owner, dict) else None
        if isinstance(name, str):
            yield folder / name


def file_hash(file: Path) -> str:
    """SHA-256 of a file and of the meshes and buffers that it names; "missing" if one is none, or cannot be read."""
    digest = hashlib.sha256()
    try:
        meshes = _named_in(file, _version(file))
        buffers = [buffer for mesh in meshes for buffer in _named_in(mesh, _version(mesh))]
        for part in dict.fromkeys([file, *meshes, *buffers]):
            digest.update(_digest_of(part, _version(part)))
    except (OSError, ValueError, InputError):  # verifying the layout says what is wrong with it
        return "missing"
    return digest.hexdigest()


#: What tells one version of a file from another: times of change, size, place on the disk.
Version = tuple[int, int, int, int]


def _version(file: Path) -> Version:
    status = file.stat()
    if not S_ISREG(status.st_mode):  # a pipe would be waited for
        raise FileNotFoundError(str(file))
    return status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino


@lru_cache(maxsize=_KEPT)
def _named_in(file: Path, version: Version) -> tuple[Path, ...]:
    """``version`` makes a changed file another entry of the cache; each file has its own, a mesh changes alone."""
    return files_named_in(file)


@lru_cache(maxsize=_KEPT)
def _digest_of(file: Path, version: Version) -> bytes:
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").digest()

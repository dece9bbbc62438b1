"""Layout files: read into a `Layout`, written so that they read back the same."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fixture_design.io.documents import Document, read_document
from fixture_design.io.json_writer import json_text
from fixture_design.io.layout_places import layout_places
from fixture_design.io.layout_reading import layout_from_record
from fixture_design.io.layout_rules import layout_problems
from fixture_design.io.layout_writing import layout_data
from fixture_design.io.places import Place
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import content_error
from fixture_design.io.records import LayoutRecord
from fixture_design.io.schema_key import require_schema
from fixture_design.io.text_file import write_new_text, write_text
from fixture_design.io.yaml_writer import yaml_text
from fixture_design.layout import Layout


def read_layout(path: str | Path) -> Layout:
    """The layout in a YAML or JSON file, in metres; files it names are absolute paths, which need not exist.

    Raises:
        FileFormatError: the file cannot be read, does not parse or is not a layout. The message tells file, line, key
            path, what was found and what was expected, for the first problem, and counts the others.
    """
    return _layout(read_document(path), Path(path))


def layout_from_data(values: Mapping[str, object], source: str | Path, places: Place | None = None) -> Layout:
    """The layout that a mapping describes, as `read_layout` would read it from ``source`` (which need not exist)."""
    return _layout(Document(dict(values), str(source), places or Place()), Path(source))


def write_layout(layout: Layout, path: str | Path) -> None:
    """Writes a layout as YAML (or JSON, by the suffix), in metres, with file names relative to the new file.

    Reading the file gives the same layout, every number to the last bit, but for the name of its source and places in
    it, `units`, which are m now, and rotations that no short angles give: those agree within rounding (1e-15).

    The file is replaced at once: whoever reads it sees the old layout or the new one.

    Raises:
        FileFormatError: the layout could not be read back (a name with '#', a number that is not finite), or the file
            cannot be written.
        UnsupportedError: it has contacts that were measured on a surface, which a file cannot state.
    """
    path = Path(path)
    write_text(path, _text(layout, path))


def write_new_layout(layout: Layout, path: Path) -> None:
    """The same into a file that is made for it.

    Raises:
        FileExistsError: there is one by now, which stays as it is.
        FileFormatError, UnsupportedError: as `write_layout`.
    """
    write_new_text(path, _text(layout, path))


def _text(layout: Layout, path: Path) -> str:
    data = layout_data(layout, path.parent)
    layout_from_data(data, path)
    return json_text(data) if path.suffix.lower() == ".json" else yaml_text(data)


def layout_text(layout: Layout, folder: Path) -> str:
    """The YAML text of a layout, as a file in ``folder`` would have it."""
    return yaml_text(layout_data(layout, folder))


def _layout(document: Document, path: Path) -> Layout:
    require_schema(document, "layout")
    record = validated(LayoutRecord, document)
    if problems := list(layout_problems(record)):
        raise content_error(problems, document)
    return layout_from_record(record, path.stem, path, path.parent, layout_places(record, document.place))

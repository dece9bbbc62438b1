"""Small layouts as lines, and what looks at them in tests."""

import json
import os
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from fixture_design.batch.item import Entry, Item
from fixture_design.batch.worker import Known, Look

LAYOUT = "fixture_design/layout/1"
LOCATORS = [
    {"name": "P2", "role": "locator", "point": [-1, 0], "normal": [0, -1]},
    {"name": "P3", "role": "locator", "point": [1, 0], "normal": [0, -1]},
    {"name": "P4", "role": "locator", "point": [-2, 0.5], "normal": [-1, 0]},
]


def planar(name: str | None = None, **keys: object) -> dict[str, object]:
    """Three locators that locate and let go."""
    named = {} if name is None else {"name": name}
    return {"schema": LAYOUT, **named, "space": "planar", "contacts": LOCATORS, **keys}


HOLDS = {"locators": ["deterministic", "strongly_accessible"]}
FAILS = {"all": ["form_closure"]}


def lines(path: Path, layouts: Sequence[object]) -> Path:
    """A .jsonl of layouts; what is text already stays."""
    texts = [layout if isinstance(layout, str) else json.dumps(layout) for layout in layouts]
    path.write_text("".join(text + "\n" for text in texts))
    return path


def deadly(folder: str) -> Look:
    """Looks that die or hang on items whose text says so; "once" only the first time (``folder`` remembers)."""

    def look(items: Sequence[Item]) -> Iterator[Known]:
        for place, item in enumerate(items):
            text = (item.text or b"").decode()
            if text == "abort" or (text == "once" and _first(Path(folder, item.source))):
                os.abort()
            if text == "hang":
                time.sleep(60)
            yield [(place, Entry(f"{item.source} {text}\n".encode(), "yes"))]

    return look


def _first(path: Path) -> bool:
    if path.exists():
        return False
    path.touch()
    return True

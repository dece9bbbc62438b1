"""Makes the README's picture of a session: `python -m tests.viewing.session_picture` from the repository's folder."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import fixture_design as fd
from fixture_design.io.text_file import write_bytes
from tests.viewing.browser import browser

BRACKET = Path("urdf") / "bracket" / "bracket.layout.yaml"
PICTURE = BRACKET.parent / "session.png"
#: Of the picture [pixels].
WIDTH, HEIGHT = 1280, 760
#: Until everything that was asked for is drawn [s].
DRAWN = 3.0


def picture() -> bytes:
    """The bracket's session after an element was slid: what a person sees."""
    with tempfile.TemporaryDirectory() as folder, browser() as page:
        session = fd.interactive(BRACKET, out=Path(folder) / "bracket.yaml")
        assert session.address is not None
        page.send("Emulation.setDeviceMetricsOverride", width=WIDTH, height=HEIGHT, deviceScaleFactor=1, mobile=False)
        page.open(session.address, "document.querySelectorAll('.dg li.function').length > 0")
        session.slide(0.004, 0.003)
        time.sleep(DRAWN)
        found = page.png()
        page.open("about:blank")
        session.save()
        session.stop()
    return found


if __name__ == "__main__":
    write_bytes(PICTURE, picture())
    print(PICTURE)

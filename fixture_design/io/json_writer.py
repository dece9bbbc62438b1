"""Plain values as JSON text."""

from __future__ import annotations

import json
from collections.abc import Mapping


def json_text(data: Mapping[str, object]) -> str:
    """JSON over several lines, for files that people may read; NaN and infinity raise ValueError."""
    return json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def dumps(data: object) -> str:
    """JSON in one line, as JSON Lines and pipes want it; NaN and infinity raise ValueError."""
    return json.dumps(data, allow_nan=False, ensure_ascii=False)

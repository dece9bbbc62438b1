"""Style sheets and scripts that pages bring along."""

from __future__ import annotations

from importlib.resources import files


def page_file(name: str) -> str:
    return files("fixture_design.viewing").joinpath("page", name).read_text(encoding="utf-8")

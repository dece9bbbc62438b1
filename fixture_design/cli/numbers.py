"""Numbers in one argument: 0,1,0.5."""

from __future__ import annotations

from fixture_design.errors import InputError


def numbers(text: str | None, option: str) -> list[float] | None:
    """The numbers of an option; None where it was not given.

    Raises:
        InputError: something that is no number.
    """
    if text is None:
        return None
    try:
        return [float(number) for number in text.strip("[] ").replace(",", " ").split()]
    except ValueError as cause:
        raise InputError(f"{option} takes numbers", found=text, expected=f"{option} 0,1,0.5") from cause

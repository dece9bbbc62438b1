"""Messages: what, where, found, expected; lengths as people write them."""

import pytest

from fixture_design.errors import InputError, OffSurfaceError, UnknownNameError, format_length, looking_at


@pytest.mark.parametrize(
    ("metres", "text"),
    [(1.2, "1.2 m"), (0.0042, "4.2 mm"), (3.5e-7, "0.35 um"), (0.000999999, "1 mm"), (-0.02, "-20 mm"), (0.0, "0 um")],
)
def test_lengths(metres: float, text: str) -> None:
    assert format_length(metres) == text


def test_a_message_names_everything_it_knows() -> None:
    error = InputError("odd role", source="a.yaml", place="line 3", found="'x'", expected="a role")
    assert str(error) == "a.yaml: line 3: odd role; found 'x'; expected a role"
    assert str(InputError("odd").within("b.yaml")) == "b.yaml: odd"
    assert str(InputError("odd", source="a.yaml").within("b.yaml")) == "a.yaml: odd"


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (InputError("odd"), "a.yaml: line 5, part: odd"),
        (InputError("odd", place="element 'L1'"), "a.yaml: line 5, part: element 'L1': odd"),
        (InputError("odd", source="a.yaml"), "a.yaml: line 5, part: odd"),
        (InputError("odd", source="b.stl", expected="b"), "b.stl: odd; expected b; named at line 5, part"),
    ],
)
def test_what_goes_wrong_while_looking_at_a_place_knows_it(error: InputError, text: str) -> None:
    with pytest.raises(InputError) as caught, looking_at("a.yaml", "line 5, part"):
        raise error
    assert str(caught.value) == text
    with pytest.raises(InputError) as caught, looking_at(None, None):
        raise InputError("odd")
    assert str(caught.value) == "odd"


def test_unknown_names_list_the_known_ones() -> None:
    assert "did you mean 'clamp'? there are: clamp, locator" in str(
        UnknownNameError("role", "clmp", ["locator", "clamp"])
    )
    assert "there are: none" in str(UnknownNameError("role", "x", []))


def test_off_surface() -> None:
    text = str(OffSurfaceError("L3", "bracket", 0.0042, "facet 12", 1e-5))
    assert text == (
        "element 'L3' is 4.2 mm off the surface of 'bracket'; nearest: facet 12; "
        "move it there, or raise `surface_gap` (10 um)"
    )

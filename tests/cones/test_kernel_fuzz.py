"""Entry points of the kernel with whatever may come: an answer or an exception of ours, never a crash or a hang."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones import kernel
from fixture_design.cones.kernel.choice import compiled
from fixture_design.errors import ConeError, DimensionError, KernelError

NOTHING = np.zeros((0, 3))


def _one_by_one(rows: np.ndarray) -> kernel.DoubleDescription:
    state = kernel.DoubleDescription.whole_space(rows.shape[1], 1e-9)
    for row in rows:
        state = state.add_row(row)
    return state


ENTRIES: dict[str, Callable[[np.ndarray], object]] = {
    "double_description": lambda rows: kernel.double_description(rows, rows[:0], 1e-9, 2000),
    "equalities": lambda rows: kernel.double_description(rows[:0], rows, 1e-9, 2000),
    "add_row": _one_by_one,
    "tucker_partition": lambda rows: kernel.tucker_partition(rows, 1e-9),
    "minimum_norm_point": kernel.minimum_norm_point,
    "nonnegative_least_squares": lambda rows: kernel.nonnegative_least_squares(rows.T, rows.sum(axis=0)),
    "closure_test": kernel.closure_test,
    "closure_tests": lambda rows: kernel.closure_tests(rows, np.array([0, len(rows)]), witnesses=True),
    "membership_test": lambda rows: kernel.membership_test(np.eye(rows.shape[1])[0], rows),
    "exact_closure_signs": lambda rows: kernel.exact_closure_signs(rows, np.array([0, len(rows)])),
    "exact_faces": lambda rows: kernel.exact_faces(rows, dimension=rows.shape[1], most=2000),
}


@st.composite
def odd_rows(draw: st.DrawFn) -> np.ndarray:
    """Rows in R^1 to R^9: unit ones, with zeros, NaN, infinities, huge ratios, odd memory layouts mixed in."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    d, count = draw(st.integers(1, 9)), draw(st.integers(0, 10))
    rows = rng.normal(size=(count, d))
    if draw(st.booleans()):
        rows = np.round(rows)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = rows / np.where(lengths > 0, lengths, 1.0)
    for change in draw(
        st.lists(st.sampled_from(["nan", "inf", "huge", "tiny", "zero", "subnormal", "same"]), max_size=2)
    ):
        if not rows.size:
            break
        k = int(rng.integers(count))
        values = {"nan": np.nan, "inf": -np.inf, "huge": 1e300, "tiny": 1e-300, "zero": 0.0, "subnormal": 5e-324}
        rows[k] = rows[0] if change == "same" else values[change]
    layout = draw(st.sampled_from(["C", "F", "strided", "reversed", "read-only"]))
    if layout == "F":
        return np.asfortranarray(rows)
    if layout == "strided":
        return np.repeat(np.repeat(rows, 2, axis=0), 3, axis=1)[::2, ::3]
    if layout == "reversed":
        return rows[::-1, ::-1]
    if layout == "read-only":
        rows.flags.writeable = False
    return rows


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@given(rows=odd_rows())
def test_an_answer_or_an_error_of_ours(entry: str, rows: np.ndarray):
    try:
        ENTRIES[entry](rows)
    except (ConeError, DimensionError):
        return
    assert np.isfinite(rows).all()


def _facts(entry: str, rows: np.ndarray) -> list[np.ndarray]:
    """What an entry point returned, as arrays of numbers."""
    found = ENTRIES[entry](rows)
    values = found if isinstance(found, tuple) else [getattr(found, name) for name in _fields(found)] or [found]
    return [np.asarray(value, dtype=float) for value in values]


def _fields(found: object) -> list[str]:
    return [name for name in getattr(found, "__dataclass_fields__", {}) if name != "tolerances"]


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("d", [2, 3, 5, 6])
def test_the_memory_layout_does_not_matter(entry: str, d: int):
    rows = np.random.default_rng(d).normal(size=(8, d))
    rows = np.ascontiguousarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))
    expected = _facts(entry, rows)
    wide = np.zeros((16, 3 * d))
    wide[::2, ::3] = rows
    backwards = np.ascontiguousarray(rows[::-1, ::-1])
    for other in (np.asfortranarray(rows), wide[::2, ::3], backwards[::-1, ::-1]):
        for value, same in zip(_facts(entry, other), expected, strict=True):
            assert np.allclose(value, same, rtol=1e-9, atol=1e-12, equal_nan=True)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("entry", sorted(set(ENTRIES) - {"exact_faces", "membership_test"}))
def test_what_is_not_finite_is_an_error(entry: str, bad: float):
    rows = np.eye(3)
    rows[1, 2] = bad
    with pytest.raises(ConeError, match="not finite"):
        ENTRIES[entry](rows)


@pytest.mark.parametrize(
    "entry", ["double_description", "add_row", "tucker_partition", "closure_test", "closure_tests"]
)
def test_rows_that_are_not_unit_are_an_error(entry: str):
    with pytest.raises(ConeError, match=r"row \d has the length 2"):
        ENTRIES[entry](np.diag([1.0, 2.0, 1.0]))


@pytest.mark.parametrize("zero", [0.0, -1.0, 1.0, np.nan, np.inf])
def test_a_zero_that_is_none(zero: float):
    with pytest.raises(ConeError, match="between 0 and 1"):
        kernel.double_description(np.eye(3), NOTHING, zero)
    with pytest.raises(ConeError, match="between 0 and 1"):
        kernel.tucker_partition(np.eye(3), zero)


def test_five_thousand_rows():
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(5000, 6))
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    assert kernel.closure_test(rows).closes
    assert kernel.tucker_partition(rows, 1e-9).closes
    cone = kernel.double_description(rows, np.zeros((0, 6)), 1e-9)
    assert not len(cone.rays)
    assert cone.incidence.shape == (0, 5000)
    half = rows[rows[:, 0] < -0.2]
    assert kernel.closure_test(half).leaves
    point, _ = kernel.minimum_norm_point(half)
    assert (half @ point > 0).all()


@pytest.mark.parametrize("d", range(1, 10))
def test_every_dimension(d: int):
    """The positive orthant: d rays, 2^d faces; above 8 the numpy kernel takes over."""
    cone = kernel.double_description(-np.eye(d), np.zeros((0, d)), 1e-9)
    assert sorted(cone.rays.tolist()) == sorted(np.eye(d).tolist())
    assert len(kernel.faces_of(0, cone.rays, cone.incidence, d)) == 2**d
    exact = kernel.exact_double_description((-np.eye(d)).astype(int).tolist(), dimension=d)
    assert sorted(exact.rays) == sorted(map(tuple, np.eye(d, dtype=int).tolist()))
    closed = np.vstack([np.eye(d), -np.eye(d)])
    assert kernel.closure_test(closed).closes
    assert kernel.closure_test(np.eye(d)).leaves
    flat = kernel.double_description(-np.eye(d), np.eye(d)[:1], 1e-9)
    assert (len(flat.rays), len(flat.lines), flat.ambient) == (d - 1, 0, d - 1)
    line = kernel.double_description(np.eye(d)[:1], np.zeros((0, d)), 1e-9)
    assert (len(line.rays), len(line.lines)) == (1, d - 1)


def test_a_panic_does_not_cross():
    native = compiled(3)
    if native is None:
        pytest.skip("the numpy kernel has no panics")
    with pytest.raises(KernelError, match="on purpose"):
        native.panic_on_purpose()


def test_arguments_of_another_kind():
    native = compiled(3)
    if native is None:
        pytest.skip("of the compiled kernel")
    for bad in (None, "rows", [[1.0]], np.zeros(3), np.zeros((2, 3), dtype=np.float32), np.zeros((2, 3, 1))):
        with pytest.raises(TypeError):
            native.tucker_partition(bad, 1e-9)
    with pytest.raises(ConeError, match=r"R\^1 to R\^8"):
        native.tucker_partition(np.zeros((2, 9)), 1e-9)
    with pytest.raises(ConeError, match="incidence"):
        native.add_row(np.eye(3), NOTHING, np.eye(3), np.zeros((2, 3), dtype=bool), 3, 1e-9, (0.0, 1.0), np.eye(3)[0])
    with pytest.raises(ConeError, match="512 rows"):
        native.double_description(np.zeros((600, 3)), NOTHING, 1e-9, 10)

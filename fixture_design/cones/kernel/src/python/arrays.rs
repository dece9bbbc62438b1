//! Arrays of numbers to rows of R^D and back, with a look at every number.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::guard::cone_error;
use crate::mask::{self, Mask};

pub const MAX_DIMENSION: usize = 8;
/// Sets of rows are at most this large.
pub const MAX_ROWS: usize = 64 * 8;
/// Rows are unit up to this [-]: the zero tests are relative to them.
const UNIT: f64 = 1e-6;

/// Run an expression with the constant `$D` equal to a run-time dimension from 1 to 8.
macro_rules! with_dimension {
    ($py:expr, $dimension:expr, $D:ident => $work:expr) => {
        match $dimension {
            1 => {
                const $D: usize = 1;
                $work
            }
            2 => {
                const $D: usize = 2;
                $work
            }
            3 => {
                const $D: usize = 3;
                $work
            }
            4 => {
                const $D: usize = 4;
                $work
            }
            5 => {
                const $D: usize = 5;
                $work
            }
            6 => {
                const $D: usize = 6;
                $work
            }
            7 => {
                const $D: usize = 7;
                $work
            }
            8 => {
                const $D: usize = 8;
                $work
            }
            other => Err($crate::python::guard::cone_error(
                $py,
                format!("the compiled kernel works in R^1 to R^8, not in R^{other}"),
            )),
        }
    };
}

/// The same with the next larger one of few dimensions, so that what is long to compile is compiled less often: vectors
/// are padded with zeros, and the cone is confined to the space that they leave.
macro_rules! with_padded_dimension {
    ($py:expr, $dimension:expr, $D:ident => $work:expr) => {
        match $dimension {
            1 | 2 => {
                const $D: usize = 2;
                $work
            }
            3 => {
                const $D: usize = 3;
                $work
            }
            4 => {
                const $D: usize = 4;
                $work
            }
            5 | 6 => {
                const $D: usize = 6;
                $work
            }
            7 => {
                const $D: usize = 7;
                $work
            }
            8 => {
                const $D: usize = 8;
                $work
            }
            other => Err($crate::python::guard::cone_error(
                $py,
                format!("the compiled kernel works in R^1 to R^8, not in R^{other}"),
            )),
        }
    };
}

/// Run an expression with the constant `$W` equal to a number of words that holds so many rows.
macro_rules! with_words {
    ($py:expr, $rows:expr, $W:ident => $work:expr) => {
        match $rows {
            0..=64 => {
                const $W: usize = 1;
                $work
            }
            65..=128 => {
                const $W: usize = 2;
                $work
            }
            129..=512 => {
                const $W: usize = 8;
                $work
            }
            other => Err($crate::python::guard::cone_error(
                $py,
                format!("the compiled kernel takes up to 512 rows, not {other}"),
            )),
        }
    };
}

pub(crate) use {with_dimension, with_padded_dimension, with_words};

/// Finite rows of `width` numbers, padded with zeros to D.
pub fn padded_rows<const D: usize>(
    py: Python<'_>,
    array: &PyReadonlyArray2<'_, f64>,
    width: usize,
) -> PyResult<Vec<[f64; D]>> {
    if array.shape()[1] != width {
        let words = format!("rows of {} numbers, where rows of {width} go", array.shape()[1]);
        return Err(cone_error(py, words));
    }
    let rows: Vec<[f64; D]> = match array.as_slice() {
        // contiguous by columns is contiguous too
        Ok(flat) if width == D && array.is_c_contiguous() => {
            flat.chunks_exact(D).map(|row| row.try_into().expect("D numbers")).collect()
        }
        _ => {
            let padded = |k: usize, row: &[f64]| row.get(k).copied().unwrap_or(0.0);
            let rows = array.as_array();
            rows.outer_iter().map(|row| row.to_vec()).map(|row| std::array::from_fn(|k| padded(k, &row))).collect()
        }
    };
    for (index, row) in rows.iter().enumerate() {
        if !row.iter().all(|value| value.is_finite()) {
            return Err(cone_error(py, format!("row {index} is not finite: {row:?}")));
        }
    }
    Ok(rows)
}

/// Finite rows of D numbers.
pub fn rows<const D: usize>(py: Python<'_>, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; D]>> {
    padded_rows(py, array, D)
}

/// Rows of D numbers that are unit, or zero.
pub fn unit_rows<const D: usize>(py: Python<'_>, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; D]>> {
    padded_unit_rows(py, array, D)
}

pub fn padded_unit_rows<const D: usize>(
    py: Python<'_>,
    array: &PyReadonlyArray2<'_, f64>,
    width: usize,
) -> PyResult<Vec<[f64; D]>> {
    let rows = padded_rows::<D>(py, array, width)?;
    require_unit(py, &rows)?;
    Ok(rows)
}

/// Unit rows, or zero ones.
pub fn require_unit<const D: usize>(py: Python<'_>, rows: &[[f64; D]]) -> PyResult<()> {
    for (index, row) in rows.iter().enumerate() {
        let squared: f64 = row.iter().map(|value| value * value).sum();
        if (squared - 1.0).abs() > 2.0 * UNIT && row.iter().any(|&value| value != 0.0) {
            return Err(cone_error(py, format!("row {index} has the length {:e}, not 1", squared.sqrt())));
        }
    }
    Ok(())
}

pub fn vector<const D: usize>(py: Python<'_>, array: &PyReadonlyArray1<'_, f64>) -> PyResult<[f64; D]> {
    padded_vector(py, array, D)
}

pub fn padded_vector<const D: usize>(
    py: Python<'_>,
    array: &PyReadonlyArray1<'_, f64>,
    width: usize,
) -> PyResult<[f64; D]> {
    let mut values: Vec<f64> = array.as_array().iter().copied().collect();
    if values.len() == width {
        values.resize(D, 0.0);
    }
    let known: [f64; D] = values
        .try_into()
        .map_err(|given: Vec<f64>| cone_error(py, format!("a vector of {} numbers, where {D} go", given.len())))?;
    if !known.iter().all(|value| value.is_finite()) {
        return Err(cone_error(py, format!("a vector is not finite: {known:?}")));
    }
    Ok(known)
}

/// A tolerance: positive and below 1.
pub fn tolerance(py: Python<'_>, value: f64) -> PyResult<f64> {
    if value > 0.0 && value < 1.0 {
        return Ok(value);
    }
    Err(cone_error(py, format!("a zero of relative size {value}: it must lie between 0 and 1")))
}

pub fn array1<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, values)
}

pub fn array2<'py, const D: usize>(py: Python<'py>, rows: &[[f64; D]]) -> Bound<'py, PyArray2<f64>> {
    narrow_array2(py, rows, D)
}

/// The first `width` numbers of each row.
pub fn narrow_array2<'py, const D: usize>(
    py: Python<'py>,
    rows: &[[f64; D]],
    width: usize,
) -> Bound<'py, PyArray2<f64>> {
    // SAFETY: a fresh C-contiguous array, filled completely before anybody else sees it
    unsafe {
        let array = PyArray2::new(py, [rows.len(), width], false);
        let flat = array.as_slice_mut().expect("contiguous");
        for (row, place) in rows.iter().zip(flat.chunks_exact_mut(width)) {
            place.copy_from_slice(&row[..width]);
        }
        array
    }
}

/// Unit vectors along the coordinates that padding has added.
pub fn padding<const D: usize>(width: usize) -> impl Iterator<Item = [f64; D]> {
    (width..D).map(|i| std::array::from_fn(|k| f64::from(u8::from(i == k))))
}

/// Row sets as a table of truth values, one row a set.
pub fn incidence<'py, const W: usize>(py: Python<'py>, sets: &[Mask<W>], rows: usize) -> Bound<'py, PyArray2<bool>> {
    // SAFETY: as above
    unsafe {
        let array = PyArray2::new(py, [sets.len(), rows], false);
        let flat = array.as_slice_mut().expect("contiguous");
        for (set, places) in sets.iter().zip(flat.chunks_exact_mut(rows.max(1))) {
            for (row, place) in places.iter_mut().enumerate() {
                *place = mask::has(set, row);
            }
        }
        array
    }
}

pub fn masks<const W: usize>(array: &PyReadonlyArray2<'_, bool>) -> Vec<Mask<W>> {
    let as_mask = |row: numpy::ndarray::ArrayView1<'_, bool>| {
        let mut set = mask::empty();
        for (place, &on) in row.iter().enumerate() {
            if on {
                mask::insert(&mut set, place);
            }
        }
        set
    };
    array.as_array().outer_iter().map(as_mask).collect()
}

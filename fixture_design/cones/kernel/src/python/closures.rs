//! Closure, Tucker's partition and nearest points for Python.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::arrays::{self, array1, array2, tolerance, with_dimension};
use super::guard::{cone_error, guarded};
use crate::batch::{self, Ragged};
use crate::closure::{Sizes, closure as bounds_of};
use crate::{minimum_norm, nonnegative, tucker};

type Array1<'py> = Bound<'py, PyArray1<f64>>;
type Array2<'py> = Bound<'py, PyArray2<f64>>;

/// balanced, weights, span, motion, largest zero, smallest non-zero.
type Partition<'py> = (Bound<'py, PyArray1<bool>>, Array1<'py>, Array2<'py>, Option<Array1<'py>>, f64, f64);

#[pyfunction]
pub fn tucker_partition<'py>(py: Python<'py>, rows: PyReadonlyArray2<'py, f64>, zero: f64) -> PyResult<Partition<'py>> {
    guarded(py, || {
        let zero = tolerance(py, zero)?;
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::unit_rows::<D>(py, &rows)?;
            let found = py.detach(|| tucker::tucker_partition(&rows, zero));
            Ok((
                PyArray1::from_slice(py, &found.balanced),
                array1(py, &found.weights),
                array2(py, &found.span),
                found.motion.map(|motion| array1(py, &motion)),
                found.zero_max,
                found.nonzero_min,
            ))
        })
    })
}

#[pyfunction]
pub fn minimum_norm_point<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<(Array1<'py>, Array1<'py>)> {
    guarded(py, || {
        let count = rows.shape()[0];
        if count == 0 {
            return Err(cone_error(py, "no rows, so no nearest point".to_string()));
        }
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::rows::<D>(py, &rows)?;
            let found = py.detach(|| minimum_norm::minimum_norm_point(&rows));
            let mut weights = vec![0.0; count];
            for (row, weight) in found.weights {
                weights[row] = weight;
            }
            Ok((array1(py, &found.point), array1(py, &weights)))
        })
    })
}

/// x >= 0 that minimises |M x - b|; the columns of M are the cone's rows, so M comes transposed.
#[pyfunction]
pub fn nonnegative_least_squares<'py>(
    py: Python<'py>,
    columns: PyReadonlyArray2<'py, f64>,
    target: PyReadonlyArray1<'py, f64>,
) -> PyResult<Array1<'py>> {
    guarded(py, || {
        let count = columns.shape()[0];
        with_dimension!(py, columns.shape()[1], D => {
            let rows = arrays::rows::<D>(py, &columns)?;
            let target = arrays::vector::<D>(py, &target)?;
            let found = py.detach(|| nonnegative::nonnegative_least_squares(&rows, &target));
            let mut solution = vec![0.0; count];
            for (row, weight) in found.passive {
                solution[row] = weight;
            }
            Ok(array1(py, &solution))
        })
    })
}

/// Bounds on s with weights and motion.
#[pyfunction]
pub fn closure<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
    zero: f64,
    tie: f64,
    near: f64,
) -> PyResult<(f64, f64, Option<Array1<'py>>, Option<Array1<'py>>)> {
    guarded(py, || {
        let sizes = sizes(py, zero, tie, near)?;
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::unit_rows::<D>(py, &rows)?;
            // not worth giving the lock up: it takes microseconds
            let found = bounds_of(&rows, sizes);
            let weights = (!found.weights.is_empty()).then(|| array1(py, &found.weights));
            Ok((found.lower, found.upper, weights, found.motion.map(|motion| array1(py, &motion))))
        })
    })
}

/// Bounds on s of many sets of rows: lower, upper, weights (one a place), motions; the last two None if not asked for.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn closures<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
    indices: Option<PyReadonlyArray1<'py, i64>>,
    offsets: PyReadonlyArray1<'py, i64>,
    zero: f64,
    tie: f64,
    near: f64,
    witnesses: bool,
    threads: usize,
) -> PyResult<(Array1<'py>, Array1<'py>, Option<Array1<'py>>, Option<Array2<'py>>)> {
    guarded(py, || {
        let sizes = sizes(py, zero, tie, near)?;
        let (indices, offsets) = ragged(py, rows.shape()[0], indices, &offsets)?;
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::unit_rows::<D>(py, &rows)?;
            let sets = Ragged { rows: &rows, indices: indices.as_deref(), offsets: &offsets };
            let found = py.detach(|| batch::closures(&sets, sizes, witnesses, threads.min(sets.len().max(1))));
            let weights = witnesses.then(|| array1(py, &found.weights));
            let motions = witnesses.then(|| array1(py, &found.motions).reshape([sets.len(), D])).transpose()?;
            Ok((array1(py, &found.lower), array1(py, &found.upper), weights, motions))
        })
    })
}

/// What is left of a vector a set next to the nearest point of the set's cone, and that point's weights, one a place.
#[pyfunction]
pub fn memberships<'py>(
    py: Python<'py>,
    vectors: PyReadonlyArray2<'py, f64>,
    rows: PyReadonlyArray2<'py, f64>,
    indices: Option<PyReadonlyArray1<'py, i64>>,
    offsets: PyReadonlyArray1<'py, i64>,
    threads: usize,
) -> PyResult<(Array2<'py>, Array1<'py>)> {
    guarded(py, || {
        let (indices, offsets) = ragged(py, rows.shape()[0], indices, &offsets)?;
        if vectors.shape()[0] + 1 != offsets.len() {
            let words = format!("{} vectors for {} sets of rows", vectors.shape()[0], offsets.len() - 1);
            return Err(cone_error(py, words));
        }
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::unit_rows::<D>(py, &rows)?;
            let vectors = arrays::unit_rows::<D>(py, &vectors)?;
            let sets = Ragged { rows: &rows, indices: indices.as_deref(), offsets: &offsets };
            let found = py.detach(|| batch::memberships(&sets, &vectors, threads.min(sets.len().max(1))));
            Ok((array1(py, &found.residuals).reshape([sets.len(), D])?, array1(py, &found.weights)))
        })
    })
}

/// Indices and offsets of sets of rows, looked at.
pub fn ragged(
    py: Python<'_>,
    rows: usize,
    indices: Option<PyReadonlyArray1<'_, i64>>,
    offsets: &PyReadonlyArray1<'_, i64>,
) -> PyResult<(Option<Vec<i64>>, Vec<i64>)> {
    let offsets: Vec<i64> = offsets.as_array().iter().copied().collect();
    let indices: Option<Vec<i64>> = indices.map(|given| given.as_array().iter().copied().collect());
    let places = indices.as_ref().map_or(rows as i64, |given| given.len() as i64);
    if offsets.first() != Some(&0) || !offsets.is_sorted() || offsets.last() != Some(&places) {
        return Err(cone_error(py, format!("offsets must rise from 0 to {places}")));
    }
    if let Some(bad) = indices.iter().flatten().find(|&&row| row < 0 || row >= rows as i64) {
        return Err(cone_error(py, format!("there is no row {bad}; there are {rows}")));
    }
    Ok((indices, offsets))
}

fn sizes(py: Python<'_>, zero: f64, tie: f64, near: f64) -> PyResult<Sizes> {
    if !(zero <= tie && tie <= near) {
        return Err(cone_error(py, format!("zero {zero:e}, tie {tie:e}, near {near:e} do not rise")));
    }
    Ok(Sizes { zero: tolerance(py, zero)?, tie: tolerance(py, tie)?, near: tolerance(py, near)? })
}

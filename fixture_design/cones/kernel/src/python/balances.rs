//! The interior point for loads for Python.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::arrays::{self, array1};
use super::guard::{cone_error, guarded};
use crate::balance::{self, Guesses, Pushes};

type Array1<'py> = Bound<'py, PyArray1<f64>>;
type Array2<'py> = Bound<'py, PyArray2<f64>>;

/// forces, motions, sizes, steps.
type Found<'py> = (Array2<'py>, Array2<'py>, Array1<'py>, Bound<'py, PyArray1<i64>>);

/// The interior point for many loads; `maps` has a row for each column of each cone, `width` rows a cone.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn balance_guesses<'py>(
    py: Python<'py>,
    maps: PyReadonlyArray2<'py, f64>,
    balls: PyReadonlyArray1<'py, bool>,
    fixed: PyReadonlyArray2<'py, f64>,
    loads: PyReadonlyArray2<'py, f64>,
    width: usize,
    seek: bool,
    threads: usize,
) -> PyResult<Found<'py>> {
    guarded(py, || {
        let dimension = loads.shape()[1];
        let balls: Vec<bool> = balls.as_array().iter().copied().collect();
        if maps.shape()[0] != balls.len() * width || fixed.shape()[0] != loads.shape()[0] {
            let (rows, count, fixed, loads) = (maps.shape()[0], balls.len(), fixed.shape()[0], loads.shape()[0]);
            let words =
                format!("{rows} columns for {count} cones of {width}, {fixed} fixed wrenches for {loads} loads");
            return Err(cone_error(py, words));
        }
        // padded with zeros to few sizes, which are long to compile: what padding adds no map reaches
        macro_rules! with_sizes {
            ($R:literal, $K:literal) => {{
                let maps = arrays::padded_rows::<$R>(py, &maps, dimension)?;
                let fixed = arrays::padded_rows::<$R>(py, &fixed, dimension)?;
                let loads = arrays::padded_rows::<$R>(py, &loads, dimension)?;
                let pushes = Pushes { maps: &maps, balls: &balls, seek };
                let threads = threads.min(loads.len().max(1));
                let found: Guesses<$R> =
                    py.detach(|| balance::balance_guesses::<$R, { $R - 1 }, $K>(&pushes, &fixed, &loads, threads));
                Ok((
                    array1(py, &found.forces).reshape([loads.len(), balls.len() * width])?,
                    arrays::narrow_array2(py, &found.motions, dimension),
                    array1(py, &found.sizes),
                    PyArray1::from_slice(py, &found.steps),
                ))
            }};
        }
        match (dimension, width) {
            (1..=3, 2) => with_sizes!(3, 2),
            (1..=6, 3) => with_sizes!(6, 3),
            (1..=7, 4) => with_sizes!(7, 4),
            _ => Err(cone_error(
                py,
                format!(
                    "cones of {width} numbers in R^{dimension}: 2 in R^1 to R^3, 3 in R^1 to R^6, 4 in R^1 to R^7 go"
                ),
            )),
        }
    })
}

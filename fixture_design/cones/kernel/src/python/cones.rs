//! Double description and faces for Python.

use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::arrays::{self, incidence, masks, narrow_array2, tolerance, with_padded_dimension, with_words};
use super::guard::{Signals, cone_error, guarded};
use crate::double_description::{self as dd, DoubleDescription, Stopped};
use crate::faces::faces as all_faces;

/// lines, rays, incidence, dimension that the equalities leave, largest zero, smallest non-zero.
type Forms<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<bool>>, usize, f64, f64);

/// Both forms of {x : rows . x <= 0, equalities . x = 0}.
#[pyfunction]
pub fn double_description<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
    equalities: PyReadonlyArray2<'py, f64>,
    zero: f64,
    max_rays: usize,
) -> PyResult<Forms<'py>> {
    guarded(py, || {
        let zero = tolerance(py, zero)?;
        let width = rows.shape()[1];
        with_padded_dimension!(py, width, D => with_words!(py, rows.shape()[0], W => {
            let mut both_ways = arrays::padded_unit_rows::<D>(py, &equalities, width)?;
            both_ways.splice(..0, arrays::padding(width));
            let rows = arrays::padded_unit_rows::<D>(py, &rows, width)?;
            let signals = Signals::new();
            let found = py.detach(|| convert::<D, W>(rows, &both_ways, zero, max_rays, &|| signals.stop()));
            let found = found.map_err(|stopped| explained(py, stopped, max_rays, signals))?;
            Ok(forms(py, &found, width))
        }))
    })
}

/// The cone cut by one row more: one step from a state that a caller has kept.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn add_row<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
    lines: PyReadonlyArray2<'py, f64>,
    rays: PyReadonlyArray2<'py, f64>,
    on: PyReadonlyArray2<'py, bool>,
    ambient: usize,
    zero: f64,
    seen: (f64, f64),
    row: PyReadonlyArray1<'py, f64>,
) -> PyResult<Forms<'py>> {
    guarded(py, || {
        let zero = tolerance(py, zero)?;
        let (count, dimension) = (rows.shape()[0], rows.shape()[1]);
        if on.shape() != [rays.shape()[0], count] {
            return Err(cone_error(py, format!("incidence of shape {:?} does not fit rays and rows", on.shape())));
        }
        if ambient > dimension || lines.shape()[0] > ambient {
            return Err(cone_error(py, format!("{} lines in R^{ambient} of R^{dimension}", lines.shape()[0])));
        }
        with_padded_dimension!(py, dimension, D => with_words!(py, count + 1, W => {
            let mut all = arrays::padded_rows::<D>(py, &rows, dimension)?;
            let row = arrays::padded_vector(py, &row, dimension)?;
            arrays::require_unit(py, &[row])?;
            all.push(row);
            let mut cone = DoubleDescription::<D, W> {
                rows: all,
                lines: arrays::padded_rows(py, &lines, dimension)?,
                rays: arrays::padded_rows(py, &rays, dimension)?,
                active: masks(&on),
                zero,
                ambient,
                zero_max: seen.0,
                nonzero_min: seen.1,
            };
            let signals = Signals::new();
            let done = py.detach(|| cone.add_last_row(&|| signals.stop()));
            done.map_err(|stopped| explained(py, stopped, usize::MAX, signals))?;
            Ok(forms(py, &cone, dimension))
        }))
    })
}

/// All faces of a converted cone: which rows vanish on each, and a motion of its relative interior.
#[pyfunction]
pub fn faces<'py>(
    py: Python<'py>,
    lines: usize,
    rays: PyReadonlyArray2<'py, f64>,
    on: PyReadonlyArray2<'py, bool>,
    ambient: usize,
    most: usize,
) -> PyResult<(Bound<'py, PyArray2<bool>>, Bound<'py, PyArray2<f64>>)> {
    guarded(py, || {
        let (count, dimension) = (on.shape()[1], rays.shape()[1]);
        if on.shape()[0] != rays.shape()[0] {
            return Err(cone_error(py, format!("incidence of shape {:?} does not fit the rays", on.shape())));
        }
        if ambient > dimension || lines > ambient {
            return Err(cone_error(py, format!("{lines} lines in R^{ambient} of R^{dimension}")));
        }
        with_padded_dimension!(py, dimension, D => with_words!(py, count, W => {
            let cone = DoubleDescription::<D, W> {
                rows: vec![[0.0; D]; count],
                lines: vec![[0.0; D]; lines],
                rays: arrays::padded_rows(py, &rays, dimension)?,
                active: masks(&on),
                ambient,
                ..DoubleDescription::whole_space(0.0)
            };
            let Some(found) = py.detach(|| all_faces(&cone, most)) else {
                return Err(cone_error(py, format!("the cone has more than {most} faces")));
            };
            let sets: Vec<_> = found.iter().map(|face| face.rows).collect();
            let witnesses: Vec<_> = found.iter().map(|face| face.witness).collect();
            Ok((incidence(py, &sets, count), narrow_array2(py, &witnesses, dimension)))
        }))
    })
}

fn forms<'py, const D: usize, const W: usize>(
    py: Python<'py>,
    cone: &DoubleDescription<D, W>,
    width: usize,
) -> Forms<'py> {
    let on = incidence(py, &cone.active, cone.rows.len());
    let (lines, rays) = (narrow_array2(py, &cone.lines, width), narrow_array2(py, &cone.rays, width));
    (lines, rays, on, cone.ambient, cone.zero_max, cone.nonzero_min)
}

fn explained(py: Python<'_>, stopped: Stopped, max_rays: usize, signals: Signals) -> PyErr {
    match stopped {
        Stopped::Interrupted => signals.raised(),
        Stopped::TooManyRays { rows } => {
            cone_error(py, format!("the cone has more than {max_rays} extreme rays after {rows} face vectors"))
        }
    }
}

/// With wider registers and hardware bit counts where the processor has them; the same results, since nothing is fused.
fn convert<const D: usize, const W: usize>(
    rows: Vec<[f64; D]>,
    equalities: &[[f64; D]],
    zero: f64,
    max_rays: usize,
    stop: &dyn Fn() -> bool,
) -> Result<DoubleDescription<D, W>, Stopped> {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn wide<const D: usize, const W: usize>(
            rows: Vec<[f64; D]>,
            equalities: &[[f64; D]],
            zero: f64,
            max_rays: usize,
            stop: &dyn Fn() -> bool,
        ) -> Result<DoubleDescription<D, W>, Stopped> {
            dd::double_description(rows, equalities, zero, max_rays, stop)
        }
        if wide_registers() {
            // SAFETY: the processor has what the function is compiled for
            return unsafe { wide(rows, equalities, zero, max_rays, stop) };
        }
    }
    dd::double_description(rows, equalities, zero, max_rays, stop)
}

#[cfg(target_arch = "x86_64")]
fn wide_registers() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

//! Exact arithmetic for Python: integers of any length in and out.

use dashu_int::IBig;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyInt, PyList};

use super::arrays::{self, incidence, with_dimension, with_padded_dimension, with_words};
use super::closures::ragged;
use super::guard::{Signals, cone_error, guarded};
use crate::batch::{self, Ragged};
use crate::double_description::Stopped;
use crate::exact::integer::make_primitive;
use crate::exact::{double_description as dd, tucker};

type Rows<'py> = Bound<'py, PyList>;

/// lines, rays, incidence, dimension that the equalities leave.
type Forms<'py> = (Rows<'py>, Rows<'py>, Bound<'py, PyArray2<bool>>, usize);

/// Both forms of {x : rows . x <= 0, equalities . x = 0} for rows of Python integers.
#[pyfunction]
pub fn exact_double_description<'py>(
    py: Python<'py>,
    rows: Vec<Vec<Bound<'py, PyAny>>>,
    equalities: Vec<Vec<Bound<'py, PyAny>>>,
    dimension: usize,
    max_rays: usize,
) -> PyResult<Forms<'py>> {
    guarded(py, || {
        with_padded_dimension!(py, dimension, D => with_words!(py, rows.len(), W => {
            let rows = integers::<D>(py, &rows, dimension)?;
            let mut equalities = integers::<D>(py, &equalities, dimension)?;
            equalities.splice(..0, arrays::padding::<D>(dimension).map(|axis| axis.map(|v| IBig::from(v as i8))));
            let signals = Signals::new();
            let found = py.detach(|| dd::double_description::<D, W>(&rows, &equalities, max_rays, &|| signals.stop()));
            let found = match found {
                Ok(found) => found,
                Err(Stopped::Interrupted) => return Err(signals.raised()),
                Err(Stopped::TooManyRays { rows }) => {
                    let words = format!("the cone has more than {max_rays} extreme rays after {rows} face vectors");
                    return Err(cone_error(py, words));
                }
            };
            let on = incidence(py, &found.active, rows.len());
            Ok((lists(py, &found.lines, dimension)?, lists(py, &found.rays, dimension)?, on, found.ambient))
        }))
    })
}

/// balanced, weights, motion, span: integers.
type Partition<'py> = (Bound<'py, PyArray1<bool>>, Rows<'py>, Option<Rows<'py>>, Rows<'py>);

#[pyfunction]
pub fn exact_tucker_partition<'py>(
    py: Python<'py>,
    rows: Vec<Vec<Bound<'py, PyAny>>>,
    dimension: usize,
) -> PyResult<Partition<'py>> {
    guarded(py, || {
        with_dimension!(py, dimension, D => {
            let rows = integers::<D>(py, &rows, D)?;
            let found = py.detach(|| tucker::tucker_partition(&rows));
            let motion = found.motion.map(|motion| list(py, &motion)).transpose()?;
            let balanced = PyArray1::from_slice(py, &found.balanced);
            Ok((balanced, list(py, &found.weights)?, motion, lists(py, &found.span, dimension)?))
        })
    })
}

/// The sign of s for rows of Python integers.
#[pyfunction]
pub fn exact_sign(py: Python<'_>, rows: Vec<Vec<Bound<'_, PyAny>>>, dimension: usize, filter: bool) -> PyResult<i8> {
    guarded(py, || {
        with_dimension!(py, dimension, D => {
            let rows = integers::<D>(py, &rows, D)?;
            Ok(py.detach(|| tucker::sign_of_exact_closure(&rows, filter)))
        })
    })
}

/// The sign of s of many sets of rows, which are taken as the floats they are.
#[pyfunction]
pub fn exact_signs<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray2<'py, f64>,
    indices: Option<PyReadonlyArray1<'py, i64>>,
    offsets: PyReadonlyArray1<'py, i64>,
    filter: bool,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<i8>>> {
    guarded(py, || {
        let (indices, offsets) = ragged(py, rows.shape()[0], indices, &offsets)?;
        with_dimension!(py, rows.shape()[1], D => {
            let rows = arrays::rows::<D>(py, &rows)?;
            let sets = Ragged { rows: &rows, indices: indices.as_deref(), offsets: &offsets };
            let signs = py.detach(|| batch::signs(&sets, filter, threads.clamp(1, sets.len().max(1))));
            Ok(PyArray1::from_vec(py, signs))
        })
    })
}

/// Integer vectors without common factor, of `width` numbers, padded with zeros.
fn integers<const D: usize>(py: Python<'_>, rows: &[Vec<Bound<'_, PyAny>>], width: usize) -> PyResult<Vec<[IBig; D]>> {
    let mut all = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        let values: PyResult<Vec<IBig>> = row.iter().map(integer).collect();
        let mut values = values?;
        if values.len() == width {
            values.resize(D, IBig::ZERO);
        }
        let mut values: [IBig; D] = values.try_into().map_err(|given: Vec<IBig>| {
            cone_error(py, format!("row {index} has {} numbers, where rows of {width} go", given.len()))
        })?;
        make_primitive(&mut values);
        all.push(values);
    }
    Ok(all)
}

fn integer(value: &Bound<'_, PyAny>) -> PyResult<IBig> {
    let value = value.cast::<PyInt>()?;
    if let Ok(small) = value.extract::<i64>() {
        return Ok(small.into());
    }
    let bits: usize = value.call_method0("bit_length")?.extract()?;
    let keywords = signed(value.py())?;
    let bytes = value.call_method("to_bytes", (bits / 8 + 1, "little"), Some(&keywords))?;
    Ok(IBig::from_le_bytes(bytes.cast::<PyBytes>()?.as_bytes()))
}

fn signed(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let keywords = PyDict::new(py);
    keywords.set_item("signed", true)?;
    Ok(keywords)
}

fn python_integer<'py>(py: Python<'py>, value: &IBig) -> PyResult<Bound<'py, PyAny>> {
    if let Ok(small) = i64::try_from(value) {
        return Ok(small.into_pyobject(py)?.into_any());
    }
    let keywords = signed(py)?;
    let bytes = PyBytes::new(py, &value.to_le_bytes());
    py.get_type::<PyInt>().call_method("from_bytes", (bytes, "little"), Some(&keywords))
}

fn list<'py>(py: Python<'py>, values: &[IBig]) -> PyResult<Rows<'py>> {
    let values: PyResult<Vec<_>> = values.iter().map(|value| python_integer(py, value)).collect();
    PyList::new(py, values?)
}

fn lists<'py, const D: usize>(py: Python<'py>, rows: &[[IBig; D]], width: usize) -> PyResult<Rows<'py>> {
    let rows: PyResult<Vec<_>> = rows.iter().map(|row| list(py, &row[..width])).collect();
    PyList::new(py, rows?)
}

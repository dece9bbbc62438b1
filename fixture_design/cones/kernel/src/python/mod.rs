//! The border to Python: arrays in, arrays out.
//!
//! Nothing is trusted here: shapes, lengths and finiteness are looked at, what is wrong becomes a `ConeError`, and a panic,
//! which would be a fault of the crate, becomes a `KernelError` of the package. The interpreter lock is given up while
//! the crate works; long work asks now and then whether Ctrl-C was pressed.

mod arrays;
mod balances;
mod closures;
mod cones;
mod exact;
mod guard;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    guard::be_quiet();
    module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    module.add("MAX_DIMENSION", arrays::MAX_DIMENSION)?;
    module.add("MAX_ROWS", arrays::MAX_ROWS)?;
    module.add_function(wrap_pyfunction!(cones::double_description, module)?)?;
    module.add_function(wrap_pyfunction!(cones::add_row, module)?)?;
    module.add_function(wrap_pyfunction!(cones::faces, module)?)?;
    module.add_function(wrap_pyfunction!(closures::tucker_partition, module)?)?;
    module.add_function(wrap_pyfunction!(closures::minimum_norm_point, module)?)?;
    module.add_function(wrap_pyfunction!(closures::nonnegative_least_squares, module)?)?;
    module.add_function(wrap_pyfunction!(closures::closure, module)?)?;
    module.add_function(wrap_pyfunction!(closures::closures, module)?)?;
    module.add_function(wrap_pyfunction!(closures::memberships, module)?)?;
    module.add_function(wrap_pyfunction!(balances::balance_guesses, module)?)?;
    module.add_function(wrap_pyfunction!(exact::exact_double_description, module)?)?;
    module.add_function(wrap_pyfunction!(exact::exact_tucker_partition, module)?)?;
    module.add_function(wrap_pyfunction!(exact::exact_sign, module)?)?;
    module.add_function(wrap_pyfunction!(exact::exact_signs, module)?)?;
    module.add_function(wrap_pyfunction!(guard::panic_on_purpose, module)?)?;
    Ok(())
}

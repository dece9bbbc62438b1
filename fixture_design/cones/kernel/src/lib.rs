//! The decisions that everything else waits for: double description, closure, contact modes; the Python package
//! `fixture_design.cones.kernel` says what they are, and has the same in numpy.

pub mod adjacency;
pub mod balance;
mod balance_step;
pub mod batch;
pub mod certificate;
pub mod closure;
pub mod double_description;
pub mod exact;
pub mod faces;
mod lanes;
pub mod mask;
pub mod minimum_norm;
pub mod nonnegative;
pub mod orthogonal;
pub mod polish;
#[cfg(test)]
mod random;
pub mod singular;
pub mod tucker;
pub mod vector;

#[cfg(feature = "python")]
mod python;

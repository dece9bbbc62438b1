//! The same questions in exact arithmetic, for data that are rational: decimals of files, facets from vertices.
//!
//! A row may be scaled by any positive number, so all rows are integer vectors without a common factor. What a float can
//! tell for certain it tells: signs of products from correctly rounded copies with a bound on the error (`double_description`),
//! closure from the bounds of `certificate` (`tucker::sign_of_closure`). The rest is integers, of one machine word with
//! products of two where everything fits, else of any length.

pub mod double_description;
pub mod integer;
pub mod simplex;
pub mod tucker;

//! CONVERT by double description in exact arithmetic; the float one says how it works.
//!
//! Signs come from floats where they are certain: rows and rays are kept rounded too, each component within 3 u of the
//! largest (`Integer::rounded`; u = 2^-53), so that a product, of D terms of size at most one, is within (8 D + D^2) u of
//! the exact one; `CERTAIN` is twice what D = 8 needs. What is smaller, all exact zeros with it, is computed in integers.

use dashu_int::IBig;

use super::integer::{Integer, make_primitive};
use crate::adjacency::adjacent_pairs;
use crate::double_description::Stopped;
use crate::mask::{self, Mask};

/// A rounded product beyond this has the exact one's sign [-].
const CERTAIN: f64 = 256.0 * f64::EPSILON / 2.0;

pub struct Exact<const D: usize, const W: usize> {
    pub lines: Vec<[IBig; D]>,
    /// Orthogonal to the lines, without common factor.
    pub rays: Vec<[IBig; D]>,
    pub active: Vec<Mask<W>>,
    /// Dimension of the space that the equalities leave.
    pub ambient: usize,
}

struct Row<T, const D: usize> {
    exact: [T; D],
    rounded: [f64; D],
}

struct Ray<T, const D: usize, const W: usize> {
    exact: [T; D],
    /// All rows that it lies on, and all that it violates, taken or not.
    on: Mask<W>,
    violated: Mask<W>,
}

/// Both forms of {x : rows . x <= 0, equalities . x = 0}.
pub fn double_description<const D: usize, const W: usize>(
    rows: &[[IBig; D]],
    equalities: &[[IBig; D]],
    max_rays: usize,
    stop: &dyn Fn() -> bool,
) -> Result<Exact<D, W>, Stopped> {
    match in_numbers::<i64, D, W>(rows, equalities, max_rays, stop) {
        Some(result) => result,
        None => in_numbers::<IBig, D, W>(rows, equalities, max_rays, stop).expect("long integers do not overflow"),
    }
}

fn converted<T: Integer, const D: usize>(vector: &[IBig; D]) -> Option<[T; D]> {
    let values: Option<Vec<T>> = vector.iter().map(T::from_big).collect();
    values?.try_into().ok()
}

/// None: a number overflowed.
fn in_numbers<T: Integer, const D: usize, const W: usize>(
    rows: &[[IBig; D]],
    equalities: &[[IBig; D]],
    max_rays: usize,
    stop: &dyn Fn() -> bool,
) -> Option<Result<Exact<D, W>, Stopped>> {
    let mut table = Vec::with_capacity(rows.len());
    for row in rows {
        let exact: [T; D] = converted(row)?;
        table.push(Row { rounded: T::rounded(&exact), exact });
    }
    let mut lines: Vec<[T; D]> =
        (0..D).map(|i| std::array::from_fn(|k| if i == k { T::one() } else { T::zero() })).collect();
    for equality in equalities {
        take_line(&mut lines, &mut [], &converted(equality)?)?;
    }
    let ambient = lines.len();
    let mut done: Mask<W> = mask::empty();
    let mut waiting: Mask<W> = mask::first(rows.len());
    let mut bare: Vec<[T; D]> = Vec::new();
    let mut order = Vec::new();
    for index in 0..rows.len() {
        if let Some(line) = take_line(&mut lines, &mut bare, &table[index].exact)? {
            bare.push(line);
            order.push(index);
            mask::insert(&mut done, index);
            mask::remove(&mut waiting, index);
        }
    }
    let mut rays: Vec<Ray<T, D, W>> = Vec::new();
    for (place, exact) in bare.into_iter().enumerate() {
        // on all rows that took a line but its own
        let mut known = done;
        mask::remove(&mut known, order[place]);
        rays.push(looked_at(exact, known, &table)?);
    }
    let mut counts = vec![0u32; rows.len()];
    rays.iter().for_each(|ray| mask::rows(&ray.violated).for_each(|row| counts[row] += 1));
    let needed = (ambient - lines.len()).saturating_sub(2);
    loop {
        let next = mask::rows(&waiting).max_by_key(|&row| (counts[row], std::cmp::Reverse(row)));
        let Some(index) = next.filter(|&row| counts[row] > 0) else { break };
        mask::remove(&mut waiting, index);
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let mut active = Vec::with_capacity(rays.len());
        let mut heights = Vec::with_capacity(rays.len());
        for (place, ray) in rays.iter().enumerate() {
            active.push(mask::and(&ray.on, &done));
            if mask::has(&ray.on, index) {
                heights.push(T::zero());
                continue;
            }
            let list = if mask::has(&ray.violated, index) { &mut above } else { &mut below };
            list.push(place);
            heights.push(T::dot(&table[index].exact, &ray.exact)?);
        }
        mask::insert(&mut done, index);
        let mut made = Vec::new();
        let mut overflow = false;
        let finished = adjacent_pairs(&active, &above, &below, needed, stop, |up, low, common| {
            let (high, deep) = (&heights[up], &heights[low]);
            let mut known = common;
            mask::insert(&mut known, index);
            let ray = T::combined(high, &rays[low].exact, deep, &rays[up].exact);
            match ray.and_then(|exact| looked_at(exact, known, &table)) {
                Some(ray) => made.push(ray),
                None => overflow = true,
            }
            !overflow && made.len() <= max_rays
        });
        if overflow {
            return None;
        }
        if made.len() + rays.len() - above.len() > max_rays {
            return Some(Err(Stopped::TooManyRays { rows: mask::count(&done) }));
        }
        if !finished {
            return Some(Err(Stopped::Interrupted));
        }
        for &place in above.iter().rev() {
            let gone = rays.swap_remove(place);
            mask::rows(&gone.violated).for_each(|row| counts[row] -= 1);
        }
        made.iter().for_each(|ray| mask::rows(&ray.violated).for_each(|row| counts[row] += 1));
        rays.append(&mut made);
        if rays.is_empty() {
            break;
        }
    }
    let lines = echelon(lines.iter().map(|line| std::array::from_fn(|k| line[k].to_big())).collect());
    let orthogonal = orthogonalised(&lines);
    Some(Ok(Exact {
        rays: rays.iter().map(|ray| across(std::array::from_fn(|k| ray.exact[k].to_big()), &orthogonal)).collect(),
        active: rays.iter().map(|ray| ray.on).collect(),
        lines,
        ambient,
    }))
}

/// Where a line crosses the row, take it out and slide everything else along it onto the row; returns it, pointing down.
fn take_line<T: Integer, const D: usize>(
    lines: &mut Vec<[T; D]>,
    rays: &mut [[T; D]],
    row: &[T; D],
) -> Option<Option<[T; D]>> {
    let mut crossing = None;
    for (place, line) in lines.iter().enumerate() {
        let slope = T::dot(row, line)?;
        if !slope.is_zero() {
            crossing = Some((place, slope));
            break;
        }
    }
    let Some((place, slope)) = crossing else { return Some(None) };
    let line = lines.swap_remove(place);
    let down = if slope.is_negative() { line } else { line.map(|value| value.negated()) };
    let depth = if slope.is_negative() { slope } else { slope.negated() }; // row . down < 0
    for vector in lines.iter_mut().chain(rays) {
        let height = T::dot(row, vector)?;
        // height down - depth vector: -depth > 0 keeps the direction
        *vector = T::combined(&height, &down, &depth, vector)?;
    }
    Some(Some(down))
}

/// A ray with the side of every row that it is on; `known` are rows that it is known to lie on.
#[inline(always)]
fn looked_at<T: Integer, const D: usize, const W: usize>(
    exact: [T; D],
    known: Mask<W>,
    table: &[Row<T, D>],
) -> Option<Ray<T, D, W>> {
    let rounded = T::rounded(&exact);
    let (mut on, mut violated) = (known, mask::empty());
    for (index, row) in table.iter().enumerate() {
        let mut product = 0.0;
        for k in 0..D {
            product += row.rounded[k] * rounded[k];
        }
        if product > CERTAIN {
            mask::insert(&mut violated, index);
        } else if product >= -CERTAIN && !mask::has(&known, index) {
            let product = T::dot(&row.exact, &exact)?;
            if product.is_zero() {
                mask::insert(&mut on, index);
            } else if !product.is_negative() {
                mask::insert(&mut violated, index);
            }
        }
    }
    Some(Ray { exact, on, violated })
}

/// Reduced row echelon form: one canonical basis of the linear span, leading entries positive.
pub fn echelon<const D: usize>(mut rest: Vec<[IBig; D]>) -> Vec<[IBig; D]> {
    let mut basis: Vec<[IBig; D]> = Vec::new();
    for column in 0..D {
        let Some(place) = rest.iter().position(|row| row[column] != IBig::ZERO) else { continue };
        let mut pivot = rest.swap_remove(place);
        if pivot[column] < IBig::ZERO {
            pivot = pivot.map(|value| -value);
        }
        make_primitive(&mut pivot);
        for row in basis.iter_mut().chain(&mut rest) {
            if row[column] != IBig::ZERO {
                *row = IBig::combined(&pivot[column], row, &row[column], &pivot).expect("no overflow");
            }
        }
        basis.push(pivot);
    }
    basis
}

fn orthogonalised<const D: usize>(lines: &[[IBig; D]]) -> Vec<[IBig; D]> {
    let mut orthogonal: Vec<[IBig; D]> = Vec::new();
    for line in lines {
        orthogonal.push(across(line.clone(), &orthogonal));
    }
    orthogonal
}

/// The part of a vector orthogonal to orthogonal lines, without common factor.
fn across<const D: usize>(mut vector: [IBig; D], lines: &[[IBig; D]]) -> [IBig; D] {
    for line in lines {
        let (squared, along) = (IBig::dot(line, line), IBig::dot(&vector, line));
        let (squared, along) = (squared.expect("no overflow"), along.expect("no overflow"));
        vector = IBig::combined(&squared, &vector, &along, line).expect("no overflow");
    }
    vector
}

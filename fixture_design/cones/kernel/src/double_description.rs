//! CONVERT by double description (T. S. Motzkin et al., 1953; K. Fukuda, A. Prodon, 1996), in floats.
//!
//! The cone {x : rows . x <= 0} is kept as an orthonormal basis of its lines and a list of extreme rays, each with the
//! set of rows that it lies on. A row more costs one step: a line that crosses it turns into a ray; without one, rays
//! beyond it go, and every adjacent pair across it leaves a new ray on it.
//!
//! What makes it fast: the dimension is a compile-time number and the sets are words, so that a pair of rays costs a few
//! instructions; rows are taken in the order that cuts most rays, so that a closed cone ends early, and how many rays each
//! waiting row cuts is counted as rays come and go instead of anew; two rays that share as many rows as a two-dimensional
//! face needs are adjacent without a search where one of them lies on no row too many.
//!
//! What makes it safe: zero tests are relative (unit rows, unit rays) and every value they saw is recorded. After the last
//! row each ray is checked against *all* rows once more: the recorded zeros and non-zeros are those of the rays returned,
//! and a ray that is found beyond a row makes the result uncertain whatever else was seen.

use crate::adjacency::adjacent_pairs;
use crate::mask::{self, Mask};
use crate::polish::polished;
use crate::vector::{dot, norm, plus, scaled, unit};

/// Products of a ray with the rows it lies on are rounding up to this, and the ray needs no polish [-].
const ACCURATE: f64 = 2e-15;

/// The cone has more extreme rays than allowed after so many rows; or somebody wants to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    TooManyRays { rows: usize },
    Interrupted,
}

/// A cone with both its forms; see the Python class of the same name.
#[derive(Debug, Clone)]
pub struct DoubleDescription<const D: usize, const W: usize> {
    pub rows: Vec<[f64; D]>,
    pub lines: Vec<[f64; D]>,
    pub rays: Vec<[f64; D]>,
    /// For each ray the rows that it lies on.
    pub active: Vec<Mask<W>>,
    pub zero: f64,
    /// Dimension of the space that the equalities leave.
    pub ambient: usize,
    pub zero_max: f64,
    pub nonzero_min: f64,
}

impl<const D: usize, const W: usize> DoubleDescription<D, W> {
    pub fn whole_space(zero: f64) -> Self {
        let lines = (0..D).map(|i| std::array::from_fn(|k| f64::from(u8::from(i == k)))).collect();
        Self {
            rows: Vec::new(),
            lines,
            rays: Vec::new(),
            active: Vec::new(),
            zero,
            ambient: D,
            zero_max: 0.0,
            nonzero_min: f64::INFINITY,
        }
    }

    #[inline(always)]
    fn saw_zero(&mut self, value: f64) {
        self.zero_max = self.zero_max.max(value.abs());
    }

    #[inline(always)]
    fn saw_nonzero(&mut self, value: f64) {
        self.nonzero_min = self.nonzero_min.min(value.abs());
    }

    /// How a row crosses the lines: their coordinates of it, and the length of that vector.
    #[inline(always)]
    fn crossing(&self, row: &[f64; D]) -> ([f64; D], f64) {
        let mut along = [0.0; D];
        for (place, line) in along.iter_mut().zip(&self.lines) {
            *place = dot(line, row);
        }
        (along, norm(&along))
    }

    /// Take the direction `along` (unit, in the lines' coordinates) out of the lines; returns it as a vector.
    ///
    /// One reflection takes it to a coordinate axis; the other axes' images are what is left. Nothing is orthogonalised
    /// anew, so the lines stay orthonormal to rounding.
    fn take_line(&mut self, along: &[f64; D]) -> [f64; D] {
        let count = self.lines.len();
        let last = count - 1;
        let mut taken = [0.0; D];
        for (k, line) in self.lines.iter().enumerate() {
            taken = plus(&taken, along[k], line);
        }
        let mut mirror = *along;
        mirror[last] += if along[last] >= 0.0 { 1.0 } else { -1.0 };
        let size = mirror[..count].iter().map(|v| v * v).sum::<f64>();
        let mut image = [0.0; D];
        for (k, line) in self.lines.iter().enumerate() {
            image = plus(&image, mirror[k], line);
        }
        for k in 0..last {
            self.lines[k] = plus(&self.lines[k], -2.0 * mirror[k] / size, &image);
        }
        self.lines.pop();
        unit(&taken)
    }

    /// Confine the cone to equality . x = 0 (unit), before any row.
    pub fn add_equality(&mut self, equality: &[f64; D]) {
        let (along, length) = self.crossing(equality);
        if length > self.zero {
            self.take_line(&scaled(1.0 / length, &along));
            self.ambient -= 1;
            self.saw_nonzero(length);
        } else {
            self.saw_zero(length);
        }
    }

    /// The cone cut by the last of its rows, which has just been appended: one incremental step.
    pub fn add_last_row(&mut self, stop: &dyn Fn() -> bool) -> Result<(), Stopped> {
        let index = self.rows.len() - 1;
        let row = self.rows[index];
        if !self.lines.is_empty() {
            let (along, length) = self.crossing(&row);
            if length > self.zero {
                self.cut_a_line(index, &along, length, &mask::first(index));
                return Ok(());
            }
            self.saw_zero(length);
        }
        let heights: Vec<f64> = self.rays.iter().map(|ray| dot(&row, ray)).collect();
        self.cut_rays(index, &heights, usize::MAX, &mut Uncounted, stop)
    }

    /// A line crosses the row: it turns into one ray, everything else slides along it onto the row.
    fn cut_a_line(&mut self, index: usize, along: &[f64; D], length: f64, earlier: &Mask<W>) {
        let row = self.rows[index];
        let line = self.take_line(&scaled(1.0 / length, along));
        let slope = dot(&row, &line);
        for (ray, active) in self.rays.iter_mut().zip(&mut self.active) {
            *ray = unit(&plus(ray, -dot(&row, ray) / slope, &line));
            mask::insert(active, index); // the rows it was on stay: they vanish on the line
        }
        self.rays.push(scaled(-1.0, &line));
        self.active.push(*earlier);
        self.saw_nonzero(length);
    }

    /// Rays beyond the row go; each adjacent pair across it leaves a ray on it.
    #[inline(always)]
    fn cut_rays<C: Counting<D, W>>(
        &mut self,
        index: usize,
        heights: &[f64],
        max_rays: usize,
        counted: &mut C,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), Stopped> {
        let mut above = Vec::new();
        let mut below = Vec::new();
        for (ray, &height) in heights.iter().enumerate() {
            if height > self.zero {
                above.push(ray);
                self.saw_nonzero(height);
            } else if height < -self.zero {
                below.push(ray);
                self.saw_nonzero(height);
            } else {
                self.saw_zero(height);
            }
        }
        let old = self.rays.len();
        if !above.is_empty() {
            self.rays_between(index, &above, &below, heights, max_rays, stop)?;
        }
        let made = self.rays.len();
        for ray in old..made {
            counted.came(&self.rays[ray]);
        }
        for (ray, &height) in heights.iter().enumerate() {
            if height.abs() <= self.zero {
                mask::insert(&mut self.active[ray], index);
            }
        }
        // the rays beyond go; the last ones take their places
        for &ray in above.iter().rev() {
            self.rays.swap_remove(ray);
            self.active.swap_remove(ray);
            counted.went(ray);
        }
        Ok(())
    }

    /// Append one ray on the new row for every adjacent pair across it.
    #[inline(always)]
    fn rays_between(
        &mut self,
        index: usize,
        above: &[usize],
        below: &[usize],
        heights: &[f64],
        max_rays: usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), Stopped> {
        let needed = (self.ambient - self.lines.len()).saturating_sub(2);
        let room = max_rays.saturating_add(above.len()) - self.rays.len().min(max_rays);
        let (mut rays, mut sets) = (Vec::new(), Vec::new());
        let done = adjacent_pairs(&self.active, above, below, needed, stop, |up, low, mut common| {
            let ray = plus(&scaled(heights[up], &self.rays[low]), -heights[low], &self.rays[up]);
            mask::insert(&mut common, index);
            rays.push(unit(&ray));
            sets.push(common);
            rays.len() <= room
        });
        if rays.len() > room {
            return Err(Stopped::TooManyRays { rows: index + 1 });
        }
        self.rays.append(&mut rays);
        self.active.append(&mut sets);
        if done { Ok(()) } else { Err(Stopped::Interrupted) }
    }

    /// Check every ray against every row, polish those that have lost digits, and record what is seen.
    #[inline(always)]
    fn finish(&mut self, equalities: &[[f64; D]]) {
        let transposed = Transposed::of(&self.rows);
        let mut products = vec![0.0; self.rows.len()];
        for ray in 0..self.rays.len() {
            transposed.products(&self.rays[ray], &mut products);
            let active = self.active[ray];
            if mask::rows(&active).any(|row| products[row].abs() > ACCURATE) {
                let fixed = self.lines.iter().chain(equalities);
                let rows = mask::rows(&active).map(|row| &self.rows[row]).chain(fixed);
                if let Some(better) = polished(&self.rays[ray], rows, self.zero.sqrt()) {
                    self.rays[ray] = better;
                    transposed.products(&better, &mut products);
                }
            }
            for (row, &product) in products.iter().enumerate() {
                if mask::has(&active, row) {
                    self.zero_max = self.zero_max.max(product.abs());
                } else if product > 0.0 {
                    self.zero_max = f64::INFINITY; // beyond a row: whatever was decided on, it was not right
                } else {
                    self.nonzero_min = self.nonzero_min.min(-product);
                }
            }
        }
    }
}

/// Who keeps count of rays that come and go.
trait Counting<const D: usize, const W: usize> {
    fn came(&mut self, ray: &[f64; D]);
    /// The ray at this place went, and the last one took its place.
    fn went(&mut self, place: usize);
}

struct Uncounted;

impl<const D: usize, const W: usize> Counting<D, W> for Uncounted {
    fn came(&mut self, _: &[f64; D]) {}
    fn went(&mut self, _: usize) {}
}

/// How many rays each waiting row cuts.
struct Cuts<const D: usize, const W: usize> {
    rows: Transposed<D>,
    zero: f64,
    waiting: Mask<W>,
    violated: Vec<Mask<W>>,
    counts: Vec<u32>,
    products: Vec<f64>,
}

impl<const D: usize, const W: usize> Cuts<D, W> {
    #[inline(always)]
    fn next(&self) -> Option<usize> {
        let mut best = None;
        let mut most = 0;
        for row in mask::rows(&self.waiting) {
            if self.counts[row] > most {
                (best, most) = (Some(row), self.counts[row]);
            }
        }
        best
    }
}

impl<const D: usize, const W: usize> Counting<D, W> for Cuts<D, W> {
    #[inline(always)]
    fn came(&mut self, ray: &[f64; D]) {
        self.rows.products(ray, &mut self.products);
        let mut violated = mask::empty();
        for (row, &product) in self.products.iter().enumerate() {
            violated[row / 64] |= u64::from(product > self.zero) << (row % 64);
        }
        violated = mask::and(&violated, &self.waiting);
        for row in mask::rows(&violated) {
            self.counts[row] += 1;
        }
        self.violated.push(violated);
    }

    #[inline(always)]
    fn went(&mut self, place: usize) {
        let violated = self.violated.swap_remove(place);
        for row in mask::rows(&violated) {
            self.counts[row] -= 1;
        }
    }
}

/// Rows by columns, so that a ray's products with all of them run along memory.
struct Transposed<const D: usize> {
    columns: [Vec<f64>; D],
}

impl<const D: usize> Transposed<D> {
    fn of(rows: &[[f64; D]]) -> Self {
        Self { columns: std::array::from_fn(|k| rows.iter().map(|row| row[k]).collect()) }
    }

    #[inline(always)]
    fn products(&self, ray: &[f64; D], products: &mut [f64]) {
        let count = products.len();
        let columns: [&[f64]; D] = std::array::from_fn(|k| &self.columns[k][..count]);
        for row in 0..count {
            let mut sum = 0.0;
            for k in 0..D {
                sum += columns[k][row] * ray[k];
            }
            products[row] = sum;
        }
    }
}

/// Both forms of {x : rows . x <= 0, equalities . x = 0}, for unit rows; incidence in the order given.
///
/// `stop` is asked now and then whether to give up.
#[inline(always)]
pub fn double_description<const D: usize, const W: usize>(
    rows: Vec<[f64; D]>,
    equalities: &[[f64; D]],
    zero: f64,
    max_rays: usize,
    stop: &dyn Fn() -> bool,
) -> Result<DoubleDescription<D, W>, Stopped> {
    let mut state = DoubleDescription::whole_space(zero);
    for equality in equalities {
        state.add_equality(equality);
    }
    state.rows = rows;
    let count = state.rows.len();
    let mut done = mask::empty();
    let mut waiting: Mask<W> = mask::first(count);
    // first the rows that cross lines, the steepest first: their rays start from the best conditioned corner
    while !state.lines.is_empty() {
        let mut steepest = (0, [0.0; D], -1.0);
        for row in mask::rows(&waiting) {
            let (along, length) = state.crossing(&state.rows[row]);
            if length > steepest.2 {
                steepest = (row, along, length);
            }
        }
        let (row, along, length) = steepest;
        if length <= state.zero {
            state.saw_zero(length.max(0.0));
            break;
        }
        state.cut_a_line(row, &along, length, &done);
        mask::insert(&mut done, row);
        mask::remove(&mut waiting, row);
    }
    let transposed = Transposed::of(&state.rows);
    let mut cuts = Cuts {
        rows: transposed,
        zero,
        waiting,
        violated: Vec::new(),
        counts: vec![0; count],
        products: vec![0.0; count],
    };
    for ray in &state.rays {
        cuts.came(ray);
    }
    let mut heights = Vec::new();
    let mut taken = mask::count(&done);
    while !state.rays.is_empty() {
        let Some(row) = cuts.next() else { break };
        mask::remove(&mut cuts.waiting, row);
        heights.clear();
        heights.extend(state.rays.iter().map(|ray| dot(&state.rows[row], ray)));
        taken += 1;
        match state.cut_rays(row, &heights, max_rays, &mut cuts, stop) {
            Err(Stopped::TooManyRays { .. }) => return Err(Stopped::TooManyRays { rows: taken }),
            other => other?,
        }
    }
    // rows that cut nothing any more: it is only left to see which rays lie on them
    for row in mask::rows(&cuts.waiting) {
        for ray in 0..state.rays.len() {
            let height = dot(&state.rows[row], &state.rays[ray]);
            if height >= -zero {
                mask::insert(&mut state.active[ray], row);
                state.saw_zero(height);
            } else {
                state.saw_nonzero(height);
            }
        }
    }
    state.finish(equalities);
    Ok(state)
}

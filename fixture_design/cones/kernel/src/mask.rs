//! Sets of rows as bits: which rows a ray lies on, which it violates.

/// A set of up to 64 W rows.
pub type Mask<const W: usize> = [u64; W];

pub const fn empty<const W: usize>() -> Mask<W> {
    [0; W]
}

/// The first `count` rows.
pub fn first<const W: usize>(count: usize) -> Mask<W> {
    let mut mask = [0; W];
    for (word, bits) in mask.iter_mut().enumerate() {
        let below = count.saturating_sub(64 * word);
        *bits = if below >= 64 { u64::MAX } else { (1u64 << below) - 1 };
    }
    mask
}

#[inline(always)]
pub fn has<const W: usize>(mask: &Mask<W>, row: usize) -> bool {
    mask[row / 64] >> (row % 64) & 1 == 1
}

#[inline(always)]
pub fn insert<const W: usize>(mask: &mut Mask<W>, row: usize) {
    mask[row / 64] |= 1 << (row % 64);
}

#[inline(always)]
pub fn remove<const W: usize>(mask: &mut Mask<W>, row: usize) {
    mask[row / 64] &= !(1 << (row % 64));
}

#[inline(always)]
pub fn and<const W: usize>(first: &Mask<W>, second: &Mask<W>) -> Mask<W> {
    let mut both = [0; W];
    for word in 0..W {
        both[word] = first[word] & second[word];
    }
    both
}

#[inline(always)]
pub fn count<const W: usize>(mask: &Mask<W>) -> usize {
    mask.iter().map(|word| word.count_ones() as usize).sum()
}

/// Whether every row of `inner` is in `outer`.
#[inline(always)]
pub fn within<const W: usize>(inner: &Mask<W>, outer: &Mask<W>) -> bool {
    let mut missing = 0;
    for word in 0..W {
        missing |= inner[word] & !outer[word];
    }
    missing == 0
}

/// The rows of a set, smallest first.
#[inline(always)]
pub fn rows<const W: usize>(mask: &Mask<W>) -> impl Iterator<Item = usize> + '_ {
    mask.iter().enumerate().flat_map(|(word, &bits)| {
        let mut left = bits;
        std::iter::from_fn(move || {
            if left == 0 {
                return None;
            }
            let bit = left.trailing_zeros() as usize;
            left &= left - 1;
            Some(64 * word + bit)
        })
    })
}

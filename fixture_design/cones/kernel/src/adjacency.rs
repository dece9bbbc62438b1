//! Which pairs of extreme rays span a two-dimensional face, from the rows that each lies on.

use crate::mask::{self, Mask};

/// How many pairs are looked at between two questions whether to stop.
const PATIENCE: usize = 1 << 16;

/// Hands every adjacent pair of a ray of `above` and one of `below` to `found`, with the rows that both lie on.
///
/// Two rays are adjacent if no third ray lies on all the rows that both lie on, and these are at least `needed`, two less
/// than the dimension modulo lines. Where one of them lies on just as many rows as pin a ray down, these are independent;
/// if the two share all but one of them, the face is two-dimensional by its rank, and no search is needed.
///
/// Returns what `found` or `stop` end it with: false, and the work is given up.
#[inline(always)]
pub fn adjacent_pairs<const W: usize>(
    active: &[Mask<W>],
    above: &[usize],
    below: &[usize],
    needed: usize,
    stop: &dyn Fn() -> bool,
    mut found: impl FnMut(usize, usize, Mask<W>) -> bool,
) -> bool {
    let lows: Vec<(Mask<W>, bool)> =
        below.iter().map(|&low| (active[low], mask::count(&active[low]) == needed + 1)).collect();
    let mut blocker = 0; // the ray that came between the last pair often comes between the next
    let mut looked_at = 0;
    for &up in above {
        looked_at += below.len();
        if looked_at > PATIENCE {
            looked_at = 0;
            if stop() {
                return false;
            }
        }
        let upper = active[up];
        let upper_simple = mask::count(&upper) == needed + 1;
        for (&low, (lower, lower_simple)) in below.iter().zip(&lows) {
            let common = mask::and(&upper, lower);
            let shared = mask::count(&common);
            if shared < needed {
                continue;
            }
            if !(shared == needed && (upper_simple || *lower_simple)) {
                let between = |ray: usize| ray != up && ray != low && mask::within(&common, &active[ray]);
                if between(blocker) {
                    continue;
                }
                if let Some(third) = (0..active.len()).find(|&ray| between(ray)) {
                    blocker = third;
                    continue;
                }
            }
            if !found(up, low, common) {
                return false;
            }
        }
    }
    true
}

//! All faces of a cone from its rays: for contacts, all the modes (which stay in contact, which separate).
//!
//! A motion of the cone {u : D u <= 0} keeps the contacts with d_i . u = 0 and separates the others. The sets that occur are
//! those of the faces, one for each face: the rows that all of the face's rays lie on. So the faces are the intersections
//! of the rays' row sets, and the lineality space (every row, no ray) besides.
//!
//! They are collected ray by ray. The faces at a ray are made of its edges: each is the intersection of the row sets of
//! some edges at that ray. A ray on just as many rows as pin it down has every subset of them as a face, and nothing is
//! searched; elsewhere the edges are the largest proper intersections with other rays, and intersections of edges are
//! taken until none is new. A relative interior point of a face is the sum of its rays: each ray adds itself to all faces
//! it lies in, so that no face ever looks for its rays.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use crate::double_description::DoubleDescription;
use crate::mask::{self, Mask};
use crate::vector::{plus, unit};

/// A face: the rows that vanish on it, and a unit vector of its relative interior (zero for the lineality space).
#[derive(Debug, Clone)]
pub struct Face<const D: usize, const W: usize> {
    pub rows: Mask<W>,
    pub witness: [f64; D],
}

/// Multiplicative hashing of words, as in the Rust compiler's own tables: the sets are not under anybody's control.
#[derive(Default)]
struct Words(u64);

impl Hasher for Words {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }
    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }
}

type Table<const D: usize, const W: usize> = HashMap<Mask<W>, [f64; D], BuildHasherDefault<Words>>;

/// All faces, those with most rows first; None if there are more than `most`.
#[inline(always)]
pub fn faces<const D: usize, const W: usize>(cone: &DoubleDescription<D, W>, most: usize) -> Option<Vec<Face<D, W>>> {
    let all: Mask<W> = mask::first(cone.rows.len());
    let everywhere = cone.active.iter().fold(all, |rows, active| mask::and(&rows, active));
    let pointed = cone.ambient - cone.lines.len();
    let mut found: Table<D, W> = Table::default();
    for (place, active) in cone.active.iter().enumerate() {
        let simple = mask::count(&everywhere) == 0 && mask::count(active) + 1 == pointed;
        let at_ray = if simple { subsets(active) } else { intersections(&edges(cone, place), *active, most)? };
        for rows in at_ray {
            let sum = found.entry(rows).or_insert([0.0; D]);
            *sum = plus(sum, 1.0, &cone.rays[place]);
        }
        if found.len() > most {
            return None;
        }
    }
    found.entry(all).or_insert([0.0; D]);
    if found.len() > most {
        return None;
    }
    let mut faces: Vec<Face<D, W>> = found.into_iter().map(|(rows, sum)| Face { rows, witness: unit(&sum) }).collect();
    faces.sort_unstable_by_key(|face| (std::cmp::Reverse(mask::count(&face.rows)), face.rows));
    Some(faces)
}

fn subsets<const W: usize>(set: &Mask<W>) -> Vec<Mask<W>> {
    let mut all = vec![mask::empty()];
    for row in mask::rows(set) {
        for k in 0..all.len() {
            let mut larger = all[k];
            mask::insert(&mut larger, row);
            all.push(larger);
        }
    }
    all
}

/// The row sets of the edges at a ray: the largest of those that it shares with another one.
fn edges<const D: usize, const W: usize>(cone: &DoubleDescription<D, W>, place: usize) -> Vec<Mask<W>> {
    let own = &cone.active[place];
    let others = cone.active.iter().enumerate().filter(|&(other, _)| other != place);
    let mut shared: Vec<Mask<W>> = others.map(|(_, active)| mask::and(own, active)).collect();
    shared.sort_unstable_by_key(|rows| (std::cmp::Reverse(mask::count(rows)), *rows));
    shared.dedup();
    let mut largest: Vec<Mask<W>> = Vec::new();
    for rows in shared {
        if !largest.iter().any(|larger| mask::within(&rows, larger)) {
            largest.push(rows);
        }
    }
    largest
}

/// `own` and all intersections of one or more of the sets; None if there are more than `most`.
fn intersections<const W: usize>(sets: &[Mask<W>], own: Mask<W>, most: usize) -> Option<Vec<Mask<W>>> {
    let mut known: HashMap<Mask<W>, (), BuildHasherDefault<Words>> = HashMap::default();
    let mut all = vec![own];
    known.insert(own, ());
    let mut next = 0;
    while next < all.len() {
        for set in sets {
            let smaller = mask::and(&all[next], set);
            if known.insert(smaller, ()).is_none() {
                all.push(smaller);
            }
        }
        if all.len() > most {
            return None;
        }
        next += 1;
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double_description::double_description;

    #[test]
    fn a_cube_s_cone_has_the_cube_s_faces() {
        // x, y, z in [-1, 1] times t: 8 rays, and 1 + 8 + 12 + 6 + 1 faces
        let s = 0.5f64.sqrt();
        let mut rows = Vec::new();
        for k in 0..3 {
            for sign in [-s, s] {
                let mut row = [0.0, 0.0, 0.0, -s];
                row[k] = sign;
                rows.push(row);
            }
        }
        let cone = double_description::<4, 1>(rows.clone(), &[], 1e-9, 100, &|| false).unwrap();
        assert_eq!(cone.rays.len(), 8);
        assert_eq!(faces(&cone, 1000).unwrap().len(), 28);
        assert!(faces(&cone, 27).is_none());
        rows.extend(rows.clone()); // repeated rows: no ray is on few enough, and the edges are searched
        let twice = double_description::<4, 1>(rows, &[], 1e-9, 100, &|| false).unwrap();
        assert_eq!(faces(&twice, 1000).unwrap().len(), 28);
    }

    #[test]
    fn without_rays_there_is_one_face() {
        let line = double_description::<2, 1>(vec![[1.0, 0.0], [-1.0, 0.0]], &[], 1e-9, 100, &|| false).unwrap();
        assert_eq!(faces(&line, 10).unwrap().len(), 1);
    }
}

//! Farkas' lemma, decided: is a vector a nonnegative combination of others? Phase 1 of the simplex method on an integer
//! tableau, with divisions that come out even (E. Bareiss, 1968).

use super::integer::Integer;

/// Steps by the steepest column before R. Bland's rule takes over, which cannot cycle.
const STEEP_STEPS: usize = 60;

pub enum Farkas<T, const D: usize> {
    /// sum weights_j columns_j = denominator target, all >= 0, denominator > 0.
    Inside { weights: Vec<T>, denominator: T },
    /// y . columns_j <= 0 for all j, y . target > 0.
    Outside { separating: [T; D] },
}

/// None: a number overflowed.
pub fn nonnegative_solution<T: Integer, const D: usize>(columns: &[[T; D]], target: &[T; D]) -> Option<Farkas<T, D>> {
    let count = columns.len();
    let width = count + D + 1;
    let last = width - 1;
    let one = T::one();
    let minus = one.negated();
    let sum = |values: &mut dyn Iterator<Item = T>| -> Option<T> {
        let mut total = T::zero();
        for value in values {
            total = T::cross(&one, &total, &minus, &value, &one)?;
        }
        Some(total)
    };
    let flipped = |row: usize, value: &T| if target[row].is_negative() { value.negated() } else { value.clone() };
    let mut table: Vec<Vec<T>> = (0..D)
        .map(|i| {
            let mut row = Vec::with_capacity(width);
            row.extend(columns.iter().map(|column| flipped(i, &column[i])));
            row.extend((0..D).map(|k| if i == k { T::one() } else { T::zero() }));
            row.push(flipped(i, &target[i]));
            row
        })
        .collect();
    // the last row: what the artificial variables still add up to
    let mut costs = vec![T::zero(); width];
    for column in (0..count).chain([last]) {
        costs[column] = sum(&mut table.iter().map(|row| row[column].clone()))?;
    }
    table.push(costs);
    let mut basis: Vec<usize> = (count..count + D).collect();
    let mut denominator = T::one();
    let mut steps = 0;
    while !table[D][last].is_zero() {
        let positive = (0..count).filter(|&j| !table[D][j].is_zero() && !table[D][j].is_negative());
        let entering = if steps < STEEP_STEPS {
            let mut best: Option<usize> = None;
            for j in positive {
                let steeper = match best {
                    None => true,
                    Some(b) => T::cross(&one, &table[D][b], &one, &table[D][j], &one)?.is_negative(),
                };
                if steeper {
                    best = Some(j);
                }
            }
            best
        } else {
            positive.into_iter().next()
        };
        let Some(entering) = entering else { break };
        let leaving = ratio_test(&table, &basis, entering, last)?;
        let pivot_row = table[leaving].clone();
        let pivot = pivot_row[entering].clone();
        for (i, row) in table.iter_mut().enumerate() {
            if i == leaving {
                continue;
            }
            let factor = row[entering].clone();
            for (value, above) in row.iter_mut().zip(&pivot_row) {
                *value = T::cross(&pivot, value, &factor, above, &denominator)?;
            }
        }
        denominator = pivot;
        basis[leaving] = entering;
        steps += 1;
    }
    if table[D][last].is_zero() {
        let mut weights = vec![T::zero(); count];
        for (row, &column) in basis.iter().enumerate() {
            if column < count {
                weights[column] = table[row][last].clone();
            }
        }
        return Some(Farkas::Inside { weights, denominator });
    }
    let mut separating = std::array::from_fn(|_| T::zero());
    for (i, place) in separating.iter_mut().enumerate() {
        *place = flipped(i, &T::cross(&one, &table[D][count + i], &minus, &denominator, &one)?);
    }
    Some(Farkas::Outside { separating })
}

/// The row whose variable reaches zero first; of several the one with the smallest name.
fn ratio_test<T: Integer>(table: &[Vec<T>], basis: &[usize], entering: usize, last: usize) -> Option<usize> {
    let mut best: Option<usize> = None;
    for i in 0..basis.len() {
        let here = &table[i][entering];
        if here.is_zero() || here.is_negative() {
            continue;
        }
        best = Some(match best {
            None => i,
            Some(b) => {
                let ahead = T::cross(&table[i][last], &table[b][entering], &table[b][last], here, &T::one())?;
                if ahead.is_negative() || (ahead.is_zero() && basis[i] < basis[b]) { i } else { b }
            }
        });
    }
    // a column with a positive cost has a positive entry, since the costs are the sum of the rows with artificials
    Some(best.expect("phase 1 is bounded"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use dashu_int::IBig;

    #[test]
    fn every_answer_is_its_own_proof() {
        let mut random = Random::new(7);
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..2000 {
            let vector = |random: &mut Random| -> [i64; 4] { std::array::from_fn(|_| random.below(7) as i64 - 3) };
            let columns: Vec<[i64; 4]> = (0..random.below(9)).map(|_| vector(&mut random)).collect();
            let target = vector(&mut random);
            match nonnegative_solution(&columns, &target).unwrap() {
                Farkas::Inside { weights, denominator } => {
                    inside += 1;
                    assert!(denominator > 0 && weights.iter().all(|&weight| weight >= 0));
                    for k in 0..4 {
                        let sum: i64 = weights.iter().zip(&columns).map(|(weight, column)| weight * column[k]).sum();
                        assert_eq!(sum, denominator * target[k]);
                    }
                }
                Farkas::Outside { separating } => {
                    outside += 1;
                    assert!(i64::dot(&separating, &target).unwrap() > 0);
                    assert!(columns.iter().all(|column| i64::dot(&separating, column).unwrap() <= 0));
                }
            }
            let long: Vec<[IBig; 4]> = columns.iter().map(|column| column.map(IBig::from)).collect();
            let again = nonnegative_solution(&long, &target.map(IBig::from)).unwrap();
            let same = matches!(again, Farkas::Inside { .. });
            assert_eq!(same, matches!(nonnegative_solution(&columns, &target).unwrap(), Farkas::Inside { .. }));
        }
        assert!(inside > 100 && outside > 100);
    }
}

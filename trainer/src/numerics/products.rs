//! Inner products of slices, each in a fixed order, so that it always rounds alike.

/// Inner product, summed in the order of the elements.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Euclidean norm.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Inner product with `LANES` interleaved partial sums (a power of two), added in pairs of neighbours: it vectorises.
#[inline]
pub(crate) fn interleaved_dot<const LANES: usize>(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a_chunks, b_chunks) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let tail: f64 = a_chunks.remainder().iter().zip(b_chunks.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a_chunks.zip(b_chunks) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let mut count = LANES;
    while count > 1 {
        count /= 2;
        for pair in 0..count {
            sums[pair] = sums[2 * pair] + sums[2 * pair + 1];
        }
    }
    sums[0] + tail
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partial_sums_are_added_in_pairs_of_neighbours() {
        // A large pair cancels exactly only where its two lanes are added first.
        let values = [1e30, -1e30, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.5];
        assert_eq!(interleaved_dot::<8>(&values, &[1.0; 9]), 21.5);
        assert_eq!(interleaved_dot::<4>(&[1e30, -1e30, 1.0, 2.0, 0.5], &[1.0; 5]), 3.5);
        assert_eq!(interleaved_dot::<4>(&[], &[]), 0.0);
    }

    #[test]
    fn every_order_gives_the_inner_product() {
        let values: Vec<f64> = (1..=21).map(f64::from).collect();
        let expected = 21.0 * 22.0 * 43.0 / 6.0;
        assert_eq!(dot(&values, &values), expected);
        assert_eq!(interleaved_dot::<4>(&values, &values), expected);
        assert_eq!(interleaved_dot::<8>(&values, &values), expected);
        assert_eq!(norm(&[3.0, 4.0]), 5.0);
    }
}

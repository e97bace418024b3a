//! Derivatives of a series that is sampled evenly within segments, by central differences of sixth order (Fornberg 1988).

use std::ops::Range;

/// First derivative by the sixth-order central difference, lower order near the ends of a segment.
pub(crate) fn first_derivative(series: &[f64], segments: &[Range<usize>], period: f64) -> Vec<f64> {
    differentiate(series, segments, |at| {
        (45.0 * (at(1) - at(-1)) - 9.0 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60.0 * period)
    })
}

/// Second derivative by the sixth-order central difference.
pub(crate) fn second_derivative(series: &[f64], segments: &[Range<usize>], period: f64) -> Vec<f64> {
    differentiate(series, segments, |at| {
        (270.0 * (at(1) + at(-1)) - 27.0 * (at(2) + at(-2)) + 2.0 * (at(3) + at(-3)) - 490.0 * at(0))
            / (180.0 * period * period)
    })
}

/// Applies a stencil of three samples on each side; beyond an end the series continues by odd reflection.
fn differentiate(
    series: &[f64],
    segments: &[Range<usize>],
    stencil: impl Fn(&dyn Fn(isize) -> f64) -> f64,
) -> Vec<f64> {
    let mut derivative = vec![0.0; series.len()];
    for segment in segments.iter().filter(|segment| segment.len() > 1) {
        let piece = &series[segment.clone()];
        let last = piece.len() as isize - 1;
        let value = |i: isize| {
            if i < 0 {
                2.0 * piece[0] - piece[(-i).min(last) as usize]
            } else if i > last {
                2.0 * piece[last as usize] - piece[(2 * last - i).max(0) as usize]
            } else {
                piece[i as usize]
            }
        };
        for i in 0..=last {
            derivative[segment.start + i as usize] = stencil(&|offset| value(i + offset));
        }
    }
    derivative
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_sine_are_exact_to_sixth_order() {
        let period = 1e-3;
        let omega = std::f64::consts::TAU * 20.0;
        let sine: Vec<f64> = (0..1000).map(|i| (omega * period * i as f64).sin()).collect();
        let segments = vec![0..1000];
        let first = first_derivative(&sine, &segments, period);
        let second = second_derivative(&sine, &segments, period);
        for i in 10..990 {
            let phase = omega * period * i as f64;
            assert!((first[i] / omega - phase.cos()).abs() < 1e-6);
            assert!((second[i] / (omega * omega) + phase.sin()).abs() < 1e-6);
        }
    }
}

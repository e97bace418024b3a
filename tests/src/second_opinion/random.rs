//! Random details of a case: one seed, one recording.

pub use frikan_trainer::kan::Random;

/// A factor between 0.8 and 1.25, as likely above one as below.
pub fn factor(random: &mut Random) -> f64 {
    1.25f64.powf(random.uniform(-1.0, 1.0))
}

/// An angle of a full turn, rad.
pub fn phase(random: &mut Random) -> f64 {
    random.uniform(0.0, std::f64::consts::TAU)
}

/// A number below `count`, which is not zero.
pub fn below(random: &mut Random, count: usize) -> usize {
    ((random.unit() * count as f64) as usize).min(count - 1)
}

/// One of several.
pub fn pick<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[below(random, of.len())]
}

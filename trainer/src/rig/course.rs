//! Which way the loop is asked to go: a motion of the set, or a reference of the user's own.

use frikan_runtime::controller::Target;

use super::motion::Motion;

/// What a run follows.
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    /// A motion of the set, with what disturbs it.
    Standard(Motion),
    /// Targets sample by sample; the last one is held.
    Recorded(Vec<Target>),
}

impl Course {
    /// A course through `positions`, rad, at `rate` samples a second: velocity and acceleration are central differences.
    #[must_use]
    pub fn through(positions: &[f64], rate: f64) -> Self {
        let at = |index: usize| positions[index.min(positions.len() - 1)];
        let targets = (0..positions.len()).map(|index| {
            let (before, here, after) = (at(index.saturating_sub(1)), at(index), at(index + 1));
            Target {
                position: here as f32,
                velocity: (0.5 * rate * (after - before)) as f32,
                acceleration: (rate * rate * (after - 2.0 * here + before)) as f32,
            }
        });
        Self::Recorded(targets.collect())
    }

    /// Its name: that of the motion, or `recorded`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Standard(motion) => motion.name(),
            Self::Recorded(_) => "recorded",
        }
    }

    /// How long it is run unless told otherwise, s, at `rate` samples a second.
    #[must_use]
    pub fn duration(&self, rate: f64) -> f64 {
        match self {
            Self::Standard(motion) => motion.duration(),
            Self::Recorded(targets) => targets.len() as f64 / rate,
        }
    }

    /// The target of a sample; none where there is no position loop.
    #[must_use]
    pub fn target(&self, index: usize, rate: f64) -> Option<Target> {
        match self {
            Self::Standard(motion) => motion.target(index as f64 / rate),
            Self::Recorded(targets) => targets.get(index).or(targets.last()).copied(),
        }
    }

    /// The motion of the set that it is.
    #[must_use]
    pub fn motion(&self) -> Option<Motion> {
        match self {
            Self::Standard(motion) => Some(*motion),
            Self::Recorded(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_velocity_and_acceleration() {
        let rate = 100.0;
        let positions: Vec<f64> = (0..50).map(|k| (f64::from(k) / rate).powi(2)).collect();
        let course = Course::through(&positions, rate);
        let target = course.target(20, rate).unwrap();
        assert!(
            (f64::from(target.velocity) - 0.4).abs() < 1e-6 && (target.acceleration - 2.0).abs() < 1e-4,
            "{target:?}"
        );
        assert_eq!(course.target(1000, rate), course.target(49, rate));
        assert_eq!(course.duration(rate), 0.5);
    }
}

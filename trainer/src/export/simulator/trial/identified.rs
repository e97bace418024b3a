//! The joint as identified, in steps so fine that the step does not matter.

use super::scheme::{Drive, Motion};

/// Longest step, s.
const FINEST_STEP_S: f64 = 1e-4;

/// Fewest steps within one of the simulator's.
const FEWEST_STEPS: usize = 5;

/// Friction over velocity with presliding, on an inertia.
#[derive(Clone, Debug)]
pub(crate) struct IdentifiedJoint {
    /// kg m2 (kg).
    pub(crate) inertia: f64,
    /// Friction but for presliding at equal distances of the velocity from `-top` to `top`, N m (N).
    pub(crate) friction: Vec<f64>,
    /// rad/s (m/s).
    pub(crate) top: f64,
    /// Torque and distance of each element of presliding, N m and rad (N and m), above 0: at a reversal the torque comes back over the
    /// distance.
    pub(crate) presliding: Vec<[f64; 2]>,
}

/// Where the joint is, and the share of each element of presliding that is strained, from -1 to 1.
#[derive(Clone, Debug)]
pub(crate) struct FineMotion {
    pub(crate) at: Motion,
    shares: Vec<f64>,
}

impl IdentifiedJoint {
    /// A joint at a place and velocity.
    pub(crate) fn starting(&self, q: f64, v: f64) -> FineMotion {
        let at = Motion { q, v, z: 0.0 };
        FineMotion { at, shares: vec![v.signum(); self.presliding.len()] }
    }

    /// Advances by a step of the simulator.
    pub(crate) fn step(&self, motion: &mut FineMotion, drive: Drive, other: &impl Fn(f64) -> f64, step: f64) {
        let count = FEWEST_STEPS.max((step / FINEST_STEP_S).ceil() as usize);
        let fine = step / count as f64;
        for _ in 0..count {
            let at = &mut motion.at;
            let (mut friction, mut slope) = self.friction_at(at.v);
            for ([torque, distance], share) in self.presliding.iter().zip(&motion.shares) {
                friction += torque * share;
                slope = slope.max(fine * torque / distance);
            }
            let force = drive.torque(at.q, at.v) + other(at.q) - friction;
            at.v += fine * force / (self.inertia + fine * slope);
            let moved = fine * at.v;
            at.q += moved;
            for ([_, distance], share) in self.presliding.iter().zip(&mut motion.shares) {
                let kept = (-moved.abs() / distance).exp();
                *share = *share * kept + (1.0 - kept) * moved.signum();
            }
        }
    }

    /// Friction and its slope over the velocity where that is not negative; beyond the table as at its end.
    fn friction_at(&self, v: f64) -> (f64, f64) {
        let cells = self.friction.len() - 1;
        let width = 2.0 * self.top / cells as f64;
        let place = ((v + self.top) / width).clamp(0.0, cells as f64);
        let cell = (place as usize).min(cells - 1);
        let rise = self.friction[cell + 1] - self.friction[cell];
        (self.friction[cell] + rise * (place - cell as f64), (rise / width).max(0.0))
    }
}

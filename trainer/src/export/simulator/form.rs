//! Reduced forms of a friction law: what the parameters of a simulator can express.

use super::law::FrictionCurve;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::root_mean_square;

/// Share of the error that a richer form leaves of a simpler one's where it is worth its parameters.
pub(super) const WORTH_IT: f64 = 0.9;

/// Stribeck velocities that are tried, each a step above the last.
const STRIBECK_VELOCITIES: usize = 48;

/// Most friction at rest, as a ratio to the largest dry friction of the law at any speed.
const MOST_AT_REST: f64 = 1.15;

/// `sign(v) (coulomb + excess exp(-(v / stribeck_velocity)^2)) + a v + b v |v| + c v^3` with `a, b, c` of `damping`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Form {
    /// N m or N, at least 0.
    pub(super) coulomb: f64,
    /// Static minus Coulomb friction, N m or N, at least 0.
    pub(super) excess: f64,
    /// rad/s or m/s; 0 where there is no excess.
    pub(super) stribeck_velocity: f64,
    /// N m s/rad, N m s2/rad2, N m s3/rad3 (N s/m and so on of a linear axis).
    pub(super) damping: [f64; 3],
}

/// What a form leaves of a law, over the velocities at which the law has risen. N m or N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Deviation {
    pub(super) rms: f64,
    pub(super) max: f64,
    /// Root mean square of the law itself.
    pub(super) law: f64,
}

impl Form {
    /// Friction torque at a velocity, in its sign.
    pub(super) fn torque(&self, v: f64) -> f64 {
        let peak = if self.excess > 0.0 { self.excess * (-(v / self.stribeck_velocity).powi(2)).exp() } else { 0.0 };
        let [a, b, c] = self.damping;
        v.signum() * (self.coulomb + peak) + a * v + b * v * v.abs() + c * v * v * v
    }

    /// What this form leaves of a law.
    pub(super) fn deviation(&self, curve: &FrictionCurve) -> Deviation {
        let rest: Vec<f64> =
            curve.sliding().map(|place| curve.torque[place] - self.torque(curve.velocity[place])).collect();
        let law: Vec<f64> = curve.sliding().map(|place| curve.torque[place]).collect();
        let max = rest.iter().fold(0.0f64, |most, rest| most.max(rest.abs()));
        Deviation { rms: root_mean_square(&rest), max, law: root_mean_square(&law) }
    }

    /// Friction at rest: the torque at which motion begins.
    pub(super) fn at_rest(&self) -> f64 {
        self.coulomb + self.excess
    }

    /// Whether it takes energy at every speed of the law, and neither dry friction nor linear damping gives any.
    fn dissipates(&self, curve: &FrictionCurve) -> bool {
        let parts = [self.coulomb, self.excess, self.damping[0]];
        parts.iter().all(|part| *part >= 0.0) && curve.velocity.iter().all(|v| self.torque(*v) * v >= 0.0)
    }

    /// Coulomb and viscous friction nearest to the law. Neither drives the joint: where one would, the better of the two stands alone.
    pub(super) fn coulomb_viscous(curve: &FrictionCurve) -> Self {
        let both = fitted(curve, None, 1);
        if both.dissipates(curve) {
            return both;
        }
        let coulomb = fitted(curve, None, 0);
        let viscous = Self { coulomb: 0.0, ..viscous_alone(curve) };
        let sole = [coulomb, viscous].map(|form| Self { coulomb: form.coulomb.max(0.0), ..form });
        let [left, right] = sole.map(|form| form.deviation(curve).rms);
        if left <= right { sole[0] } else { sole[1] }
    }

    /// Coulomb friction and damping in powers of the velocity up to the third; `None` where that would drive the joint.
    pub(super) fn polynomial(curve: &FrictionCurve) -> Option<Self> {
        Some(fitted(curve, None, 3)).filter(|form| form.dissipates(curve))
    }

    /// Stribeck friction with damping in so many powers of the velocity; `None` where none of them lies within bounds.
    pub(super) fn stribeck(curve: &FrictionCurve, powers: usize) -> Option<Self> {
        let (lowest, top) = (2.0 * curve.risen, 0.7 * curve.top());
        let step = (top / lowest).ln() / (STRIBECK_VELOCITIES - 1) as f64;
        let velocities = (0..STRIBECK_VELOCITIES).map(|place| lowest * (step * place as f64).exp());
        velocities
            .map(|velocity| fitted(curve, Some(velocity), powers))
            .filter(|form| form.dissipates(curve))
            // Below the speeds that are fitted a peak must not grow beyond what the law has.
            .filter(|form| form.at_rest() <= MOST_AT_REST * curve.largest_dry(form.damping[0]))
            .map(|form| (form.deviation(curve).rms, form))
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, form)| form)
    }
}

/// Least squares of the law, over the speeds at which it has risen, on dry friction, a Stribeck peak and powers of the velocity.
fn fitted(curve: &FrictionCurve, stribeck_velocity: Option<f64>, powers: usize) -> Form {
    let mut columns: Vec<Box<dyn Fn(f64) -> f64>> = vec![Box::new(f64::signum)];
    if let Some(width) = stribeck_velocity {
        columns.push(Box::new(move |v| v.signum() * (-(v / width).powi(2)).exp()));
    }
    for power in 0..powers {
        columns.push(Box::new(move |v| v * v.abs().powi(power as i32)));
    }
    let coefficients = regression(curve, &columns);
    let (dry, rest) = coefficients.split_at(columns.len() - powers);
    let mut form = Form { coulomb: dry[0], ..Form::default() };
    if let Some(width) = stribeck_velocity {
        (form.excess, form.stribeck_velocity) = (dry[1], width);
    }
    form.damping.iter_mut().zip(rest).for_each(|(damping, value)| *damping = *value);
    form
}

fn viscous_alone(curve: &FrictionCurve) -> Form {
    let coefficients = regression(curve, &[Box::new(|v| v)]);
    Form { damping: [coefficients[0].max(0.0), 0.0, 0.0], ..Form::default() }
}

fn regression(curve: &FrictionCurve, columns: &[Box<dyn Fn(f64) -> f64>]) -> Vec<f64> {
    let places: Vec<usize> = curve.sliding().collect();
    let torque: Vec<f64> = places.iter().map(|place| curve.torque[*place]).collect();
    let columns: Vec<Vec<f64>> =
        columns.iter().map(|column| places.iter().map(|place| column(curve.velocity[*place])).collect()).collect();
    least_squares(&columns, &torque, &[0..torque.len()]).coefficients
}

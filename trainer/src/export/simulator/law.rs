//! The friction of an image over velocity, as a simulator that knows nothing but the velocity can have it.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::effect::Effect;
use frikan_shared::model::{Input, MAX_INPUTS};
use frikan_shared::units::Quantity;

use crate::error::{Error, Result, codes};
use crate::fit::HostModel;

/// Velocities of each direction at which the law is asked: thin enough for a Stribeck peak of a hundredth of the range.
const VELOCITIES: usize = 1000;

/// The same of the table for a trial, which follows the law through rest.
const TABLE_VELOCITIES: usize = 10_000;

/// Share of the largest torque beyond the viscous part at which a smoothed sign counts as risen.
const RISEN: f64 = 0.9;

/// Friction torque over velocity: the static law with the terms that depend on nothing but the velocity, other inputs in the middle
/// of their trained range, and load-dependent friction at its mean over that of the load.
#[derive(Clone, Debug)]
pub(super) struct FrictionCurve {
    /// rad/s or m/s, both directions, within the trained range.
    pub(super) velocity: Vec<f64>,
    /// N m or N, in the sign of the velocity, without `offset`.
    pub(super) torque: Vec<f64>,
    /// What the law has of both directions alike, N m or N: a constant torque beside friction.
    pub(super) offset: f64,
    /// Speed above which the smoothed sign of the law has risen; below it a simulator's own friction at rest stands in.
    pub(super) risen: f64,
    /// The torque at equal distances of the velocity from minus to plus the largest speed; a direction that is not trained is taken to
    /// be as the other.
    pub(super) table: Vec<f64>,
}

impl FrictionCurve {
    /// The friction of a model, `torque_per_unit` N m or N for each unit of its output.
    ///
    /// # Errors
    /// `FRK-U001` for a law that does not depend on the velocity.
    pub(super) fn of(model: &HostModel, torque_per_unit: f64) -> Result<Self> {
        let place = model.inputs.iter().position(|input| input.quantity == Quantity::Velocity);
        let place = place.ok_or_else(|| Error::new(&codes::USAGE, "this law does not depend on the velocity"))?;
        let Input { low, high, .. } = model.inputs[place];
        let mut at = [0.0; MAX_INPUTS];
        at.iter_mut().zip(&model.inputs).for_each(|(channel, input)| *channel = 0.5 * (input.low + input.high));
        let fastest = low.abs().max(high.abs());
        let shares = (1..=VELOCITIES).map(|i| i as f32 / VELOCITIES as f32);
        let velocities: Vec<f32> = shares
            .flat_map(|share| [-share * fastest, share * fastest])
            .filter(|velocity| (low..=high).contains(velocity))
            .collect();
        let load = Load::of(model);
        let mut torque_at = |velocity: &f32| {
            at[place] = *velocity;
            let effects = model.effects.iter().filter_map(|effect| of_velocity(effect, f64::from(*velocity), load));
            torque_per_unit * (f64::from(evaluate(model, &at)) + effects.sum::<f64>())
        };
        let mut torque: Vec<f64> = velocities.iter().map(&mut torque_at).collect();
        let offset = common(&velocities, &torque);
        torque.iter_mut().for_each(|torque| *torque -= offset);
        let velocity: Vec<f64> = velocities.iter().map(|velocity| f64::from(*velocity)).collect();
        let risen = risen(&velocity, &torque);
        let mut table = vec![0.0; 2 * TABLE_VELOCITIES + 1];
        for place in 1..=TABLE_VELOCITIES {
            let speed = place as f32 / TABLE_VELOCITIES as f32 * fastest;
            let forward = (speed <= high).then(|| torque_at(&speed) - offset);
            let backward = (-speed >= low).then(|| torque_at(&-speed) - offset);
            table[TABLE_VELOCITIES + place] = forward.or(backward.map(|torque| -torque)).unwrap_or(0.0);
            table[TABLE_VELOCITIES - place] = backward.or(forward.map(|torque| -torque)).unwrap_or(0.0);
        }
        Ok(Self { velocity, torque, offset, risen, table })
    }

    /// Places above the speed at which the law has risen.
    pub(super) fn sliding(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.velocity.len()).filter(|place| self.velocity[*place].abs() >= self.risen)
    }

    /// Largest torque beyond a viscous part, N m or N.
    pub(super) fn largest_dry(&self, viscous: f64) -> f64 {
        let dry =
            |place: usize| self.torque[place] * self.velocity[place].signum() - viscous * self.velocity[place].abs();
        self.sliding().map(dry).fold(0.0, f64::max)
    }

    /// Largest speed.
    pub(super) fn top(&self) -> f64 {
        self.velocity.iter().fold(0.0, |most, velocity| most.max(velocity.abs()))
    }
}

/// A load that takes every value of its trained range as often.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Load {
    /// Mean of its magnitude, in the unit of the model.
    magnitude: f64,
    /// Mean of its square.
    square: f64,
}

impl Load {
    fn of(model: &HostModel) -> Self {
        let Some(input) = model.inputs.iter().find(|input| input.quantity == Quantity::Load) else {
            return Self::default();
        };
        let [low, high] = [input.low, input.high].map(f64::from);
        // Antiderivatives of |x| and x^2 between the ends.
        let mean = |of: &dyn Fn(f64) -> f64| (of(high) - of(low)) / (high - low);
        Self { magnitude: mean(&|x| 0.5 * x * x.abs()), square: mean(&|x| x.powi(3) / 3.0) }
    }
}

/// Torque of an effect that depends on nothing but the velocity, or on the load too, in the unit of the model; `None` for any other.
pub(super) fn of_velocity(effect: &Effect, v: f64, load: Load) -> Option<f64> {
    let sign = |smoothing: &f32| (v / f64::from(*smoothing)).tanh();
    let [a, b] = match effect {
        Effect::Coulomb { coulomb, viscous, smoothing_velocity } => {
            [f64::from(*coulomb) * sign(smoothing_velocity), f64::from(*viscous) * v]
        }
        Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => {
            let decay = (-(v.abs() / f64::from(*velocity)).powf(f64::from(*exponent))).exp();
            [f64::from(*amplitude) * decay * sign(smoothing_velocity), 0.0]
        }
        Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => {
            [f64::from(*coefficient) * v.abs().powf(f64::from(*exponent)) * sign(smoothing_velocity), 0.0]
        }
        Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => {
            [f64::from(*coulomb) * sign(smoothing_velocity).abs(), f64::from(*viscous) * v.abs()]
        }
        Effect::Load { mean, quadratic, stribeck, velocity, smoothing_velocity, .. } => {
            let at_rest = f64::from(*stribeck) * (-(v / f64::from(*velocity)).powi(2)).exp();
            let constant = (f64::from(*mean) + at_rest) * load.magnitude + f64::from(*quadratic) * load.square;
            [constant * sign(smoothing_velocity), 0.0]
        }
        _ => return None,
    };
    Some(a + b)
}

/// Mean of what neighbouring velocities of opposite sign have in common; 0 where only one direction is trained.
fn common(velocity: &[f32], torque: &[f64]) -> f64 {
    let pairs = velocity.windows(2).zip(torque.windows(2)).filter(|(velocity, _)| velocity[0] == -velocity[1]);
    let (count, sum) = pairs.fold((0.0, 0.0), |(count, sum), (_, torque)| (count + 2.0, sum + torque[0] + torque[1]));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The lowest speed at which what the law has beyond its viscous part, taken from the upper half of the speeds, is nearly at its largest.
fn risen(velocity: &[f64], torque: &[f64]) -> f64 {
    let top = velocity.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let upper = velocity.iter().zip(torque).filter(|(v, _)| v.abs() > 0.5 * top);
    let (mut n, mut sums) = (0.0, [0.0; 4]);
    for (v, t) in upper {
        let (speed, torque) = (v.abs(), t * v.signum());
        n += 1.0;
        sums = [sums[0] + speed, sums[1] + torque, sums[2] + speed * speed, sums[3] + speed * torque];
    }
    let spread = n * sums[2] - sums[0] * sums[0];
    let slope = if spread > 0.0 { ((n * sums[3] - sums[0] * sums[1]) / spread).max(0.0) } else { 0.0 };
    let dry = |place: usize| torque[place] * velocity[place].signum() - slope * velocity[place].abs();
    let largest = (0..velocity.len()).map(dry).fold(0.0, f64::max);
    (0..velocity.len())
        .filter(|place| dry(*place) >= RISEN * largest)
        .map(|place| velocity[place].abs())
        .fold(top, f64::min)
}

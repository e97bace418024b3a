//! A torque of the wrong sign: recorded so, friction would drive the joint and inertia help it along.
//!
//! Work alone proves nothing: a load that is lowered, a body that another joint swings, gravity and what an inertia gives back all drive an
//! actuator. So the law carries gravity, recorded couplings and inertia, and a sign is called wrong only where friction gives energy, the
//! actuator as recorded takes up more than it gives, and inertia or a given body have the wrong sign as well. Where the motion is too slow
//! for inertia to show, Coulomb friction has to be a good part of what the torque does: a controller that brakes a driven joint looks
//! viscous. Beside another joint that is recorded the inertia is no witness, and Coulomb friction has to be a larger part: that joint may
//! drive this one.

use super::one_way::lesser_share;
use crate::checks::law::Law;
use crate::checks::motion::{smooth, torque};
use crate::checks::note::{Fault, Note};
use crate::joint::Joint;
use crate::numerics::statistics::{mean, root_mean_square};
use crate::recording::Recording;
use crate::samples::VelocitySource;

/// Share of the variance that the law has to explain: of a torque it does not describe it tells no sign.
const LEAST_EXPLAINED: f64 = 0.5;
/// Standard errors from which a figure has a sign, those of blocks being few and their noise coloured.
const CLEAR: f64 = 4.0;
/// Power of friction over the power that the torque exchanges, least; and that of its Coulomb part where nothing else is a witness.
const LEAST_POWER_SHARE: f64 = 0.05;
const COULOMB_POWER_SHARE: f64 = 0.25;
const COULOMB_POWER_SHARE_BESIDE_OTHERS: f64 = 0.4;
/// Share of the torque, root mean square, from which an inertia shows: hysteresis passes for a few per cent of either sign.
const LEAST_INERTIA_SHARE: f64 = 0.1;
/// Share of the travel that has to go in the lesser direction: in one alone a load that is let down is no friction.
const LEAST_RETURN: f64 = 0.05;

/// Notes a torque of the wrong sign.
pub(in crate::checks) fn wrong_sign(recording: &Recording, joint: &Joint) -> Option<Note> {
    let samples = smooth(recording, VelocitySource::Derived)?;
    let law = Law::of(&samples)?;
    let (velocity, torque) = (samples.velocity.as_deref()?, torque(&samples)?);
    if law.explained < LEAST_EXPLAINED || lesser_share(velocity) < LEAST_RETURN {
        return None;
    }
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<f64>>();
    let power = |column: usize| mean(&product(velocity, &law.columns.values[column]));
    let exchanged = mean(&product(velocity, torque).iter().map(|power| power.abs()).collect::<Vec<_>>());
    let work = product(velocity, torque).iter().sum::<f64>() / samples.rate_hz?;
    // Mean power that friction takes up: Coulomb level times mean |v|, viscous coefficient times mean v2.
    let [coulomb, viscous] = [law.columns.coulomb, law.columns.viscous];
    let dissipation = law.combination(&[(coulomb, power(coulomb)), (viscous, power(viscous))]);
    let of_coulomb = law.combination(&[(coulomb, power(coulomb))]);
    let is_negative = |(value, error): (f64, f64)| value < -CLEAR * error;
    let is_positive = |(value, error): (f64, f64)| value > CLEAR * error;
    let is_alone = law.columns.couplings.is_empty();
    let witnesses = [law.inertia(torque), law.body(), law.gravity(recording, joint)];
    let agrees = witnesses.into_iter().skip(usize::from(!is_alone)).flatten().any(is_negative);
    let contradicts = witnesses.into_iter().flatten().any(is_positive);
    let least_coulomb = if is_alone { COULOMB_POWER_SHARE } else { COULOMB_POWER_SHARE_BESIDE_OTHERS };
    let is_friction = is_negative(of_coulomb) && of_coulomb.0 < -least_coulomb * exchanged;
    let is_wrong = is_negative(dissipation)
        && dissipation.0 < -LEAST_POWER_SHARE * exchanged
        && work < 0.0
        && !contradicts
        && (agrees || is_friction);
    is_wrong.then(|| Note::of_all(Fault::WrongSign { work, dissipation: [dissipation.0, dissipation.1] }))
}

impl Law {
    /// Value and standard error of a weighted sum of coefficients.
    fn combination(&self, weighted: &[(usize, f64)]) -> (f64, f64) {
        let mut weights = vec![0.0; self.columns.values.len()];
        weighted.iter().for_each(|(column, weight)| weights[*column] = *weight);
        self.fit.combination(&weights)
    }

    /// The inertia, where it shows in the torque.
    fn inertia(&self, torque: &[f64]) -> Option<(f64, f64)> {
        let column = self.columns.inertia?;
        let share = self.fit.coefficients[column].abs() * root_mean_square(&self.columns.values[column])
            / root_mean_square(torque);
        (share > LEAST_INERTIA_SHARE).then(|| self.combination(&[(column, 1.0)]))
    }

    /// Factor of a recorded rigid body.
    fn body(&self) -> Option<(f64, f64)> {
        self.columns.body.map(|column| self.combination(&[(column, 1.0)]))
    }

    /// What the torque has of the gravity that the joint file gives, in the unit of the actuator.
    fn gravity(&self, recording: &Recording, joint: &Joint) -> Option<(f64, f64)> {
        let [sine, cosine] = self.columns.gravity?;
        let given =
            joint.rigid_body.gravity_torque_nm.filter(|torque| *torque != 0.0 && self.columns.body.is_none())?;
        joint.actuator_per_torque(recording.actuator()?.unit).ok()?;
        let phase = joint.rigid_body.gravity_phase_rad.unwrap_or(0.0);
        let sign = given.signum();
        Some(self.combination(&[(sine, sign * phase.cos()), (cosine, sign * phase.sin())]))
    }
}

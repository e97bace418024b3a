//! Takes the rigid body off the actuator's torque: given parameters are subtracted, the others identified together
//! with a friction law that is free to bend (linear least squares; Swevers et al. 1997).

use super::bending::BendingLaw;
use super::lead::added_by_lead;
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::least_squares::weighted;
use crate::numerics::regression::least_squares;
use crate::recording::Axis;
use crate::samples::Samples;
use crate::samples::states::States;

/// Gravity is asked for where the position covers at least this, rad; below, it cannot be told from an offset.
const GRAVITY_RANGE_RAD: f64 = 0.5;
/// Below this share of the top speed friction is no function of velocity; such samples do not enter the fit.
const REST_SHARE: f64 = 0.001;
/// Samples of one direction needed to tell an offset from friction, as a share.
const DIRECTION_SHARE: f64 = 0.05;
/// What a rigid-body term stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermKind {
    /// Torque per acceleration: the whole inertia.
    Inertia,
    /// Torque per acceleration beside a recorded rigid-body torque.
    ExtraInertia,
    /// Torque per sin(position).
    GravitySine,
    /// Torque per cos(position).
    GravityCosine,
    /// Factor on the recorded rigid-body torque.
    TorqueScale,
    /// Constant torque.
    TorqueOffset,
}

impl TermKind {
    /// Whether it is torque per acceleration.
    #[must_use]
    pub fn is_inertia(self) -> bool {
        matches!(self, Self::Inertia | Self::ExtraInertia)
    }

    /// Name in reports and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertia => "inertia",
            Self::ExtraInertia => "extra_inertia",
            Self::GravitySine => "gravity_sine",
            Self::GravityCosine => "gravity_cosine",
            Self::TorqueScale => "torque_scale",
            Self::TorqueOffset => "torque_offset",
        }
    }

    /// Unit, from the axis and the unit of the actuator.
    #[must_use]
    pub fn unit(self, axis: Axis, actuator_unit: &str) -> String {
        match self {
            Self::TorqueScale => String::new(),
            Self::GravitySine | Self::GravityCosine | Self::TorqueOffset => actuator_unit.to_owned(),
            Self::Inertia | Self::ExtraInertia => match (axis, actuator_unit) {
                (Axis::Rotary, "Nm") => "kgm2".to_owned(),
                (Axis::Linear, "N") => "kg".to_owned(),
                (Axis::Rotary, unit) => format!("{unit}s2/rad"),
                (Axis::Linear, unit) => format!("{unit}s2/m"),
            },
        }
    }
}

/// A rigid-body term that is linear in its parameter.
#[derive(Clone, Debug)]
pub struct Term {
    /// What it stands for.
    pub kind: TermKind,
    /// Torque per unit of the parameter, one value a sample.
    pub column: Vec<f64>,
}

/// A parameter of the rigid body with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// What it stands for.
    pub kind: TermKind,
    /// Estimate, SI.
    pub value: f64,
    /// Standard error, with coloured noise counted.
    pub standard_error: f64,
}

/// Actuator torque taken apart: actuator = given + sum of parameter * column + friction.
#[derive(Clone, Debug)]
pub struct Separation {
    /// Identified terms with their columns.
    pub terms: Vec<Term>,
    /// Estimates, in the order of `terms`.
    pub parameters: Vec<Parameter>,
    /// Torque of the parameters given in `joint.toml`; zero where none is given.
    pub given: Vec<f64>,
    /// Rigid-body torque at every sample, given and identified, offset included.
    pub rigid_body: Vec<f64>,
    /// What friction averaged over the states of a sample is more than friction at its velocity; zero where it is not averaged.
    pub bend: Vec<f64>,
    /// What friction adds that turns over before the velocity, and softly; zero everywhere where that does not show.
    pub lead: Vec<f64>,
    /// Actuator minus rigid body, bend and lead: friction with everything that is not yet explained.
    pub friction: Vec<f64>,
    /// Root mean square of what the bending friction law leaves.
    pub rmse: f64,
    /// Directions in which the columns of the terms are collinear with each other or with friction; zero when every parameter is determined.
    pub rank_deficiency: usize,
    given_inertia: f64,
}

impl Separation {
    /// Inertia in force, given or identified, actuator unit per acceleration.
    #[must_use]
    pub fn inertia(&self) -> f64 {
        let identified = |parameter: &&Parameter| parameter.kind.is_inertia();
        self.given_inertia + self.parameters.iter().find(identified).map_or(0.0, |parameter| parameter.value)
    }
}

/// The torque of the rigid-body parameters given in `joint.toml`, in the unit of the actuator, at every sample:
/// inertia * acceleration + gravity_torque * sin(position + phase), and the recorded one where it is right as it is.
///
/// # Errors
/// `FRK-D014` when the actuator is a current and no torque constant is known, `FRK-D009` when position is missing.
pub fn given_torque(samples: &Samples, joint: &Joint) -> Result<Vec<f64>> {
    let body = &joint.rigid_body;
    let recorded = samples.rigid_body.clone().filter(|_| body.recorded_is_exact);
    let mut torque = recorded.unwrap_or_else(|| vec![0.0; samples.len()]);
    if body.inertia_kgm2.is_none() && body.gravity_torque_nm.is_none() {
        return Ok(torque);
    }
    let per_nm = joint.actuator_per_torque(samples.actuator_unit)?;
    if let Some((inertia, acceleration)) = body.inertia_kgm2.zip(samples.acceleration.as_deref()) {
        for (sum, a) in torque.iter_mut().zip(acceleration) {
            *sum += per_nm * inertia * a;
        }
    }
    // Without gravity the position does not matter, and a drive's own log may have none.
    if let Some(gravity) = body.gravity_torque_nm.filter(|gravity| *gravity != 0.0) {
        let position = samples.position.as_deref().ok_or_else(|| {
            Error::new(&codes::MISSING_COLUMN, "the gravity torque of joint.toml needs a position")
                .in_column("position_rad")
        })?;
        let phase = body.gravity_phase_rad.unwrap_or(0.0);
        for (row, (sum, q)) in torque.iter_mut().zip(position).enumerate() {
            *sum += per_nm * gravity * samples.passed_share_of_sine(row) * (q + phase).sin();
        }
    }
    Ok(torque)
}

/// The rigid-body terms that these samples ask to be identified: those that `joint.toml` does not give.
///
/// Beside a recorded rigid-body torque these are its scale, extra inertia and offset, or the offset alone where it is right as it is; otherwise inertia, gravity on a
/// rotary axis whose position covers enough, and offset where both directions are present.
#[must_use]
pub fn terms(samples: &Samples, joint: &Joint) -> Vec<Term> {
    let mut terms = Vec::new();
    let body = &joint.rigid_body;
    let mut push = |kind, column: Vec<f64>| terms.push(Term { kind, column });
    let is_exact = body.recorded_is_exact && samples.rigid_body.is_some();
    if let Some(recorded) = samples.rigid_body.as_ref().filter(|_| !is_exact) {
        push(TermKind::TorqueScale, recorded.clone());
    }
    if let Some(acceleration) = samples.acceleration.as_ref().filter(|_| body.inertia_kgm2.is_none() && !is_exact) {
        let kind = if samples.rigid_body.is_some() { TermKind::ExtraInertia } else { TermKind::Inertia };
        push(kind, acceleration.clone());
    }
    let gravity_asked =
        samples.axis == Axis::Rotary && samples.rigid_body.is_none() && body.gravity_torque_nm.is_none();
    if let Some(position) = samples.position.as_deref().filter(|q| gravity_asked && range(q) >= GRAVITY_RANGE_RAD) {
        let passed = |of: fn(f64) -> f64| {
            position.iter().enumerate().map(|(row, q)| samples.passed_share_of_sine(row) * of(*q)).collect()
        };
        push(TermKind::GravitySine, passed(f64::sin));
        push(TermKind::GravityCosine, passed(f64::cos));
    }
    if samples.velocity.as_deref().is_some_and(both_directions) {
        push(TermKind::TorqueOffset, vec![1.0; samples.len()]);
    }
    terms
}

/// Identifies the rigid-body terms together with a friction law that is piecewise linear in velocity, and takes them
/// off the actuator's torque.
///
/// Both directions have a law of their own, so the offset is what they have in common: the mean of the two, averaged
/// over the speeds that were driven. An asymmetry of friction that is the same at all speeds is therefore counted as
/// offset, from which only samples at rest could tell it.
///
/// # Errors
/// `FRK-D009` when actuator or velocity is missing, `FRK-D014` as [`given_torque`], `FRK-D016` without motion.
pub fn separate(samples: &Samples, joint: &Joint) -> Result<Separation> {
    let moving = moving_samples(samples.require_velocity()?);
    separate_by(samples, joint, &moving, None)
}

/// The same on rows that average the law over states.
///
/// # Errors
/// As [`separate`].
pub(crate) fn separate_averaged(samples: &Samples, joint: &Joint, states: &States) -> Result<Separation> {
    separate_by(samples, joint, &states.rows, Some(states))
}

fn separate_by(samples: &Samples, joint: &Joint, moving: &[usize], states: Option<&States>) -> Result<Separation> {
    let actuator = samples.actuator.as_deref().ok_or_else(|| {
        Error::new(&codes::MISSING_COLUMN, "separating friction needs the torque, force or current of the actuator")
            .in_column("torque_Nm")
    })?;
    let given = given_torque(samples, joint)?;
    let terms = terms(samples, joint);
    let pick = |column: &[f64]| moving.iter().map(|&i| column[i]).collect::<Vec<f64>>();
    let moving_velocity = pick(samples.require_velocity()?);
    let law = BendingLaw::over(&moving_velocity)?;
    // The offset is no column of its own: the law holds it, and it is read off afterwards.
    let own_column: Vec<&Term> = terms.iter().filter(|term| term.kind != TermKind::TorqueOffset).collect();
    let mut columns: Vec<Vec<f64>> = own_column.iter().map(|term| pick(&term.column)).collect();
    let at_velocity = law.columns(&moving_velocity);
    columns.extend(match states {
        Some(states) => law.averaged_columns(&states.velocity, &states.averages),
        None => at_velocity.clone(),
    });
    let target: Vec<f64> = moving.iter().map(|&i| actuator[i] - given[i]).collect();
    let with_law = columns.len();
    let motion = states.zip(samples.acceleration.as_deref().map(pick));
    let lead = motion.and_then(|(states, acceleration)| added_by_lead(&columns, &target, (states, &acceleration)));
    columns.extend(lead);
    let fit = least_squares(&columns, &target, &even_blocks(target.len(), ERROR_BLOCKS));

    let mut parameters = Vec::with_capacity(terms.len());
    for (index, term) in own_column.iter().enumerate() {
        let (value, standard_error) = (fit.coefficients[index], fit.standard_error(index));
        parameters.push(Parameter { kind: term.kind, value, standard_error });
    }
    if own_column.len() < terms.len() {
        let mut weights = vec![0.0; own_column.len()];
        weights.extend(law.even_part(&moving_velocity));
        weights.resize(columns.len(), 0.0);
        let (value, standard_error) = fit.combination(&weights);
        parameters.push(Parameter { kind: TermKind::TorqueOffset, value, standard_error });
    }
    let mut rigid_body = given.clone();
    for (term, parameter) in terms.iter().zip(&parameters) {
        for (sum, x) in rigid_body.iter_mut().zip(&term.column) {
            *sum += parameter.value * x;
        }
    }
    let mut bend = vec![0.0; samples.len()];
    let of_law = own_column.len()..with_law;
    let averaged = weighted(&columns[of_law.clone()], &fit.coefficients[of_law.clone()]);
    let at_velocity = weighted(&at_velocity, &fit.coefficients[of_law]);
    for ((&row, averaged), at_velocity) in moving.iter().zip(averaged).zip(at_velocity) {
        bend[row] = averaged - at_velocity;
    }
    let mut lead = vec![0.0; samples.len()];
    if let Some((column, coefficient)) = columns.get(with_law).zip(fit.coefficients.get(with_law)) {
        moving.iter().zip(column).for_each(|(&row, added)| lead[row] = coefficient * added);
    }
    let taken_off = (0..samples.len()).map(|row| rigid_body[row] + bend[row] + lead[row]);
    let friction = actuator.iter().zip(taken_off).map(|(total, off)| total - off).collect();
    // Of a few constant speeds the law itself has shapes to spare between them.
    let rank_deficiency = if fit.rank_deficiency > 0 {
        let of_law =
            least_squares(&columns[own_column.len()..with_law], &target, &even_blocks(target.len(), ERROR_BLOCKS));
        fit.rank_deficiency.saturating_sub(of_law.rank_deficiency)
    } else {
        0
    };
    let given_inertia = joint
        .rigid_body
        .inertia_kgm2
        .zip(joint.actuator_per_torque(samples.actuator_unit).ok())
        .map_or(0.0, |(j, k)| j * k);
    Ok(Separation {
        terms,
        parameters,
        given,
        rigid_body,
        bend,
        lead,
        friction,
        rmse: fit.rmse,
        rank_deficiency,
        given_inertia,
    })
}

fn moving_samples(velocity: &[f64]) -> Vec<usize> {
    let top = velocity.iter().fold(0.0_f64, |peak, v| peak.max(v.abs()));
    (0..velocity.len()).filter(|&i| velocity[i].abs() > REST_SHARE * top).collect()
}

fn both_directions(velocity: &[f64]) -> bool {
    let moving = moving_samples(velocity);
    let forward = moving.iter().filter(|&&i| velocity[i] > 0.0).count() as f64;
    let total = moving.len() as f64;
    forward.min(total - forward) > DIRECTION_SHARE * total
}

fn range(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    highest - lowest
}

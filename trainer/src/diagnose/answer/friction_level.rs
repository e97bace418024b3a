//! Coulomb and viscous level of a simulation or a model against the recording: what the refit of the reference moved them by, beside
//! the effects that were found, and whether that is worth acting on.

use crate::diagnose::answer::location::Location;
use crate::diagnose::answer::outcome::{Estimate, Evidence, Finding};
use crate::diagnose::answer::stated_probability::WITHOUT_RIVAL;
use crate::diagnose::comparison::reference::sliding_friction;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::proof::discarded::torque_beside_rigid_body;
use crate::diagnose::proof::locked_rows::{prove, rest};
use crate::diagnose::proof::refit::Refit;
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::thresholds::{EQUAL_ERROR_RATIO, OTHER_ROWS_ERROR_RATIO};
use crate::numerics::covariance;
use crate::numerics::least_squares::{dot, least_squares, residual, weighted};
use crate::numerics::statistics::root_mean_square;
use crate::physics::{Dimension, EffectId};
use crate::samples::SLIDING_SPEED_SHARE;

/// Effects that scale Coulomb or viscous friction by a channel of their own: what of the level is theirs depends on the
/// value of the channel that they count from.
const FRICTION_SCALING_EFFECTS: [EffectId; 7] = [
    EffectId::Temperature,
    EffectId::WarmUp,
    EffectId::SlowDrift,
    EffectId::LoadFriction,
    EffectId::DriveBackdrive,
    EffectId::PositionFriction,
    EffectId::TorqueScale,
];

/// What became of the friction level of a reference.
pub(crate) enum FrictionLevel {
    /// The reference has the recording's level, or the recording cannot tell.
    Unchanged,
    /// It has to change, by a torque (root mean square) too small to act on.
    Small(f64),
    /// It has to change: the finding, its torque at every working row, and the refit of the base with the level as given.
    Wrong { finding: Box<Finding>, torque: Vec<f64>, as_given: Box<Refit> },
}

impl FrictionLevel {
    /// Judges the reference of a comparison. `least_effect` is the share of the torque beside the rigid body (root mean square) below which
    /// a change is not worth acting on.
    pub(crate) fn of(
        workbench: &Workbench,
        accepted: &[Accepted],
        baseline: &Refit,
        improved: &Refit,
        least_effect: f64,
    ) -> Self {
        let is_scaled = |found: &Accepted| FRICTION_SCALING_EFFECTS.contains(&found.effect());
        if accepted.iter().any(is_scaled) {
            return Self::Unchanged;
        }
        let given = improved.with_base_as_given(workbench);
        let Some(change) = Change::of(workbench, &given) else { return Self::Unchanged };
        let size = root_mean_square(&change.torque);
        let Some(proof) = prove(workbench, &given, improved) else { return Self::Unchanged };
        if proof.ratio_ci95[1] >= 1.0 {
            return Self::Unchanged;
        }
        let law_error = OTHER_ROWS_ERROR_RATIO * workbench.base.law_error();
        if size < law_error.max(least_effect * torque_beside_rigid_body(workbench)) {
            return Self::Small(size);
        }
        let evidence = Evidence::Rows { held_out_gain_nats: proof.gain_nats, family_wise: change.p_value(), rivals: 0 };
        let finding = Box::new(change.finding(workbench, evidence, proof.gain_nats));
        Self::Wrong { finding, torque: change.torque, as_given: Box::new(baseline.with_base_as_given(workbench)) }
    }
}

/// Coulomb and viscous friction that a reference lacks.
struct Change {
    /// Constants of the actuator by which the same torque may be missing.
    rivals: Vec<EffectId>,
    coefficients: Vec<f64>,
    deviation: Vec<f64>,
    torque: Vec<f64>,
}

impl Change {
    /// From what a refit with the level as given leaves on the open rows where the joint slides. `None` where these do not tell the two
    /// apart.
    fn of(workbench: &Workbench, given: &Refit) -> Option<Self> {
        let prepared = workbench.prepared;
        let columns = prepared.filtered_all(&[prepared.state.sign.clone(), prepared.state.velocity.clone()]);
        let sliding = SLIDING_SPEED_SHARE * prepared.state.top_speed();
        let slides: Vec<bool> = prepared.rows.iter().map(|&i| prepared.state.velocity[i].abs() >= sliding).collect();
        // What is wrong near rest is a matter of the curve and not of its level.
        let where_it_slides = |column: &Vec<f64>| -> Vec<f64> {
            column.iter().zip(&slides).map(|(value, slides)| if *slides { *value } else { 0.0 }).collect()
        };
        let seen: Vec<Vec<f64>> = columns.iter().map(where_it_slides).collect();
        let left = where_it_slides(&rest(workbench, given));
        let coefficients = least_squares(&seen, &left, &prepared.open_runs())?;
        let left = residual(&seen, &left, &coefficients);
        let scatter = covariance::of_blocks(&seen, &left, &prepared.open_blocks())?;
        let deviation = (0..columns.len()).map(|i| scatter[(i, i)].max(0.0).sqrt()).collect();
        let rivals = rivals(workbench, &where_it_slides(&rest(workbench, given)), &left, where_it_slides);
        Some(Self { rivals, torque: weighted(&columns, &coefficients), coefficients, deviation })
    }

    /// Probability of a change as large where there is none: two normal coefficients taken as independent.
    fn p_value(&self) -> f64 {
        let deviations = self.coefficients.iter().zip(&self.deviation);
        let statistic: f64 = deviations.map(|(value, deviation)| (value / deviation).powi(2)).sum();
        (-0.5 * statistic).exp()
    }

    fn finding(&self, workbench: &Workbench, evidence: Evidence, score: f64) -> Finding {
        let effect = EffectId::FrictionLevel;
        let state = &workbench.prepared.state;
        let given = sliding_friction(&state.base_friction, state.top_speed()).unwrap_or_default();
        let names = [
            ("coulomb_torque", "F_c", "coulomb_torque_change", "dF_c", Dimension::Torque),
            ("viscous_coefficient", "F_v", "viscous_coefficient_change", "dF_v", Dimension::TorquePerVelocity),
        ];
        let (corrected, changes): (Vec<Estimate>, Vec<Estimate>) = names
            .into_iter()
            .enumerate()
            .map(|(i, (name, symbol, change, change_symbol, dimension))| {
                let (value, deviation) = (self.coefficients[i], self.deviation[i]);
                (
                    Estimate::of(name, symbol, dimension, given[i] + value, deviation),
                    Estimate::of(change, change_symbol, dimension, value, deviation),
                )
            })
            .unzip();
        let share = WITHOUT_RIVAL / (self.rivals.len() + 1) as f64;
        Finding {
            effect,
            probability: share,
            alternatives: self.rivals.iter().map(|rival| (*rival, share)).collect(),
            action: effect.action(),
            equation: "tau = F_c sign(v) + F_v v, in place of the reference's".to_string(),
            // The changes are the coefficients of the fitted term, and so come first.
            parameters: changes.into_iter().chain(corrected).collect(),
            location: Location::default(),
            evidence,
            fitted: Fitted {
                label: Label::Named(effect),
                shape: Vec::new(),
                shape_deviation: Vec::new(),
                coefficients: self.coefficients.clone(),
                deviation: self.deviation.clone(),
            },
            score,
            margin: f64::INFINITY,
            standings: Vec::new(),
            channels: Vec::new(),
            nearest: None,
            locked_gain_nats: Some(score),
        }
    }
}

/// Constants of the actuator of a joint without torque sensor that leave as little of a torque, `missing`, as a changed level does, `left`: a
/// command that acts late is, of a joint that follows it closely, a viscous friction of gain times delay.
fn rivals(
    workbench: &Workbench,
    missing: &[f64],
    left: &[f64],
    where_it_slides: impl Fn(&Vec<f64>) -> Vec<f64>,
) -> Vec<EffectId> {
    use EffectId::{ActuatorGain, CommandDelay, DeadBand, SupplyOrDutyLimit};
    let (state, runs) = (&workbench.prepared.state, workbench.prepared.open_runs());
    let most = EQUAL_ERROR_RATIO.powi(2) * dot(left, left, &runs);
    let leaves_as_little = |columns: &[Vec<f64>], only_positive: bool| {
        least_squares(columns, missing, &runs).is_some_and(|coefficients| {
            let left = residual(columns, missing, &coefficients);
            !(only_positive && coefficients[0] < 0.0) && dot(&left, &left, &runs) <= most
        })
    };
    let is_rival = |effect: &EffectId| {
        workbench.hypothesis(*effect).is_some_and(|hypothesis| {
            hypothesis.shapes(state).iter().any(|shape| {
                let columns = workbench.filtered_columns(&Label::Named(*effect), shape);
                let seen: Vec<Vec<f64>> = columns.iter().map(&where_it_slides).collect();
                leaves_as_little(&seen, hypothesis.only_positive())
            })
        })
    };
    [CommandDelay, ActuatorGain, SupplyOrDutyLimit, DeadBand].into_iter().filter(is_rival).collect()
}

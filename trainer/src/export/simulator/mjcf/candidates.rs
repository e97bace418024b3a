//! The forms that a joint of MuJoCo can have, and the choice among them by simulation.

use super::super::content::Content;
use super::super::form::Form;
use super::super::trial::{Bristles, Controller, Left, SimulatedJoint, Softness, Stepping, Trial};

/// Natural frequencies of bristles on the inertia of the joint, in rad a time step: from soft to what an explicit step just bears.
const BRISTLES_RAD: [f64; 5] = [0.05, 0.1, 0.2, 0.3, 0.5];

/// Damping ratios of bristles. Damped ones act as inertia under implicit integrators.
const DAMPING_RATIOS: [f64; 3] = [0.0, 0.1, 0.5];

/// Bandwidths of a soft and a stiff controller where the file has none, rad/s: 3 and 9 Hz.
const BANDWIDTHS_RAD_S: [f64; 2] = [20.0, 55.0];

/// Their damping ratio.
const DAMPING_RATIO: f64 = 0.7;

/// What a simulator reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct Reads {
    /// `damping` in three powers of the velocity.
    pub(in super::super) powers: bool,
    /// A `dcmotor` without input.
    pub(in super::super) passive_motors: bool,
}

/// Attributes of a joint, and a passive motor beside them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// What it is over velocity.
    pub(super) form: Form,
    pub(super) friction_loss: f64,
    pub(super) bristles: Option<Bristles>,
}

impl Candidate {
    fn attributes(form: Form) -> Self {
        Self { form, friction_loss: form.coulomb, bristles: None }
    }

    /// All of the dry friction in bristles.
    fn bristles(form: Form, stiffness: f64, damping: f64) -> Self {
        let stribeck_velocity = if form.stribeck_velocity > 0.0 { form.stribeck_velocity } else { 1.0 };
        let bristles =
            Bristles { stiffness, damping, coulomb: form.coulomb, at_rest: form.at_rest(), stribeck_velocity };
        Self { form, friction_loss: 0.0, bristles: Some(bristles) }
    }

    /// The Stribeck peak alone in bristles: without a level that stays they must not be damped.
    fn peak(form: Form, stiffness: f64) -> Self {
        let Form { coulomb, excess, stribeck_velocity, .. } = form;
        let bristles = Bristles { stiffness, damping: 0.0, coulomb: 0.0, at_rest: excess, stribeck_velocity };
        Self { form, friction_loss: coulomb, bristles: Some(bristles) }
    }

    /// Whether the dry friction yields before it slips.
    pub(super) fn has_presliding(&self) -> bool {
        self.bristles.is_some_and(|bristles| bristles.coulomb > 0.0)
    }

    fn on(&self, inertia: f64, softness: Softness) -> SimulatedJoint {
        let Self { form, friction_loss, bristles } = *self;
        SimulatedJoint { inertia, friction_loss, softness, damping: form.damping, bristles }
    }
}

/// What a file says of a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup {
    /// Of bodies and armature, kg m2 (kg).
    pub(super) inertia: f64,
    pub(super) stepping: Stepping,
    pub(super) softness: Softness,
    /// A position controller; without one two are tried.
    pub(super) controller: Option<Controller>,
}

/// The form that leaves the least in simulation, and what it leaves.
pub(super) fn best(content: &Content, reads: Reads, setup: &Setup) -> (Candidate, Vec<Left>) {
    let (plain, candidates) = candidates(content, reads, setup);
    let forms: Vec<SimulatedJoint> =
        candidates.iter().map(|candidate| candidate.on(setup.inertia, setup.softness)).collect();
    let controllers = match setup.controller {
        Some(controller) => vec![controller],
        None => BANDWIDTHS_RAD_S.map(|bandwidth| standard(setup.inertia, bandwidth)).to_vec(),
    };
    let trial = Trial {
        joint: content.identified(setup.inertia),
        top: content.curve.top(),
        controllers,
        stepping: setup.stepping,
        gravity: [content.body.gravity_sin, content.body.gravity_cos].map(f64::from),
    };
    let (place, left) = trial.best(&forms, plain);
    (candidates[place], left)
}

/// The form without a trial, for a joint of unknown inertia.
pub(super) fn untried(content: &Content, reads: Reads) -> Candidate {
    Candidate::attributes(if reads.powers { content.damped() } else { content.coulomb_viscous })
}

fn standard(inertia: f64, bandwidth: f64) -> Controller {
    let kp = inertia * bandwidth * bandwidth;
    Controller { kp, kv: 2.0 * DAMPING_RATIO * inertia * bandwidth, is_actuator: false }
}

/// Every form, Coulomb and viscous friction in the first places, and how many these are.
fn candidates(content: &Content, reads: Reads, setup: &Setup) -> (usize, Vec<Candidate>) {
    let peak = content.with_stribeck();
    let mut found = vec![Candidate::attributes(content.coulomb_viscous)];
    // The friction in motion, where a peak at rest would lift the level.
    found.extend(peak.map(|peak| {
        let damping = [peak.damping[0], 0.0, 0.0];
        Candidate::attributes(Form { excess: 0.0, stribeck_velocity: 0.0, damping, ..peak })
    }));
    let plain = found.len();
    if reads.powers {
        found.push(Candidate::attributes(content.damped()));
    }
    let presliding = content.presliding_stiffness();
    if reads.passive_motors && (peak.is_some() || presliding.is_some()) {
        let full = peak.unwrap_or_else(|| content.damped());
        for rate in BRISTLES_RAD {
            let stiffest = setup.inertia * (rate / setup.stepping.step).powi(2);
            found.extend(peak.map(|peak| Candidate::peak(peak, stiffest)));
            let stiffness = presliding.map_or(stiffest, |stiffness| stiffness.min(stiffest));
            let critical = 2.0 * (stiffness * setup.inertia).sqrt();
            found.extend(DAMPING_RATIOS.map(|ratio| Candidate::bristles(full, stiffness, ratio * critical)));
        }
    }
    (plain, found)
}

//! The parameters of a base as regressors, and the nuisances that carry the bias of differentiation.

use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::hat_functions::speed_hats;
use crate::physics::JointState;

/// Which static friction model the recording is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaseKind {
    /// Symmetric Coulomb and viscous friction, refitted.
    CoulombViscous,
    /// A symmetric spline over speed with nine coefficients, refitted.
    Spline,
    /// The law of a fitted model or a simulation: its torque is given, its parameters may move by the given Jacobian.
    Reference,
}

/// Coefficients of the spline base: by definition of [`BaseKind::Spline`].
const SPLINE_KNOTS: usize = 9;

/// The friction columns of a base kind at one velocity.
/// `sign` is the smoothed sign at that velocity.
pub(crate) fn friction_basis(kind: BaseKind, velocity: f64, sign: f64, top_speed: f64) -> Vec<f64> {
    match kind {
        BaseKind::CoulombViscous => vec![sign, velocity],
        BaseKind::Spline => {
            speed_hats(velocity.abs() / top_speed.max(f64::MIN_POSITIVE), SPLINE_KNOTS).map(|hat| hat * sign).collect()
        }
        BaseKind::Reference => Vec::new(),
    }
}

/// Width of a softer sign over that of the smoothed sign. Chosen by judgement: nearer to one it could not be told from
/// the smoothed sign, a wider one would take up the Stribeck effect.
pub(crate) const SOFT_SIGN_WIDTH_RATIO: f64 = 3.0;

/// Step over which the smoothed sign is differentiated by its width and lead, as a ratio: small beside one, large beside rounding.
const STEP_RATIO: f64 = 1.01;

/// The columns of the parameters and the nuisances behind the common filter.
pub(crate) fn filtered_columns(
    prepared: &Prepared,
    comparison: &Comparison,
    raw: &[(&'static str, Vec<f64>)],
) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = raw.iter().map(|(_, column)| prepared.filtered(column)).collect();
    columns.extend(nuisances(prepared));
    // A fitted law is a function of the velocity alone, as soft as its own data told, whatever made the recording.
    let fitted = comparison.reference.as_ref().filter(|law| law.is_fitted);
    match fitted.and_then(|law| law.turned_otherwise(&prepared.state)) {
        Some(otherwise) => columns.push(prepared.filtered(&otherwise)),
        None => columns.extend(prepared.turns_over_sharply().then(|| sharpness(prepared))),
    }
    if let Some(reference) = &comparison.reference {
        columns.extend(reference.replayed.iter().map(|series| prepared.filtered(series)));
    }
    columns
}

pub(crate) fn raw_columns(
    state: &JointState,
    comparison: &Comparison,
    kind: BaseKind,
) -> Vec<(&'static str, Vec<f64>)> {
    let top_speed = state.top_speed();
    let mut columns: Vec<(&'static str, Vec<f64>)> = Vec::new();
    let count = friction_basis(kind, 1.0, 1.0, top_speed).len();
    let names = match kind {
        BaseKind::CoulombViscous => &["coulomb_torque", "viscous_coefficient"][..],
        _ => &["friction_knot"; SPLINE_KNOTS][..],
    };
    for (j, name) in names.iter().enumerate().take(count) {
        columns.push((name, state.map(|i| friction_basis(kind, state.velocity[i], state.sign[i], top_speed)[j])));
    }
    if let Some(reference) = &comparison.reference {
        columns.extend(reference.jacobian.iter().cloned());
    } else if comparison.signals.rigid_body.is_none() {
        // No rigid body is given: its inertia is identified together with friction.
        columns.push(("inertia", state.acceleration.clone()));
    }
    columns
}

/// Change of the smoothed sign and of the acceleration with the width of the filter: they carry the differentiation bias.
pub(crate) fn differentiation_bias(prepared: &Prepared) -> Vec<Vec<f64>> {
    let state = &prepared.state;
    let led = state.led_velocity(state.sign_lead_s);
    let narrow_velocity = state.map(|i| led[i] + prepared.narrow_velocity[i] - state.velocity[i]);
    let narrow_sign = state.averaged_sign(&narrow_velocity, state.sign_velocity);
    let sign = state.map(|i| narrow_sign[i] - state.sign[i]);
    let acceleration = state.map(|i| prepared.narrow_acceleration[i] - state.acceleration[i]);
    vec![prepared.filtered(&sign), prepared.filtered(&acceleration)]
}

/// Width of a sign that turns over in a straight line over that of the hyperbolic tangent from which it differs least (least squares).
const STRAIGHT_WIDTH_RATIO: f64 = 1.3;

/// What is uncertain of how friction turns over. A smoothed sign that stands for a jump may be wider; a width and a lead that a recording
/// shows are as uncertain as their estimates, and what leads may be a constraint, which is straight up to its largest force.
fn turn_over_error(prepared: &Prepared) -> Vec<Vec<f64>> {
    let (state, lead_s) = (&prepared.state, prepared.state.sign_lead_s);
    let moved = |lead_s: f64, width: f64| {
        let sign = state.leading_sign(lead_s, width);
        prepared.filtered(&state.map(|i| sign[i] - state.sign[i]))
    };
    let ratio = if prepared.turns_over_sharply() { SOFT_SIGN_WIDTH_RATIO } else { STEP_RATIO };
    let mut errors = vec![moved(lead_s, ratio * state.sign_velocity)];
    if lead_s > 0.0 {
        errors.push(moved(STEP_RATIO * lead_s, state.sign_velocity));
        let straight = state.straight_sign(lead_s, STRAIGHT_WIDTH_RATIO * state.sign_velocity);
        errors.push(prepared.filtered(&state.map(|i| straight[i] - state.sign[i])));
    }
    errors
}

/// The nuisances of every model: the bias of differentiation and the error of the turn-over.
pub(crate) fn nuisances(prepared: &Prepared) -> Vec<Vec<f64>> {
    [differentiation_bias(prepared), turn_over_error(prepared)].concat()
}

/// A law from elsewhere turns its friction over as sharply as it was made to, and between two samples at one of them: what is
/// between its sign and the smoothed one is a nuisance too.
pub(crate) fn sharpness(prepared: &Prepared) -> Vec<f64> {
    let state = &prepared.state;
    prepared.filtered(&state.map(|i| state.velocity[i].signum() - state.sign[i]))
}

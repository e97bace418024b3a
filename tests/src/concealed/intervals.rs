//! Whether the stated intervals hold the truth that the simulator drew.

use super::Outcome;
use frikan_trainer::physics::EffectId;

/// Parameters that simulator and diagnosis define alike: effect, the simulator's name, whether the amplitude scales it, and
/// the diagnosis' name.
const ALIKE: [(&str, &str, bool, &str); 12] = [
    ("direction_asymmetry", "coulomb_difference_Nm", true, "coulomb_asymmetry"),
    ("direction_asymmetry", "viscous_difference_Nm_s_rad", true, "viscous_asymmetry"),
    ("viscous_nonlinearity", "exponent", false, "viscous_exponent"),
    ("warm_up", "time_constant_s", false, "thermal_time_constant"),
    ("drive_backdrive", "driving_coefficient", true, "driving_loss"),
    ("drive_backdrive", "backdriving_coefficient", true, "backdriving_loss"),
    ("gravity_error", "sine_Nm", true, "gravity_sine_torque"),
    ("gravity_error", "cosine_Nm", true, "gravity_cosine_torque"),
    ("torque_scale", "relative_error", true, "torque_scale_error"),
    ("torque_offset", "offset_Nm", true, "torque_offset"),
    ("spring", "stiffness_Nm_rad", true, "spring_stiffness"),
    ("position_ripple", "order", false, "ripple_order"),
];

/// Effects beside which Coulomb torque and viscous coefficient keep their meaning.
const BESIDE_FRICTION: [&str; 10] = [
    "viscous_nonlinearity",
    "direction_asymmetry",
    "gravity_error",
    "inertia_error",
    "torque_offset",
    "spring",
    "coupling",
    "contact",
    "transient_event",
    "position_ripple",
];

/// Standard deviations of a two-sided 90 % interval.
const NINETY: f64 = 1.645;
/// Those of the stated 95 % interval.
const STATED: f64 = 1.96;

/// One parameter of a right finding against the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Effect and name of the parameter in the diagnosis.
    pub parameter: String,
    /// Distance of the estimate from the truth in its stated standard deviations.
    pub deviations: f64,
}

impl Held {
    /// Whether the 90 % interval holds the truth.
    pub fn within_ninety(&self) -> bool {
        self.deviations.abs() <= NINETY
    }
}

/// Every parameter of an outcome of which the truth is known; none where the finding is not the hidden effect alone.
pub fn held(outcome: &Outcome) -> Vec<Held> {
    let [finding] = outcome.diagnosis.findings.as_slice() else { return Vec::new() };
    let [hidden] = outcome.concealed.joint.effects.as_slice() else { return Vec::new() };
    if EffectId::from_name(&hidden.name) != Some(finding.effect) {
        return Vec::new();
    }
    let drawn = |name: &str| {
        let full = format!("{}.{name}", hidden.name);
        outcome.concealed.recording.truth.parameters.iter().find(|(drawn, _)| *drawn == full).map(|(_, value)| *value)
    };
    let joint = &outcome.concealed.joint;
    let mut truths: Vec<(&str, f64)> = ALIKE
        .iter()
        .filter(|(effect, ..)| *effect == hidden.name)
        .filter_map(|(_, name, scales, stated)| {
            Some((*stated, drawn(name)? * if *scales { hidden.amplitude } else { 1.0 }))
        })
        .collect();
    if let Some(share) = drawn("inertia_share") {
        truths.push(("inertia_correction", share * joint.inertia_kgm2 * hidden.amplitude));
    }
    if BESIDE_FRICTION.contains(&hidden.name.as_str()) {
        truths.push(("coulomb_torque", joint.friction.coulomb_torque_nm));
        truths.push(("viscous_coefficient", joint.friction.viscous_nm_s_rad));
    }
    let stated = finding.parameters.iter().chain(&outcome.diagnosis.base_parameters);
    stated
        .filter_map(|parameter| {
            let (name, truth) = truths.iter().find(|(name, _)| *name == parameter.name)?;
            let deviation = (parameter.ci95[1] - parameter.ci95[0]) / (2.0 * STATED);
            (deviation > 0.0).then(|| Held {
                parameter: format!("{} {name}", hidden.name),
                deviations: (parameter.value - truth) / deviation,
            })
        })
        .collect()
}

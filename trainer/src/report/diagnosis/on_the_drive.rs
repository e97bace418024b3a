//! How a term is run on the drive and what it keeps between samples, in words.

use crate::physics::{Action, EffectId};

/// How a term is run on the drive and what it keeps between samples.
pub(super) fn on_the_drive(effect: EffectId) -> &'static str {
    use EffectId::*;
    match effect {
        Unknown => "Not run on the drive: nothing is known of it beyond the recorded range.",
        Presliding => {
            "One to four bristles (Maxwell elements), stepped by the exact exponential over the distance of a sample: one exponential and one state each, no stability limit on the sample time."
        }
        FrictionalLag => "One first-order lag on the velocity that the law sees: one state.",
        DwellBreakaway => "A clock of the stop and the distance since: two exponentials, three states.",
        WarmUp => "One thermal state driven by the dissipated power.",
        Backlash => {
            "The play operator on position: two comparisons, one state; it corrects the position, not the torque."
        }
        PositionRipple => "A sine and a cosine of the order times position: no state.",
        KinematicError => "A correction of position, sine and cosine of the order: no state, no torque.",
        PositionFriction => "A table over position times the sign of velocity: no state.",
        Stribeck | ViscousNonlinearity | DirectionAsymmetry => "A function of velocity alone: no state.",
        Temperature | LoadFriction | DriveBackdrive => "A product with one measured channel: no state.",
        Spring => "One product with position: no state.",
        FrictionLevel => "Nothing to run: the Coulomb and viscous friction of the law are corrected.",
        GravityError | InertiaError | TorqueScale | TorqueOffset => {
            "Nothing to run: the rigid-body parameters of the model are corrected."
        }
        _ if effect.is_of_actuator() => {
            "Nothing to run: a constant of the actuator is corrected, in joint.toml and in the simulator."
        }
        SlowDrift => "Frozen at its value at the end of the recording; fit again when it has moved on.",
        _ => match effect.action() {
            Action::Maintenance => "Not compensated: a fault is to be repaired, and compensating it would hide it.",
            Action::Measurement => "Not compensated: the measurement is to be repaired.",
            _ => "Not run on the drive: the image has no term for it.",
        },
    }
}

//! What effects are called in a sentence.

use crate::physics::EffectId;

/// An effect's name for people.
#[must_use]
pub fn plain_name(effect: EffectId) -> &'static str {
    use EffectId::*;
    match effect {
        FrictionLevel => "wrong level of Coulomb or viscous friction",
        Stribeck => "Stribeck friction",
        ViscousNonlinearity => "viscous friction that grows with a power of speed",
        DirectionAsymmetry => "friction that differs between the directions",
        Temperature => "friction that depends on temperature",
        WarmUp => "friction that falls as the joint warms itself up",
        LoadFriction => "load-dependent friction",
        DriveBackdrive => "gear losses that differ between driving and backdriving",
        SlowDrift => "friction that drifts with time",
        Presliding => "presliding hysteresis",
        FrictionalLag => "frictional lag",
        DwellBreakaway => "break-away that grows with the stop before it",
        PositionRipple => "torque ripple over position",
        KinematicError => "kinematic error of the gear",
        PositionFriction => "friction that depends on position",
        GravityError => "wrong gravity torque",
        InertiaError => "wrong inertia",
        TorqueScale => "wrong torque constant",
        TorqueOffset => "torque offset",
        Spring => "spring of a cable, hose or balancer",
        Coupling => "inertial coupling with another joint",
        Saturation => "saturated actuator",
        Contact => "hard stop or contact",
        TransientEvent => "one-off event",
        RecurrentFault => "local fault that comes back at one angle",
        Backlash => "backlash",
        Elasticity => "elastic transmission",
        WindupHysteresis => "windup hysteresis of the transmission",
        TimeMisalignment => "torque and position recorded out of step",
        Quantisation => "resolution too coarse",
        UnitOrSign => "wrong unit or sign",
        ActuatorGain => "wrong gain of the actuator",
        SupplyOrDutyLimit => "supply or firmware limit of the actuator",
        CommandDelay => "commands that act late",
        DeadBand => "dead band of the position controller",
        Unknown => "a structure that the catalogue does not hold",
    }
}

/// What an improved model has of an effect: what was wrong is corrected in it, all else is added to it.
#[must_use]
pub fn name_in_model(effect: EffectId) -> String {
    let name = plain_name(effect);
    name.strip_prefix("wrong ").map_or_else(|| name.to_owned(), |corrected| format!("corrected {corrected}"))
}

/// A sentence with a capital.
pub(crate) fn capital(sentence: &str) -> String {
    let mut characters = sentence.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_has_nothing_wrong_in_it() {
        for &effect in EffectId::ALL {
            assert!(!name_in_model(effect).contains("wrong"), "{effect:?}");
        }
        assert_eq!(name_in_model(EffectId::InertiaError), "corrected inertia");
        assert_eq!(name_in_model(EffectId::Stribeck), "Stribeck friction");
    }
}

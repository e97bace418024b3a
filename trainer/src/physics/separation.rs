//! What separates each effect from its usual confounders, in words.

use crate::physics::EffectId;

/// The excitation that separates an effect from its usual confounders (catalogue of effects).
pub(crate) fn separation(effect: EffectId) -> &'static str {
    use EffectId::*;
    match effect {
        FrictionLevel => "constant-velocity plateaus at four speeds or more in both directions, at working temperature",
        Stribeck => {
            "constant-velocity plateaus, at least six per decade from a tenth of the Stribeck velocity up, both directions, with slow ramps up and down"
        }
        ViscousNonlinearity => "three well spread speeds at one temperature, repeated cold and hot",
        DirectionAsymmetry => {
            "samples at rest inside the friction cone, mirrored plateaus over the same positions, or the joint mounted turned by 180 degrees"
        }
        Temperature => {
            "one cooling phase inside the recording (warm-up, rest, run again), so that temperature and time stop being collinear"
        }
        WarmUp => "hard, idle and hard blocks of unequal length",
        LoadFriction => {
            "the same motion with three payloads or arm poses including none, both signs of load times velocity"
        }
        DriveBackdrive => "a weighed payload added, a link-side torque sensor, or the torque constant from back-EMF",
        SlowDrift => "a rest of several minutes and a repeated reference move: drift does not recover",
        Presliding => "slow sinusoids of half, one, three and ten break-away distances at two accelerations",
        FrictionalLag => "unidirectional oscillating velocity at two frequencies, and one swing with a heavy payload",
        DwellBreakaway => "identical starts after 0.1, 0.3, 1, 3, 10 and 30 s of rest in random order",
        PositionRipple => "slow constant speed over a full turn at three speeds, both directions",
        KinematicError => {
            "constant speeds a factor of three apart (its torque grows with the square of speed), or a second encoder"
        }
        PositionFriction => {
            "constant speed over the whole range in both directions: friction changes sign with direction, a spring does not"
        }
        GravityError => "motion beyond 60 degrees to both sides, a second payload, or the base turned",
        InertiaError => "two well separated frequencies of oscillation",
        TorqueScale => "a weighed payload added, back-EMF, or a torque sensor",
        TorqueOffset => "a zero-torque reading and samples at rest",
        Spring => "a large range of motion, and a change of payload: a spring does not scale with it",
        Coupling => "one joint at a time, then both at incommensurate frequencies",
        Saturation => "the measured phase current in place of the command",
        Contact => "slow moves into the suspected stop from one side, and the same move displaced",
        TransientEvent => "the same motion repeated",
        RecurrentFault => "slow constant speed over several turns in both directions",
        Backlash => "reversals under preload: there play does not open, presliding stays",
        Elasticity => "a chirp past a third of the antiresonance, or a link-side encoder",
        WindupHysteresis => "slow torque loops of several amplitudes with the link held",
        TimeMisalignment => "two frequencies and a heavy payload",
        Quantisation => "a finer encoder or slower moves",
        UnitOrSign => "a known weight moved by hand-calculated torque",
        ActuatorGain => "a weighed payload held at two angles, or the same motion under two gains of the controller",
        SupplyOrDutyLimit => {
            "the same motion slower and without payload, so that nothing reaches the limit; the supply voltage recorded"
        }
        CommandDelay => "steps of the reference, logged at a millisecond",
        DeadBand => "a slow ramp of the reference from rest, in both directions",
        Unknown => "the same motion repeated with one channel changed at a time",
    }
}

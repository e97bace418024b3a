//! Names, codes and actions of the catalogue's effects. The names are a public contract.

use serde::Serialize;

/// What should be done about an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Export as a feed-forward term.
    FeedForward,
    /// Correct a parameter of the existing model.
    Parameter,
    /// Repair the measurement chain; do not compensate.
    Measurement,
    /// Tell a person; do not compensate.
    Maintenance,
}

macro_rules! effects {
    ($($(#[$doc:meta])* $variant:ident $name:literal $code:literal $action:ident;)*) => {
        /// An effect of the catalogue, or `unknown`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum EffectId { $($(#[$doc])* $variant,)* }

        impl EffectId {
            /// Every effect, in the catalogue's order.
            pub const ALL: &'static [EffectId] = &[$(EffectId::$variant,)*];

            /// The stable name that reports and scripts use.
            pub fn name(self) -> &'static str {
                match self { $(EffectId::$variant => $name,)* }
            }

            /// The catalogue's code, e.g. `A1`.
            pub fn code(self) -> &'static str {
                match self { $(EffectId::$variant => $code,)* }
            }

            /// What should be done about it.
            pub fn action(self) -> Action {
                match self { $(EffectId::$variant => Action::$action,)* }
            }
        }
    };
}

effects! {
    /// Coulomb or viscous level of the reference is wrong or absent.
    FrictionLevel "friction_level" "A0" Parameter;
    /// Friction falls from break-away to Coulomb level with speed.
    Stribeck "stribeck" "A1" FeedForward;
    /// Viscous friction grows with a power of speed other than one.
    ViscousNonlinearity "viscous_nonlinearity" "A2" FeedForward;
    /// Friction differs between the directions.
    DirectionAsymmetry "direction_asymmetry" "A3" FeedForward;
    /// Friction depends on the measured temperature.
    Temperature "temperature" "B1" FeedForward;
    /// Friction falls with the joint's own dissipated power.
    WarmUp "warm_up" "B2" FeedForward;
    /// Friction grows with the transmitted load.
    LoadFriction "load_friction" "B3" FeedForward;
    /// Gear losses differ between driving and backdriving.
    DriveBackdrive "drive_backdrive" "B3b" FeedForward;
    /// Friction drifts slowly with time.
    SlowDrift "slow_drift" "B4" FeedForward;
    /// Hysteresis over the first distance after a reversal.
    Presliding "presliding" "C1" FeedForward;
    /// Friction follows velocity with a lag.
    FrictionalLag "frictional_lag" "C2" FeedForward;
    /// Break-away grows with the preceding dwell.
    DwellBreakaway "dwell_breakaway" "C3" FeedForward;
    /// Torque ripple at a fixed order of position.
    PositionRipple "position_ripple" "D1" FeedForward;
    /// Position error of the gear, periodic in position.
    KinematicError "kinematic_error" "D2" FeedForward;
    /// Friction depends on position.
    PositionFriction "position_friction" "D3" FeedForward;
    /// Gravity torque of the model is wrong.
    GravityError "gravity_error" "E1" Parameter;
    /// Inertia of the model is wrong.
    InertiaError "inertia_error" "E2" Parameter;
    /// Torque constant is wrong.
    TorqueScale "torque_scale" "E3" Parameter;
    /// Constant offset of torque or current.
    TorqueOffset "torque_offset" "E4" Parameter;
    /// Spring force of a cable, hose or balancer.
    Spring "spring" "E5" FeedForward;
    /// Inertial coupling from another joint.
    Coupling "coupling" "E6" Parameter;
    /// The actuator saturates below the commanded torque.
    Saturation "saturation" "F1" Measurement;
    /// A hard stop or external contact.
    Contact "contact" "F2" Maintenance;
    /// A one-off event in time.
    TransientEvent "transient_event" "F3" Maintenance;
    /// A local fault that recurs at one angle.
    RecurrentFault "recurrent_fault" "F4" Maintenance;
    /// Play between motor and load.
    Backlash "backlash" "G1" FeedForward;
    /// Elastic transmission between motor and load.
    Elasticity "elasticity" "G2" FeedForward;
    /// Hysteretic torsion of the transmission.
    WindupHysteresis "windup_hysteresis" "G3" FeedForward;
    /// Torque and position clocks are shifted against each other.
    TimeMisalignment "time_misalignment" "H1" Measurement;
    /// The encoder is too coarse for what is asked of it.
    Quantisation "quantisation" "H2" Measurement;
    /// A channel has the wrong unit or sign.
    UnitOrSign "unit_or_sign" "H5" Measurement;
    /// The gain of the actuator is not the one compared with.
    ActuatorGain "actuator_gain" "H6" Parameter;
    /// Supply or firmware let the actuator do less than its command asks for.
    SupplyOrDutyLimit "supply_or_duty_limit" "H7" Parameter;
    /// The command acts later than was thought.
    CommandDelay "command_delay" "H8" Parameter;
    /// The firmware does nothing about small position errors.
    DeadBand "dead_band" "H9" Parameter;
    /// Structured, but none of the catalogue.
    Unknown "unknown" "-" Maintenance;
}

impl EffectId {
    /// Whether it is a constant of the actuator of a joint that reports no torque: nothing of an image corrects it.
    #[must_use]
    pub fn is_of_actuator(self) -> bool {
        matches!(self, Self::ActuatorGain | Self::SupplyOrDutyLimit | Self::CommandDelay | Self::DeadBand)
    }

    /// The effect of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|effect| effect.name() == name)
    }
}

impl Serialize for EffectId {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

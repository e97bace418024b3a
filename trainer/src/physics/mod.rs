//! The catalogue of effects: one file an effect, with its equation, its regressors and its shape parameters.
//!
//! A hypothesis is linear in its coefficients and non-linear in its *shape* (a Stribeck velocity, a time constant, an
//! order): for a given shape it turns the recorded states into columns of torque per unit coefficient.
//! This room knows nothing of noise, evidence or choice (that is `diagnose`) and nothing of the simulator (`plant`).

mod actuator;
mod asymmetry;
mod backlash;
mod contact;
mod coupling;
mod drift;
mod dwell_breakaway;
mod elasticity;
mod identity;
mod kinematic_error;
mod lag;
mod load;
mod misalignment;
pub mod names;
mod position_friction;
pub(crate) mod presliding;
mod recurrent_fault;
mod rigid_body;
mod ripple;
mod saturation;
pub(crate) mod separation;
mod state;
mod stribeck;
mod temperature;
mod transient;
mod transmission;
pub mod units;
mod viscous;
mod warm_up;
mod windup;

pub use identity::{Action, EffectId};
pub(crate) use position_friction::SERIES_ORDERS;
pub use state::{JointState, MemoryAxes, OtherJoint, Twist};
pub(crate) use state::{friction_at, top_speed};
pub(crate) use transmission::{carried_torque, nominal_inertia, usual_link_inertia};

/// Shape parameters of a hypothesis (its non-linear parameters, in the order of [`Hypothesis::shape_names`]).
pub type Shape = Vec<f64>;

/// The dimension of a parameter, from which its unit follows for rotary and linear axes and each actuator unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A torque, force or current: N m, N or A.
    Torque,
    /// Torque per velocity.
    TorquePerVelocity,
    /// Torque per velocity to a power that is itself a parameter.
    TorquePerVelocityPower,
    /// A temperature in degrees Celsius.
    Celsius,
    /// Torque per kelvin.
    TorquePerKelvin,
    /// 1/K.
    PerKelvin,
    /// Torque per velocity and kelvin.
    TorquePerVelocityKelvin,
    /// Torque per unit of position.
    TorquePerPosition,
    /// Torque per acceleration: an inertia or a mass.
    Inertia,
    /// An inertia or a mass times a position.
    InertiaPosition,
    /// Torque per second.
    TorquePerSecond,
    /// Torque per squared second.
    TorquePerSecondSquared,
    /// Torque per watt of smoothed dissipated power.
    TorquePerWatt,
    /// Torque per watt and velocity.
    TorquePerWattVelocity,
    /// Inverse of a torque.
    PerTorque,
    /// An angular frequency in rad/s.
    RadianPerSecond,
    /// A velocity.
    Velocity,
    /// A position.
    Position,
    /// A time in seconds.
    Second,
    /// Torque per squared velocity.
    TorquePerVelocitySquared,
    /// Periods per joint revolution (rotary) or radians per metre (linear).
    Order,
    /// Dimensionless.
    One,
}

/// One left-out effect, as the diagnosis tests it.
pub trait Hypothesis: Sync {
    /// Which effect of the catalogue this is.
    fn id(&self) -> EffectId;

    /// The equation that it adds to the torque.
    fn equation(&self) -> &'static str;

    /// Grid of shapes worth testing on this recording; empty when the recording cannot show the effect.
    /// A hypothesis without shape parameters returns one empty shape.
    fn shapes(&self, state: &JointState) -> Vec<Shape>;

    /// Torque per unit coefficient at the recorded states: one column a coefficient, each as long as `state.time`.
    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>>;

    /// Name, symbol and dimension of each linear coefficient for a shape.
    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)>;

    /// Name, symbol and dimension of each shape parameter of a shape.
    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        Vec::new()
    }

    /// Bounds of shape parameter `index` on this recording, for continuous refinement; `None` where it is discrete.
    fn bounds(&self, _state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        None
    }

    /// Whether a coefficient may only be positive: break-away lies above Coulomb friction, a stop pushes back.
    fn only_positive(&self) -> bool {
        false
    }

    /// Value of its one coefficient where physics knows it: what is beyond a limit is withheld wholly.
    fn known_coefficient(&self, _shape: &[f64]) -> Option<f64> {
        None
    }

    /// Change of its first column with the recorded torque at every sample, 1: what it takes over of the noise of that torque, and so explains
    /// without being there. `None` where it is the motion's.
    fn slope_over_recorded_torque(&self, _state: &JointState, _shape: &[f64]) -> Option<Vec<f64>> {
        None
    }

    /// Whether coefficients are a joint's: friction of its own takes energy from every motion.
    fn is_passive(&self, _state: &JointState, _shape: &[f64], _coefficients: &[f64]) -> bool {
        true
    }

    /// Whether the effect may be found again with another shape (a ripple has several orders).
    fn repeats(&self) -> bool {
        false
    }

    /// How many shapes were looked at to propose [`Self::shapes`], where these were chosen by their residual.
    fn scanned(&self, _state: &JointState) -> Option<f64> {
        None
    }

    /// The effect that goes before this one where it explains as much: that of a recorded channel before that of an inferred
    /// state, the plain spring before one with a loop; and the lead in nats up to which this one is no better, as it has more to
    /// fit.
    fn yields_to(&self) -> Option<(EffectId, f64)> {
        None
    }

    /// First step of a continuous refinement of shape parameter `index`.
    fn step(&self, _state: &JointState, index: usize, shape: &[f64]) -> f64 {
        0.25 * shape[index].abs().max(1e-9)
    }
}

/// Name, symbol and dimension of a shape parameter.
#[derive(Clone, Copy, Debug)]
pub struct ShapeName {
    /// The field's name, e.g. `stribeck_velocity`.
    pub name: &'static str,
    /// Symbol used in the equation.
    pub symbol: &'static str,
    /// Dimension, from which the unit follows.
    pub dimension: Dimension,
}

impl ShapeName {
    const fn new(name: &'static str, symbol: &'static str, dimension: Dimension) -> Self {
        Self { name, symbol, dimension }
    }
}

/// Every hypothesis of the catalogue, in the catalogue's order.
pub fn catalogue() -> Vec<Box<dyn Hypothesis + Send>> {
    vec![
        Box::new(stribeck::Stribeck),
        Box::new(viscous::ViscousNonlinearity),
        Box::new(asymmetry::DirectionAsymmetry),
        Box::new(temperature::Temperature),
        Box::new(warm_up::WarmUp),
        Box::new(load::LoadFriction),
        Box::new(load::DriveBackdrive),
        Box::new(drift::SlowDrift),
        Box::new(presliding::Presliding),
        Box::new(lag::FrictionalLag),
        Box::new(dwell_breakaway::DwellBreakaway),
        Box::new(ripple::PositionRipple),
        Box::new(kinematic_error::KinematicError),
        Box::new(position_friction::PositionFriction),
        Box::new(rigid_body::GravityError),
        Box::new(rigid_body::InertiaError),
        Box::new(rigid_body::TorqueScale),
        Box::new(rigid_body::TorqueOffset),
        Box::new(rigid_body::Spring),
        Box::new(coupling::Coupling),
        Box::new(saturation::Saturation),
        Box::new(contact::Contact),
        Box::new(transient::TransientEvent),
        Box::new(recurrent_fault::RecurrentFault),
        Box::new(backlash::Backlash),
        Box::new(elasticity::Elasticity),
        Box::new(windup::WindupHysteresis),
        Box::new(misalignment::TimeMisalignment),
        Box::new(actuator::ActuatorGain),
        Box::new(actuator::SupplyOrDutyLimit),
        Box::new(actuator::CommandDelay),
        Box::new(actuator::DeadBand),
    ]
}

/// Standard deviation of a coefficient that physics knows, over its value: constants of actuators are good to a tenth, and what a joint does
/// about a limit is not all in the column.
pub(crate) const KNOWN_WITHIN_SHARE: f64 = 0.1;

/// `count` values from `low` to `high`, evenly spaced in the logarithm.
pub(crate) fn geometric_grid(low: f64, high: f64, count: usize) -> Vec<f64> {
    if count < 2 || high <= low {
        return vec![low];
    }
    let ratio = (high / low).ln() / (count - 1) as f64;
    (0..count).map(|i| low * (ratio * i as f64).exp()).collect()
}

//! The correction terms of an image for a reader: what each is called, its equation, its parameters with their units, and what it remembers
//! from one sample to the next.

use frikan_shared::effect::{Effect, Kind};
use frikan_shared::model::Model;
use frikan_shared::units::{Quantity, Unit};
use serde::Serialize;

use crate::physics::units::unit_text;
use crate::physics::{Dimension, EffectId};

/// A parameter of a term.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TermParameter {
    /// Its name, the same in the equation.
    pub name: String,
    /// Its value as the drive holds it.
    pub value: f32,
    /// Unit of the value.
    pub unit: String,
}

/// A number that a term keeps from one sample to the next; at the start it is 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TermState {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The least and the largest that it can be; `None` where the joint's motion alone says it.
    pub range: Option<[f32; 2]>,
}

/// A correction term.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Term {
    /// Stable name of the effect that it models.
    pub effect: &'static str,
    /// What it adds, and to what; `s(v) = tanh(v / smoothing_velocity)`.
    pub equation: &'static str,
    /// The parameters of the equation.
    pub parameters: Vec<TermParameter>,
    /// What it remembers; empty for a term of the present sample alone.
    pub state: Vec<TermState>,
    /// For a term that goes by the distance `dq` of a sample: the channel that gives it, `position`, or `velocity` by way of `v dt`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_from: Option<&'static str>,
}

/// The terms of a model in their order.
#[must_use]
pub fn terms<const CELLS: usize>(model: &Model<CELLS>) -> Vec<Term> {
    let is_position = |unit| unit == Unit::Metre || unit == Unit::MetrePerSecond;
    let axis = Axis {
        rotary: !model.inputs.iter().any(|input| is_position(input.unit)),
        actuator: model.output_unit.symbol(),
        reads_position: model.inputs.iter().any(|input| input.quantity == Quantity::Position),
    };
    model.effects.iter().map(|effect| axis.term(effect)).collect()
}

/// What the units of a term depend on.
struct Axis {
    rotary: bool,
    actuator: &'static str,
    reads_position: bool,
}

impl Axis {
    fn term(&self, effect: &Effect) -> Term {
        use Dimension::{
            Celsius, One, PerKelvin, PerTorque, Position, Second, Torque, TorquePerKelvin, TorquePerPosition,
            TorquePerVelocity, TorquePerVelocityKelvin, TorquePerVelocityPower, TorquePerWatt, TorquePerWattVelocity,
            Velocity,
        };
        let smoothing = |width: f32| ("smoothing_velocity", width, Velocity);
        match *effect {
            Effect::Coulomb { coulomb, viscous, smoothing_velocity } => self.plain(
                EffectId::FrictionLevel,
                "coulomb s(v) + viscous v",
                &[("coulomb", coulomb, Torque), ("viscous", viscous, TorquePerVelocity), smoothing(smoothing_velocity)],
            ),
            Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => self.plain(
                EffectId::Stribeck,
                "amplitude exp(-(|v| / velocity)^exponent) s(v)",
                &[
                    ("amplitude", amplitude, Torque),
                    ("velocity", velocity, Velocity),
                    ("exponent", exponent, One),
                    smoothing(smoothing_velocity),
                ],
            ),
            Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => self.plain(
                EffectId::ViscousNonlinearity,
                "coefficient |v|^exponent s(v)",
                &[
                    ("coefficient", coefficient, TorquePerVelocityPower),
                    ("exponent", exponent, One),
                    smoothing(smoothing_velocity),
                ],
            ),
            Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => self.plain(
                EffectId::DirectionAsymmetry,
                "coulomb |s(v)| + viscous |v|",
                &[("coulomb", coulomb, Torque), ("viscous", viscous, TorquePerVelocity), smoothing(smoothing_velocity)],
            ),
            Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity } => self.plain(
                EffectId::Temperature,
                if decay > 0.0 {
                    "coulomb s(v) (T - reference) + viscous v (1 - exp(-decay (T - reference))) / decay"
                } else {
                    "(coulomb s(v) + viscous v) (T - reference)"
                },
                &[
                    ("reference", reference, Celsius),
                    ("coulomb", coulomb, TorquePerKelvin),
                    ("viscous", viscous, TorquePerVelocityKelvin),
                    ("decay", decay, PerKelvin),
                    smoothing(smoothing_velocity),
                ],
            ),
            Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } => {
                let parameters = [
                    ("time_constant", time_constant, Second),
                    ("coulomb", coulomb, TorquePerWatt),
                    ("viscous", viscous, TorquePerWattVelocity),
                    smoothing(smoothing_velocity),
                ];
                let equation = "(coulomb s(v) + viscous v) h, h += (1 - exp(-dt / time_constant)) (P - h), \
                                P = |law v| up to power_limit";
                let mut term = self.plain(EffectId::WarmUp, equation, &parameters);
                let power_limit = TermParameter { name: "power_limit".into(), value: power_limit, unit: "W".into() };
                term.state = vec![
                    state("filtered dissipated power h", "W", Some([0.0, power_limit.value])),
                    state("rounding carried along", "W", None),
                ];
                term.parameters.push(power_limit);
                term
            }
            Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => self.plain(
                if difference == 0.0 { EffectId::LoadFriction } else { EffectId::DriveBackdrive },
                "(mean + stribeck exp(-(v / velocity)^2)) |load| s(v) + difference load |s(v)| + quadratic load^2 s(v)",
                &[
                    ("mean", mean, One),
                    ("difference", difference, One),
                    ("quadratic", quadratic, PerTorque),
                    ("stribeck", stribeck, One),
                    ("velocity", velocity, Velocity),
                    smoothing(smoothing_velocity),
                ],
            ),
            Effect::FrictionalLag { time_constant } => {
                let equation = "the law sees v_L, v_L += (1 - exp(-dt / time_constant)) (v - v_L)";
                let mut term =
                    self.plain(EffectId::FrictionalLag, equation, &[("time_constant", time_constant, Second)]);
                term.state = vec![state("lagged velocity v_L", &self.unit(Velocity), None), started()];
                term
            }
            Effect::Presliding { smoothing_velocity, ref elements } => {
                let numbered = elements.iter().zip(1..);
                let pairs = numbered.flat_map(|(element, number)| {
                    [
                        self.parameter(format!("torque_{number}"), element.torque, Torque),
                        self.parameter(format!("distance_{number}"), element.distance, Position),
                    ]
                });
                let (name, width, dimension) = smoothing(smoothing_velocity);
                let share = |number| state(&format!("share z_{number}"), "1", Some([-1.0, 1.0]));
                Term {
                    effect: EffectId::Presliding.name(),
                    equation: "sum of torque_i (z_i - s(v)), z_i <- z_i r_i + (1 - r_i) sgn(dq), r_i = exp(-|dq| / distance_i)",
                    parameters: pairs.chain([self.parameter(name.into(), width, dimension)]).collect(),
                    state: (1..=elements.len()).map(share).collect(),
                    distance_from: self.distance_from(),
                }
            }
            Effect::DwellBreakaway { gain, time, distance, rest_velocity, dwell_limit, smoothing_velocity } => {
                let parameters = [
                    ("gain", gain, Torque),
                    ("time", time, Second),
                    ("distance", distance, Position),
                    ("rest_velocity", rest_velocity, Velocity),
                    ("dwell_limit", dwell_limit, Second),
                    smoothing(smoothing_velocity),
                ];
                let equation = "A exp(-x) s(v), A = gain ln(1 + t_d / time) after a rest t_d below rest_velocity, \
                                x += |dq| / distance since";
                let largest = gain.abs() * (1.0 + dwell_limit / time).ln();
                let mut term = self.plain(EffectId::DwellBreakaway, equation, &parameters);
                term.state = vec![
                    state("time at rest t_d", "s", Some([0.0, dwell_limit])),
                    state("way since rest x", "1", Some([0.0, 20.0])),
                    state("latched torque A", &self.unit(Torque), Some([-largest, largest])),
                ];
                term.distance_from = self.distance_from();
                term
            }
            Effect::Ripple { kind, smoothing_velocity, ref harmonics } => {
                let lines = harmonics.iter().zip(1..).flat_map(|(line, number)| {
                    [
                        self.parameter(format!("order_{number}"), line.order, Dimension::Order),
                        self.parameter(format!("cosine_{number}"), line.cosine, of_kind(kind)),
                        self.parameter(format!("sine_{number}"), line.sine, of_kind(kind)),
                    ]
                });
                let effect = if kind == Kind::Position { EffectId::KinematicError } else { EffectId::PositionRipple };
                let equation = match kind {
                    Kind::Torque => "sum of cosine_i cos(order_i q) + sine_i sin(order_i q)",
                    Kind::Friction => "(sum of cosine_i cos(order_i q) + sine_i sin(order_i q)) s(v)",
                    Kind::Position => "to the position: sum of cosine_i cos(order_i q) + sine_i sin(order_i q)",
                };
                let mut term = self.plain(effect, equation, &[]);
                term.parameters = lines.collect();
                term.parameters.extend(self.width_of(kind, smoothing_velocity));
                term
            }
            Effect::PositionTable { kind, smoothing_velocity, ref table } => {
                let equation = match kind {
                    Kind::Torque => "b(q), a table of cubic cells",
                    Kind::Friction => "b(q) s(v), b a table of cubic cells",
                    Kind::Position => "to the position: b(q), a table of cubic cells",
                };
                let mut term =
                    self.plain(EffectId::PositionFriction, equation, &[("cells", table.cells() as f32, One)]);
                term.parameters.extend(self.width_of(kind, smoothing_velocity));
                term
            }
            Effect::Play { half_width, torque } => {
                let equation = "torque (q - w) / half_width, to the position: w - q, \
                                w <- min(max(w, q - half_width), q + half_width)";
                let parameters = [("half_width", half_width, Position), ("torque", torque, Torque)];
                let mut term = self.plain(EffectId::Backlash, equation, &parameters);
                term.state = vec![state("position of the link w", &self.unit(Position), None), started()];
                term
            }
            Effect::WindupHysteresis { torque, distance } => {
                let equation = "torque z, z <- z r + (1 - r) sgn(dq), r = exp(-|dq| / distance)";
                let parameters = [("torque", torque, Torque), ("distance", distance, Position)];
                let mut term = self.plain(EffectId::WindupHysteresis, equation, &parameters);
                term.state = vec![state("share z", "1", Some([-1.0, 1.0]))];
                term.distance_from = self.distance_from();
                term
            }
            Effect::Spring { stiffness, rest } => self.plain(
                EffectId::Spring,
                "stiffness (q - rest)",
                &[("stiffness", stiffness, TorquePerPosition), ("rest", rest, Position)],
            ),
        }
    }

    /// A term without a memory.
    fn plain(&self, effect: EffectId, equation: &'static str, parameters: &[(&str, f32, Dimension)]) -> Term {
        let parameter =
            |&(name, value, dimension): &(&str, f32, Dimension)| self.parameter(name.into(), value, dimension);
        Term {
            effect: effect.name(),
            equation,
            parameters: parameters.iter().map(parameter).collect(),
            state: Vec::new(),
            distance_from: None,
        }
    }

    fn parameter(&self, name: String, value: f32, dimension: Dimension) -> TermParameter {
        TermParameter { name, value, unit: self.unit(dimension) }
    }

    /// The width of the smoothed sign, where a term has one.
    fn width_of(&self, kind: Kind, width: f32) -> Option<TermParameter> {
        (kind == Kind::Friction).then(|| self.parameter("smoothing_velocity".into(), width, Dimension::Velocity))
    }

    fn unit(&self, dimension: Dimension) -> String {
        unit_text(dimension, self.rotary, self.actuator)
    }

    fn distance_from(&self) -> Option<&'static str> {
        Some(if self.reads_position { "position" } else { "velocity" })
    }
}

/// Dimension of what a term of a kind adds.
fn of_kind(kind: Kind) -> Dimension {
    if kind == Kind::Position { Dimension::Position } else { Dimension::Torque }
}

fn state(name: &str, unit: &str, range: Option<[f32; 2]>) -> TermState {
    TermState { name: name.into(), unit: unit.into(), range }
}

fn started() -> TermState {
    state("whether there was a sample before", "1", Some([0.0, 1.0]))
}

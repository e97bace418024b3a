//! BAM's friction as the formula of an image, and the way back: one description of the formula, whose every constant is one parameter.

use std::collections::BTreeMap;

use frikan_shared::expression::{MAX_OPERATIONS, Operation, Program};
use frikan_shared::model::Law;
use frikan_shared::units::Quantity;

use super::parameters::Parameters;
use super::variant::{LoadFriction, Variant};
use crate::compile::host_model::HostModel;

/// Inputs of the formula in their order: velocity, torque of the motor, position.
const VELOCITY: u8 = 0;
const MOTOR: u8 = 1;
const POSITION: u8 = 2;

/// Keys of what the formula holds beside friction.
pub(super) const SIGN_SLOPE: &str = "sign_slope";
pub(super) const GRAVITY: &str = "gravity";
pub(super) const GRAVITY_PHASE: &str = "gravity_phase";

/// What the constant of an operation is.
#[derive(Clone, Copy, Debug)]
enum Holds {
    /// The same in every law.
    Fixed(f32),
    /// A parameter.
    Value(&'static str),
    /// A parameter with the other sign.
    Negated(&'static str),
    /// One over a parameter.
    Inverse(&'static str),
}

/// An operation, made of its constant.
struct Slot {
    make: fn(f32) -> Operation,
    holds: Holds,
}

/// What a formula reads of the torques at the gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Torques {
    /// Nothing.
    None,
    /// That of the motor alone: none from outside.
    Motor,
    /// That of the motor, and from outside that of gravity, which follows from the position.
    Both(LoadFriction),
}

/// A formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Form {
    pub(super) torques: Torques,
    has_peak: bool,
    has_squares: bool,
}

impl Form {
    /// That of a friction model; `hangs` says whether there is a torque from outside.
    pub(super) fn of(variant: Variant, hangs: bool) -> Self {
        let torques = match variant.load() {
            None => Torques::None,
            Some(_) if !hangs => Torques::Motor,
            Some(load) => Torques::Both(load),
        };
        let has_squares = variant == Variant::M6 && matches!(torques, Torques::Both(_));
        Self { torques, has_peak: variant.has_peak(), has_squares }
    }

    /// Every formula, with the friction model that it is one of.
    fn all() -> impl Iterator<Item = (Self, Variant)> {
        let of = |hangs| Variant::ALL.into_iter().map(move |variant| (Self::of(variant, hangs), variant));
        of(true).chain(of(false))
    }

    /// What it reads, in its order.
    pub(super) fn inputs(self) -> &'static [Quantity] {
        match self.torques {
            Torques::None => &[Quantity::Velocity],
            Torques::Motor => &[Quantity::Velocity, Quantity::Load],
            Torques::Both(_) => &[Quantity::Velocity, Quantity::Load, Quantity::Position],
        }
    }

    /// Its operations: `level tanh(slope v) + viscous v`.
    fn slots(self) -> Vec<Slot> {
        let mut slots = Vec::with_capacity(MAX_OPERATIONS);
        match self.torques {
            Torques::None => slots.push(value(Operation::Constant, "friction_base")),
            Torques::Motor => {
                slots.extend([motor_share("load_friction_motor"), value(Operation::Offset, "friction_base")]);
            }
            Torques::Both(load) => {
                slots.extend(gear_share(load, ["load_friction_base", "load_friction_motor", "load_friction_external"]));
                slots.push(value(Operation::Offset, "friction_base"));
            }
        }
        if self.has_peak {
            match self.torques {
                Torques::None => slots.push(value(Operation::Constant, "friction_stribeck")),
                Torques::Motor => slots.extend([
                    motor_share("load_friction_motor_stribeck"),
                    value(Operation::Offset, "friction_stribeck"),
                ]),
                Torques::Both(load) => {
                    let keys =
                        ["load_friction_stribeck", "load_friction_motor_stribeck", "load_friction_external_stribeck"];
                    slots.extend(gear_share(load, keys));
                    if self.has_squares {
                        slots.extend(squares());
                    }
                    slots.push(value(Operation::Offset, "friction_stribeck"));
                }
            }
            slots.extend([
                Slot {
                    make: |constant| Operation::ScaledMagnitude(VELOCITY, constant),
                    holds: Holds::Inverse("dtheta_stribeck"),
                },
                value(Operation::PowerOf, "alpha"),
                plain(|_| Operation::Negate),
                plain(|_| Operation::Exp),
                plain(|_| Operation::Multiply),
                plain(|_| Operation::Add),
            ]);
        }
        slots.extend([
            value(|constant| Operation::ScaledInput(VELOCITY, constant), SIGN_SLOPE),
            plain(|_| Operation::Tanh),
            plain(|_| Operation::Multiply),
            value(|constant| Operation::AddScaledInput(VELOCITY, constant), "friction_viscous"),
        ]);
        slots
    }

    /// Its program with these constants, by their keys; those that are not there are 0.
    pub(super) fn program(self, constants: &BTreeMap<&'static str, f64>) -> Program {
        let of = |key: &str| constants.get(key).copied().unwrap_or(0.0);
        let operation = |slot: &Slot| {
            (slot.make)(match slot.holds {
                Holds::Fixed(constant) => constant,
                Holds::Value(key) => of(key) as f32,
                Holds::Negated(key) => -of(key) as f32,
                Holds::Inverse(key) => of(key).recip() as f32,
            })
        };
        Program { operations: self.slots().iter().map(operation).collect() }
    }

    /// The constants of a program that is one of this form.
    fn constants(self, program: &Program) -> Option<BTreeMap<&'static str, f64>> {
        let slots = self.slots();
        let mut constants: BTreeMap<&'static str, f64> = BTreeMap::new();
        if slots.len() != program.operations.len() {
            return None;
        }
        for (slot, operation) in slots.iter().zip(&program.operations) {
            let constant = constant(*operation);
            if (slot.make)(constant) != *operation {
                return None;
            }
            let found = decimal(constant);
            let (key, found) = match slot.holds {
                Holds::Fixed(expected) if expected == constant => continue,
                Holds::Fixed(_) => return None,
                Holds::Value(key) => (key, found),
                Holds::Negated(key) => (key, -found),
                Holds::Inverse(key) => (key, found.recip()),
            };
            if *constants.entry(key).or_insert(found) != found {
                return None;
            }
        }
        Some(constants)
    }
}

fn value(make: fn(f32) -> Operation, key: &'static str) -> Slot {
    Slot { make, holds: Holds::Value(key) }
}

fn plain(make: fn(f32) -> Operation) -> Slot {
    Slot { make, holds: Holds::Fixed(0.0) }
}

/// A share of the magnitude of the motor's torque.
fn motor_share(key: &'static str) -> Slot {
    value(|constant| Operation::ScaledMagnitude(MOTOR, constant), key)
}

/// The torque of gravity that the actuator has to put out, `gravity sin(q + phase)`: from outside acts its opposite.
fn from_outside(sign: fn(&'static str) -> Holds) -> [Slot; 4] {
    [
        plain(|_| Operation::Input(POSITION)),
        value(Operation::Offset, GRAVITY_PHASE),
        plain(|_| Operation::Sin),
        Slot { make: Operation::Scale, holds: sign(GRAVITY) },
    ]
}

/// A share of the torque at the gear: of `|external - motor|`, or of the magnitude of the difference of shares of both.
fn gear_share(load: LoadFriction, [of_both, of_motor, of_external]: [&'static str; 3]) -> Vec<Slot> {
    let mut slots: Vec<Slot> = from_outside(Holds::Negated).into_iter().collect();
    let minus_motor = |holds| Slot { make: |constant| Operation::AddScaledInput(MOTOR, constant), holds };
    match load {
        LoadFriction::Gear => slots.extend([
            minus_motor(Holds::Fixed(-1.0)),
            plain(|_| Operation::Absolute),
            value(Operation::Scale, of_both),
        ]),
        LoadFriction::Directional => slots.extend([
            value(Operation::Scale, of_external),
            minus_motor(Holds::Negated(of_motor)),
            plain(|_| Operation::Absolute),
        ]),
    }
    slots
}

/// The square of the smaller of two torques that oppose each other, e from outside and m of the motor, added to what is there. That of e is it
/// where `e (e + m) < 0`, that of m where `m (e + m) < 0`.
fn squares() -> Vec<Slot> {
    let sum = || {
        let plus_motor = Slot { make: |constant| Operation::AddScaledInput(MOTOR, constant), holds: Holds::Fixed(1.0) };
        from_outside(Holds::Negated).into_iter().chain([plus_motor])
    };
    // 1 where what is on the stack is above 0, else 0.
    let step = || {
        [
            plain(|_| Operation::Multiply),
            plain(|_| Operation::Sign),
            plain(Operation::Constant),
            plain(|_| Operation::Maximum),
        ]
    };
    let mut slots = Vec::new();
    slots.extend(from_outside(Holds::Value));
    slots.extend(sum());
    slots.extend(step());
    slots.extend(from_outside(Holds::Negated));
    slots.extend([
        plain(|_| Operation::Square),
        value(Operation::Scale, "load_friction_external_quad"),
        plain(|_| Operation::Multiply),
        plain(|_| Operation::Add),
    ]);
    slots.extend(sum());
    slots.push(Slot { make: |constant| Operation::ScaledInput(MOTOR, constant), holds: Holds::Fixed(-1.0) });
    slots.extend(step());
    slots.extend([
        plain(|_| Operation::Input(MOTOR)),
        plain(|_| Operation::Square),
        value(Operation::Scale, "load_friction_motor_quad"),
        plain(|_| Operation::Multiply),
        plain(|_| Operation::Add),
    ]);
    slots
}

/// A constant as the shortest number that is it in `f32`, so that a file has 0.26 and not what `f32` makes of it.
fn decimal(constant: f32) -> f64 {
    constant.to_string().parse().unwrap_or(f64::from(constant))
}

/// The constant that an operation carries; 0 of one that has none.
fn constant(operation: Operation) -> f32 {
    match operation {
        Operation::ScaledInput(_, constant)
        | Operation::ScaledMagnitude(_, constant)
        | Operation::AddScaledInput(_, constant)
        | Operation::Constant(constant)
        | Operation::Scale(constant)
        | Operation::Offset(constant)
        | Operation::PowerOf(constant) => constant,
        _ => 0.0,
    }
}

/// The friction of a model whose law is one of BAM's, as [`super::image`] writes it: with no torque from outside, that of `m5` where it reads the
/// torque of the motor. `None` of any other law.
#[must_use]
pub fn recognised(model: &HostModel, actuator: &str) -> Option<Parameters> {
    let Law::Expression(program) = &model.law else { return None };
    let reads: Vec<&Quantity> = model.inputs.iter().map(|input| &input.quantity).collect();
    let mut forms = Form::all().filter(|(form, _)| form.inputs().iter().eq(reads.iter().copied()));
    let (form, variant, constants) =
        forms.find_map(|(form, variant)| Some((form, variant, form.constants(program)?)))?;
    let variant = if form.torques == Torques::Motor { Variant::M5 } else { variant };
    // Of a peak that the law does not have, its width and its shape have no meaning; neither may be 0.
    let otherwise = |key: &str| if ["dtheta_stribeck", "alpha"].contains(&key) { 1.0 } else { 0.0 };
    let values =
        variant.keys().into_iter().map(|key| (key, constants.get(key).copied().unwrap_or_else(|| otherwise(key))));
    Some(Parameters::new(variant, actuator, values))
}

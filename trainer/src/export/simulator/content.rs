//! What an image has to say to a simulator: friction in its forms, inertia, and what no form holds.

use frikan_shared::effect::{Effect, Kind};
use frikan_shared::image::Image;
use frikan_shared::model::{Law, RigidBody};
use frikan_shared::units::Unit;

use super::actuator::SimulatedActuator;
use super::form::{Form, WORTH_IT};
use super::law::{FrictionCurve, Load, of_velocity};
use super::request::Request;
use super::trial::IdentifiedJoint;
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::fit::CELLS;
use crate::markup::escape;

/// Share by which bodies may seem heavier than the identified inertia and still be as heavy: what the inertia of recordings is off by.
const SAME_INERTIA: f64 = 0.05;

/// Share of the law below which an error is none: fewer digits than recordings determine.
const NEGLIGIBLE: f64 = 1e-2;

/// An image in N m or N.
#[derive(Debug)]
pub(super) struct Content<'a> {
    pub(super) title: &'a str,
    /// Name of the joint as asked for, or in the image; may be empty.
    pub(super) joint: &'a str,
    pub(super) is_linear: bool,
    pub(super) curve: FrictionCurve,
    pub(super) coulomb_viscous: Form,
    /// Inertia (kg m2 or kg), gravity and offset (N m or N).
    pub(super) body: RigidBody,
    effects: &'a [Effect],
    torque_per_unit: f64,
    has_other_inputs: bool,
    /// What drives the joint, where it does not put out the torque that it is told.
    pub(super) actuator: Option<SimulatedActuator>,
}

/// A cogging torque, `amplitude sin(order q + phase)`, that the actuator has to add.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cogging {
    pub(super) amplitude: f64,
    pub(super) order: f64,
    pub(super) phase: f64,
}

impl<'a> Content<'a> {
    /// An image for a simulator.
    ///
    /// # Errors
    /// `FRK-U001` for a law that does not depend on the velocity, or of a current without its constants.
    pub(super) fn of(image: &'a Image<CELLS>, request: &Request<'a>) -> Result<Self> {
        let (model, title, torque_per_ampere) = (&image.model, request.title, request.torque_per_ampere);
        let is_linear = model.inputs.iter().any(|input| input.unit == Unit::MetrePerSecond);
        let torque_per_unit = match (model.output_unit, torque_per_ampere) {
            (Unit::NewtonMetre | Unit::Newton, _) => 1.0,
            (Unit::Ampere, Some(constant)) => constant,
            (other, _) => {
                let message = format!(
                    "a simulator takes N m or N, this law is in {}; give `--joint JOINT.toml` with `torque_constant_Nm_A` and `gear_ratio` under [drive]",
                    other.symbol()
                );
                return Err(Error::new(&codes::USAGE, message));
            }
        };
        let scaled = |value: f32| (f64::from(value) * torque_per_unit) as f32;
        let body = model.rigid_body;
        let curve = FrictionCurve::of(model, torque_per_unit)?;
        Ok(Self {
            title,
            joint: request.joint.unwrap_or(image.provenance.joint.as_str()),
            is_linear: is_linear || model.output_unit == Unit::Newton,
            coulomb_viscous: Form::coulomb_viscous(&curve),
            body: RigidBody {
                inertia: scaled(body.inertia * (1.0 + load_scale(&model.effects))),
                gravity_sin: scaled(body.gravity_sin),
                gravity_cos: scaled(body.gravity_cos),
                offset: scaled(body.offset) + curve.offset as f32,
                ..body
            },
            curve,
            effects: &model.effects,
            torque_per_unit,
            actuator: request.actuator,
            has_other_inputs: model.inputs.len() > 1 && matches!(model.law, Law::Network(_) | Law::Expression(_)),
        })
    }

    /// Identified inertia of link and rotor, kg m2 or kg; `None` where the image has none, or only what it adds to that of a given rigid body.
    pub(super) fn inertia(&self) -> Option<f64> {
        Some(f64::from(self.body.inertia)).filter(|inertia| *inertia > 0.0 && self.body.given_scale == 0.0)
    }

    /// The same where the bodies of the simulator, of this inertia, are the rigid body that was given.
    pub(super) fn inertia_with(&self, bodies: f64) -> Option<f64> {
        let given = f64::from(self.body.given_scale) * bodies;
        Some(f64::from(self.body.inertia) + given).filter(|inertia| *inertia > 0.0)
    }

    /// What the bodies lack of the identified inertia, at least 0; `None` where the image has no inertia.
    ///
    /// # Errors
    /// `FRK-D030` where the bodies have more than was identified, which no armature takes away.
    pub(super) fn armature(&self, bodies: f64) -> Result<Option<f64>> {
        let Some(inertia) = self.inertia_with(bodies) else { return Ok(None) };
        let lack = inertia - bodies;
        if lack < -SAME_INERTIA * inertia {
            let message = format!(
                "the bodies have {} {unit} about this joint and {} {unit} were identified, link and rotor together: no armature takes inertia away, so the bodies are too heavy or the recording was of another load",
                digits(bodies),
                digits(inertia),
                unit = self.inertia_unit(),
            );
            return Err(Error::new(&codes::BAD_MODEL_FILE, message));
        }
        Ok(Some(lack.max(0.0)))
    }

    /// The joint as identified, on an inertia, for a trial.
    pub(super) fn identified(&self, inertia: f64) -> IdentifiedJoint {
        let (top, mut friction) = (self.curve.top(), self.curve.table.clone());
        // What yields comes back through its own elements.
        let cells = (friction.len() - 1) as f64;
        for (torque, width) in self.yielding() {
            for (place, friction) in friction.iter_mut().enumerate() {
                *friction -= torque * (top * (2.0 * place as f64 / cells - 1.0) / width).tanh();
            }
        }
        IdentifiedJoint { inertia, friction, top, presliding: self.presliding() }
    }

    /// Units of the torque and the velocity.
    pub(super) fn units(&self) -> [&'static str; 2] {
        if self.is_linear { ["N", "m/s"] } else { ["N m", "rad/s"] }
    }

    /// The nearest form with damping in powers of the velocity, where it is worth them.
    pub(super) fn damped(&self) -> Form {
        self.better(Form::polynomial(&self.curve), self.coulomb_viscous).unwrap_or(self.coulomb_viscous)
    }

    /// The nearest form with a Stribeck peak, where it is worth it.
    pub(super) fn with_stribeck(&self) -> Option<Form> {
        let [viscous, polynomial] = [1, 3].map(|powers| Form::stribeck(&self.curve, powers));
        let viscous = self.better(viscous, self.damped());
        self.better(polynomial, viscous.unwrap_or_else(|| self.damped())).or(viscous)
    }

    /// Torque at which the joint breaks away, never below the Coulomb friction.
    pub(super) fn static_friction(&self) -> f64 {
        let coulomb = self.coulomb_viscous.coulomb;
        self.with_stribeck().map_or(coulomb, |form| form.at_rest().max(coulomb))
    }

    /// The unit of the inertia.
    pub(super) fn inertia_unit(&self) -> &'static str {
        if self.is_linear { "kg" } else { "kg m2" }
    }

    /// The joint's name as it may stand in XML; `frikan` where the image has none.
    pub(super) fn name_in_xml(&self) -> String {
        if self.joint.is_empty() { "frikan".to_owned() } else { escape(self.joint) }
    }

    fn better(&self, richer: Option<Form>, simpler: Form) -> Option<Form> {
        let rms = |form: &Form| form.deviation(&self.curve).rms;
        let simple = simpler.deviation(&self.curve);
        richer.filter(|form| simple.rms > NEGLIGIBLE * simple.law && rms(form) < WORTH_IT * simple.rms)
    }

    /// Torque for each radian (metre) of presliding at a reversal; `None` without such a term.
    pub(super) fn presliding_stiffness(&self) -> Option<f64> {
        let elements = self.presliding();
        (!elements.is_empty()).then(|| elements.iter().map(|[torque, distance]| torque / distance).sum())
    }

    /// Torque of presliding, N m (N), and the velocity over which its sign is smoothed.
    fn yielding(&self) -> impl Iterator<Item = (f64, f64)> {
        self.effects.iter().filter_map(|effect| match effect {
            Effect::Presliding { elements, smoothing_velocity } => {
                let torque: f32 = elements.iter().map(|element| element.torque).sum();
                Some((self.torque_per_unit * f64::from(torque), f64::from(*smoothing_velocity)))
            }
            _ => None,
        })
    }

    /// Torque and distance of each element of presliding, N m and rad (N and m).
    fn presliding(&self) -> Vec<[f64; 2]> {
        let elements = self.effects.iter().filter_map(|effect| match effect {
            Effect::Presliding { elements, .. } => Some(elements.iter()),
            _ => None,
        });
        let scaled = |torque: f32| self.torque_per_unit * f64::from(torque);
        elements.flatten().map(|element| [scaled(element.torque), f64::from(element.distance)]).collect()
    }

    /// Stiffness and rest position of a spring; `None` without one or where it pushes away.
    pub(super) fn spring(&self) -> Option<(f64, f64)> {
        self.effects.iter().find_map(|effect| match effect {
            Effect::Spring { stiffness, rest } if *stiffness > 0.0 => {
                Some((self.torque_per_unit * f64::from(*stiffness), f64::from(*rest)))
            }
            _ => None,
        })
    }

    /// Cogging torques, one a line of a ripple that does not depend on the direction.
    pub(super) fn cogging(&self) -> Vec<Cogging> {
        let mut found = Vec::new();
        for effect in self.effects {
            let Effect::Ripple { kind: Kind::Torque, harmonics, .. } = effect else { continue };
            found.extend(harmonics.iter().map(|line| {
                let (sine, cosine) = (f64::from(line.sine), f64::from(line.cosine));
                let amplitude = self.torque_per_unit * sine.hypot(cosine);
                Cogging { amplitude, order: f64::from(line.order), phase: cosine.atan2(sine) }
            }));
        }
        found
    }

    /// Effects of the image that no friction over velocity holds, by their names, but for those that `held` says.
    pub(super) fn left_out(&self, held: impl Fn(&Effect) -> bool) -> Vec<&'static str> {
        let rest =
            self.effects.iter().filter(|effect| of_velocity(effect, 0.0, Load::default()).is_none() && !held(effect));
        rest.map(name).collect()
    }

    /// Title, form and its error, and what is left out.
    pub(super) fn remark(&self, form: &Form, held: impl Fn(&Effect) -> bool) -> String {
        let [torque, velocity] = self.units();
        let error = form.deviation(&self.curve);
        let mut text = format!(
            "{}. Friction from {} to {} {velocity}: this form leaves {} {torque} rms, {} {torque} at most, of {} {torque} rms.",
            self.title,
            digits(self.curve.risen),
            digits(self.curve.top()),
            digits(error.rms),
            digits(error.max),
            digits(error.law),
        );
        if self.has_other_inputs {
            text += " Other inputs of the law stand in the middle of their trained range.";
        }
        if self.effects.iter().any(is_load_friction) {
            text += " Load-dependent friction stands at its mean over the trained range of the load.";
        }
        let left_out = self.left_out(held);
        if !left_out.is_empty() {
            text += &format!(" Left out: {}.", left_out.join(", "));
        }
        if f64::from(self.body.offset).abs() > NEGLIGIBLE * error.law {
            text += &format!(" Left out: a constant torque of {} {torque}.", digits(f64::from(self.body.offset)));
        }
        text
    }

    /// The identified gravity torque, for comparison with the bodies of the simulator.
    pub(super) fn gravity(&self) -> Option<String> {
        let (sine, cosine) = (f64::from(self.body.gravity_sin), f64::from(self.body.gravity_cos));
        (sine != 0.0 || cosine != 0.0).then(|| {
            format!(
                "Identified gravity torque {} N m sin(q {} {} rad): compare it with the bodies.",
                digits(sine.hypot(cosine)),
                if cosine < 0.0 { '-' } else { '+' },
                digits(cosine.atan2(sine).abs())
            )
        })
    }
}

/// Whether friction grows with the load, not only the torque that drives it.
fn is_load_friction(effect: &Effect) -> bool {
    matches!(effect, Effect::Load { mean, quadratic, stribeck, .. } if [*mean, *quadratic, *stribeck] != [0.0; 3])
}

/// By how much driving and backdriving a load differ from it, as a share of the load: what no motion tells from a rigid body that is so
/// much larger (Hamon, Gautier & Garrec 2010), and a simulator can have as inertia only.
fn load_scale(effects: &[Effect]) -> f32 {
    let shares =
        effects.iter().map(|effect| if let Effect::Load { difference, .. } = effect { *difference } else { 0.0 });
    shares.sum()
}

/// Name of an effect in plain words.
fn name(effect: &Effect) -> &'static str {
    match effect {
        Effect::Coulomb { .. } => "Coulomb and viscous friction",
        Effect::Stribeck { .. } => "Stribeck friction",
        Effect::PowerViscous { .. } => "nonlinear viscous friction",
        Effect::Asymmetry { .. } => "friction that differs between the directions",
        Effect::Temperature { .. } => "friction over temperature",
        Effect::WarmUp { .. } => "warm-up",
        Effect::Load { .. } => "load-dependent friction",
        Effect::FrictionalLag { .. } => "frictional lag",
        Effect::Presliding { .. } => "presliding",
        Effect::DwellBreakaway { .. } => "breakaway that rises with the dwell",
        Effect::Ripple { .. } => "position ripple",
        Effect::PositionTable { .. } => "friction or torque over position",
        Effect::Play { .. } => "backlash",
        Effect::WindupHysteresis { .. } => "wind-up hysteresis",
        Effect::Spring { .. } => "spring",
    }
}

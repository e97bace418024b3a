//! From a named effect with its shape and coefficients to the term that a drive runs, or to a change of the rigid body.

mod cosine_series;

use self::cosine_series::CosineSeries;
use super::tables::compile_layout;
use crate::physics::{Action, EffectId};
use frikan_shared::effect::{Effect, Element, Harmonic, Kind, MAX_EFFECTS, MAX_ELEMENTS, MAX_HARMONICS};
use frikan_shared::model::{Law, MAX_INPUTS, Model, RigidBody};
use frikan_shared::pool::DRIVE_CELLS;
use frikan_shared::table::{Cell, Table, Uniform, UniformShape};
use frikan_shared::units::Quantity;

/// Cells of a table over position.
const POSITION_CELLS: u16 = 24;

/// Distance of a presliding element over that of the one before (the equation of `physics::presliding`).
const DISTANCE_RATIO: f64 = 4.0;

/// Why a table is left out.
const NO_CELLS: &str = "the drive has no room for the cells of its table";

/// What the coefficients of the effects refer to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Context {
    /// Width of the smoothed sign, rad/s or m/s.
    pub smoothing_velocity: f64,
    /// Load that scales a power of it, in the unit of the actuator.
    pub load_scale: f64,
    /// Longest stop of the recording, s.
    pub longest_dwell: f64,
    /// Largest power that friction dissipated in the recording, W.
    pub power_limit: f64,
    /// Power that the friction dissipated of which warmth was measured, over that of the law that the drive evaluates.
    pub power_ratio: f64,
    /// Length of the recording, s.
    pub duration: f64,
    /// Whether the model may read the position: it is recorded, and the law has room for another channel or reads it anyway.
    pub may_read_position: bool,
}

/// Whether a model may read the position beside what it reads: a network reads what it was fitted on, and a model so many channels.
#[must_use]
pub fn has_room_for_position<const CELLS: usize>(model: &Model<CELLS>) -> bool {
    let reads_position = model.inputs.iter().any(|input| input.quantity == Quantity::Position);
    reads_position || !(model.inputs.is_full() || matches!(model.law, Law::Network(_)))
}

/// Terms collected for one image.
#[derive(Clone, Debug, Default)]
pub struct Terms {
    /// Rigid-body parameters in force.
    pub rigid_body: RigidBody,
    /// Correction terms.
    pub effects: Vec<Effect>,
    /// Cells of their tables; the first belongs at [`Terms::first_cell`].
    pub cells: Vec<Cell>,
    /// Place of the first cell in the image's pool.
    pub first_cell: u16,
    /// Channels that the terms read beside those of the law.
    pub channels: Vec<Quantity>,
    /// Channels of the law.
    pub inputs: Vec<Quantity>,
    /// What of the terms there is room for.
    pub room: Room,
    /// Whether a table was left out for want of cells.
    pub lacks_cells: bool,
}

/// What there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    /// Channels of the model, those of the law among them.
    pub channels: usize,
    /// Cells of the pool, those of the law among them.
    pub cells: usize,
}

impl Default for Room {
    fn default() -> Self {
        Self { channels: MAX_INPUTS, cells: DRIVE_CELLS }
    }
}

impl Terms {
    /// Adds an effect.
    ///
    /// # Errors
    /// Why the effect is not for the drive, in a few words.
    pub fn add(
        &mut self,
        effect: EffectId,
        shape: &[f64],
        coefficients: &[f64],
        context: &Context,
    ) -> Result<(), &'static str> {
        match effect.action() {
            Action::Maintenance => return Err("it is to be looked at, not compensated"),
            Action::Measurement => return Err("the measurement is to be repaired, not compensated"),
            Action::FeedForward | Action::Parameter => {}
        }
        if self.correct_rigid_body(effect, shape, coefficients) {
            return Ok(());
        }
        let before = self.clone();
        self.add_term(effect, shape, coefficients, context).inspect_err(|why| {
            *self = before;
            self.lacks_cells |= *why == NO_CELLS;
        })
    }

    /// Adds the term of an effect; where it has no room, part of it may stay behind.
    fn add_term(
        &mut self,
        effect: EffectId,
        shape: &[f64],
        coefficients: &[f64],
        context: &Context,
    ) -> Result<(), &'static str> {
        match self.term(effect, shape, coefficients, context)? {
            // The law sees the velocity that a lag gives: it is the first.
            lag @ Effect::FrictionalLag { .. } => self.effects.insert(0, lag),
            Effect::Ripple { kind, harmonics, .. } if self.has_room(kind, harmonics.len()) => {
                self.ripple(kind).into_iter().for_each(|lines| lines.extend(harmonics.iter().copied()));
            }
            term => self.effects.push(term),
        }
        if self.effects.len() > MAX_EFFECTS {
            return Err("the image holds as many effects as it can");
        }
        if self.inputs.len() + self.channels.len() > self.room.channels {
            return Err("the image has no room for the channel that it reads");
        }
        if usize::from(self.first_cell) + self.cells.len() > self.room.cells {
            return Err(NO_CELLS);
        }
        Ok(())
    }

    /// Corrects the rigid body where the effect is one of its parameters.
    fn correct_rigid_body(&mut self, effect: EffectId, shape: &[f64], coefficients: &[f64]) -> bool {
        let body = &mut self.rigid_body;
        let first = coefficients[0] as f32;
        match effect {
            EffectId::GravityError => match shape[0] {
                0.0 => body.gravity_cos += first,
                1.0 => body.gravity_sin += first,
                _ => {
                    body.gravity_cos += first;
                    body.gravity_sin += coefficients[1] as f32;
                }
            },
            EffectId::InertiaError => body.inertia += first,
            EffectId::TorqueOffset => body.offset += first,
            EffectId::TorqueScale => {
                let factor = 1.0 + first;
                body.inertia *= factor;
                body.gravity_sin *= factor;
                body.gravity_cos *= factor;
                body.offset *= factor;
                body.given_scale *= factor;
            }
            _ => return false,
        }
        true
    }

    fn term(&mut self, effect: EffectId, shape: &[f64], c: &[f64], context: &Context) -> Result<Effect, &'static str> {
        let smoothing_velocity = context.smoothing_velocity as f32;
        // Coefficients of a pair of which a variant has the first, the second or both.
        let pair = |variant: f64| match variant {
            0.0 => (c[0] as f32, 0.0),
            1.0 => (0.0, c[0] as f32),
            _ => (c[0] as f32, c[1] as f32),
        };
        Ok(match effect {
            EffectId::Stribeck => Effect::Stribeck {
                amplitude: c[0] as f32,
                velocity: shape[0] as f32,
                exponent: shape[1] as f32,
                smoothing_velocity,
            },
            EffectId::ViscousNonlinearity => {
                Effect::PowerViscous { coefficient: c[0] as f32, exponent: shape[0] as f32, smoothing_velocity }
            }
            EffectId::DirectionAsymmetry => {
                let (coulomb, viscous) = pair(shape[0]);
                Effect::Asymmetry { coulomb, viscous, smoothing_velocity }
            }
            EffectId::Temperature => {
                self.read(Quantity::Temperature);
                let (coulomb, viscous) = pair(shape[0]);
                let (reference, decay) = (shape[1] as f32, shape[2] as f32);
                Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity }
            }
            EffectId::WarmUp => {
                let (coulomb, viscous) = pair(shape[1]);
                let [time_constant, power_limit, ratio] =
                    [shape[0], context.power_limit, context.power_ratio].map(|value| value as f32);
                let (coulomb, viscous) = (ratio * coulomb, ratio * viscous);
                Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity }
            }
            EffectId::LoadFriction => {
                let quadratic = shape[0] != 1.0;
                let scaled = c[0] / if quadratic { context.load_scale.max(f64::MIN_POSITIVE) } else { 1.0 };
                let (mean, quadratic) = if quadratic { (0.0, scaled) } else { (scaled, 0.0) };
                let mut effect = self.load(mean, 0.0, quadratic, smoothing_velocity);
                if let (Some(extra), Effect::Load { stribeck, velocity, .. }) = (c.get(1), &mut effect) {
                    (*stribeck, *velocity) = (*extra as f32, shape[1] as f32);
                }
                effect
            }
            EffectId::DriveBackdrive => {
                let (driving, backdriving) = pair(shape[0]);
                let (driving, backdriving) = (f64::from(driving), f64::from(backdriving));
                self.load(0.5 * (driving + backdriving), 0.5 * (driving - backdriving), 0.0, smoothing_velocity)
            }
            EffectId::SlowDrift => {
                let age = context.duration;
                let bend = c.get(1).map_or(0.0, |bend| bend * age * age);
                Effect::Coulomb { coulomb: (c[0] * age + bend) as f32, viscous: 0.0, smoothing_velocity }
            }
            EffectId::Presliding => {
                self.read_way(context);
                Effect::Presliding { smoothing_velocity, elements: elements(shape[0], c)? }
            }
            EffectId::FrictionalLag => Effect::FrictionalLag { time_constant: (c[0] * shape[0]).max(1e-6) as f32 },
            EffectId::DwellBreakaway => {
                self.read_way(context);
                Effect::DwellBreakaway {
                    gain: c[0] as f32,
                    time: shape[1] as f32,
                    distance: shape[0] as f32,
                    rest_velocity: 0.5 * smoothing_velocity,
                    dwell_limit: context.longest_dwell.max(0.1) as f32,
                    smoothing_velocity,
                }
            }
            EffectId::PositionRipple => {
                let kind = if shape[1] == 1.0 { Kind::Friction } else { Kind::Torque };
                self.harmonic(kind, [shape[0], c[0], c[1]], smoothing_velocity)?
            }
            EffectId::KinematicError => {
                // Identified is the amplitude times the inertia behind the gear, of which a motor encoder does not tell the share.
                // The whole inertia gives a correction of the position that is never larger than the error.
                let inertia = f64::from(self.rigid_body.inertia);
                if inertia <= 0.0 {
                    return Err("without the inertia of the joint its amplitude is not known");
                }
                self.harmonic(Kind::Position, [shape[0], c[0] / inertia, c[1] / inertia], smoothing_velocity)?
            }
            EffectId::Backlash => {
                self.read(Quantity::Position);
                Effect::Play { half_width: shape[0] as f32, torque: 0.0 }
            }
            EffectId::PositionFriction => self.position_friction(shape, c, smoothing_velocity),
            EffectId::Spring => {
                self.read(Quantity::Position);
                self.rigid_body.offset += c.get(1).copied().unwrap_or(0.0) as f32;
                Effect::Spring { stiffness: c[0] as f32, rest: 0.0 }
            }
            EffectId::Coupling => return Err("the motion of the other joint is not a channel of the image"),
            _ if effect.is_of_actuator() => {
                return Err("it is a constant of the actuator, to be corrected in joint.toml");
            }
            _ => return Err("the image has no torque term for it"),
        })
    }

    /// A ripple of one line: its order, and the coefficients of cosine and sine.
    fn harmonic(&mut self, kind: Kind, line: [f64; 3], smoothing_velocity: f32) -> Result<Effect, &'static str> {
        self.read(Quantity::Position);
        let [order, cosine, sine] = line.map(|value| value as f32);
        let mut harmonics = heapless::Vec::new();
        harmonics.push(Harmonic { order, cosine, sine }).map_err(|_| "the ripple has too many lines")?;
        Ok(Effect::Ripple { kind, smoothing_velocity, harmonics })
    }

    fn load(&mut self, mean: f64, difference: f64, quadratic: f64, smoothing_velocity: f32) -> Effect {
        self.read(Quantity::Load);
        Effect::Load {
            mean: mean as f32,
            difference: difference as f32,
            quadratic: quadratic as f32,
            stribeck: 0.0,
            velocity: smoothing_velocity,
            smoothing_velocity,
        }
    }

    fn position_friction(&mut self, shape: &[f64], c: &[f64], smoothing_velocity: f32) -> Effect {
        self.read(Quantity::Position);
        let (low, high) = (shape[1], shape[2]);
        let series = CosineSeries { low, high, coefficients: c.to_vec() };
        let first_cell = self.first_cell + self.cells.len() as u16;
        let layout = UniformShape { first_cell, cells: POSITION_CELLS, low: low as f32, high: high as f32 };
        let compiled = compile_layout(&series, Table::Uniform(Uniform::new(layout)));
        self.cells.extend(compiled.cells);
        Effect::PositionTable { kind: Kind::Friction, smoothing_velocity, table: compiled.table }
    }

    /// Reads the position for what goes by a way, where it is recorded; by the velocity otherwise.
    fn read_way(&mut self, context: &Context) {
        if context.may_read_position {
            self.read(Quantity::Position);
        }
    }

    /// The lines of the ripple of a kind that there is.
    fn ripple(&mut self, of: Kind) -> Option<&mut heapless::Vec<Harmonic, MAX_HARMONICS>> {
        self.effects.iter_mut().find_map(|effect| match effect {
            Effect::Ripple { kind, harmonics, .. } if *kind == of && harmonics.len() < MAX_HARMONICS => Some(harmonics),
            _ => None,
        })
    }

    /// Whether a ripple of a kind has room for `more` lines.
    fn has_room(&mut self, kind: Kind, more: usize) -> bool {
        self.ripple(kind).is_some_and(|lines| lines.len() + more <= MAX_HARMONICS)
    }

    fn read(&mut self, quantity: Quantity) {
        if !self.inputs.contains(&quantity) && !self.channels.contains(&quantity) {
            self.channels.push(quantity);
        }
    }
}

/// The Maxwell slip elements of presliding: one a torque, the distance of each four times that of the one before. Those that hold no torque
/// are left out.
fn elements(first: f64, torques: &[f64]) -> Result<heapless::Vec<Element, MAX_ELEMENTS>, &'static str> {
    if torques.iter().any(|torque| *torque < 0.0) {
        return Err("an element that pushes is not dissipative");
    }
    let distances = std::iter::successors(Some(first), |distance| Some(DISTANCE_RATIO * distance));
    let mut elements = heapless::Vec::new();
    for (torque, distance) in torques.iter().zip(distances).filter(|(torque, _)| **torque > 0.0) {
        let element = Element { torque: *torque as f32, distance: distance as f32 };
        elements.push(element).map_err(|_| "presliding has more elements than an image holds")?;
    }
    if elements.is_empty() { Err("presliding without a torque is none") } else { Ok(elements) }
}

#[cfg(test)]
mod tests;

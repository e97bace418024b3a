//! A friction model: inputs with their trained ranges, the law, the correction terms, and the pool of coefficients.

use serde::{Deserialize, Serialize};

use crate::effect::{Effect, MAX_EFFECTS};
use crate::expression::Program;
pub use crate::input::{Input, MAX_INPUTS};
use crate::integer_table::IntegerTable;
use crate::network::Network;
use crate::pool::Pool;
use crate::table::{Geometric, Table, Uniform};
use crate::units::{Quantity, Unit};

/// Longest joint name, in bytes.
pub const JOINT_NAME_BYTES: usize = 32;

/// Longest trainer version, in bytes.
pub const VERSION_BYTES: usize = 24;

/// The rigid-body part of the actuator torque, as it stood when the model was made:
/// `inertia a + gravity_sin sin q + gravity_cos cos q + offset + given_scale * given`, where `given` is a rigid-body torque
/// that the recording or the controller brings along. In the unit of the model's output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidBody {
    /// Inertia, kg m^2 (mass in kg of a linear axis; in output units per acceleration otherwise).
    pub inertia: f32,
    /// Gravity torque with the sine of the position.
    pub gravity_sin: f32,
    /// Gravity torque with the cosine of the position.
    pub gravity_cos: f32,
    /// Constant torque.
    pub offset: f32,
    /// Factor on a given rigid-body torque.
    pub given_scale: f32,
}

impl Default for RigidBody {
    /// Nothing but a given rigid-body torque, as it is.
    fn default() -> Self {
        Self { inertia: 0.0, gravity_sin: 0.0, gravity_cos: 0.0, offset: 0.0, given_scale: 1.0 }
    }
}

/// The static friction law.
///
/// The variants differ in size on purpose: a drive has no heap to box the large ones in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant)]
#[repr(u8)]
pub enum Law {
    /// A function of the only input in cells that grow with the distance from zero: the usual one.
    Geometric(Geometric),
    /// A function of the only input in equal cells.
    Uniform(Uniform),
    /// Several inputs through layers of tables.
    Network(Network),
    /// A formula.
    Expression(Program),
    /// A function of the only input, in integers, for targets without a floating-point unit.
    IntegerTable(IntegerTable),
}

impl From<Table> for Law {
    fn from(table: Table) -> Self {
        match table {
            Table::Geometric(layout) => Self::Geometric(layout),
            Table::Uniform(layout) => Self::Uniform(layout),
        }
    }
}

/// Where a model comes from.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Provenance {
    /// Name of the joint.
    pub joint: heapless::String<JOINT_NAME_BYTES>,
    /// Version of the trainer.
    pub trainer_version: heapless::String<VERSION_BYTES>,
    /// Hash of the recordings, as the trainer defines it.
    pub recordings_hash: u64,
    /// Seed of the training.
    pub seed: u64,
    /// What the law gets wrong of the recordings.
    pub law_error: LawError,
    /// What the recordings leave open of the rigid body.
    pub rigid_body_error: RigidBodyError,
}

/// What a law gets wrong of the recordings that it was fitted to, beside their noise: root mean squares in the unit of the output,
/// finite and at least 0; 0 where it was not determined.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct LawError {
    /// Up to [`SLOW_SHARE`] of [`Model::top_speed`].
    pub slow: f32,
    /// Above it.
    pub sliding: f32,
}

/// Covariance of the constants of a [`RigidBody`] that were identified along with the law, as a factor: 0 for a constant that was given,
/// all 0 where it was not determined.
///
/// Row `k` of the upper triangle, which [`RigidBodyError::row`] returns, is one independent error of all constants at one standard
/// deviation; the covariance is the sum of the products of each row with itself. Finite numbers in the units of the constants.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct RigidBodyError {
    /// The upper triangle by rows, constants in the order of [`RigidBody`].
    pub factor: [f32; RIGID_BODY_CONSTANTS * (RIGID_BODY_CONSTANTS + 1) / 2],
}

/// Constants of a [`RigidBody`].
pub const RIGID_BODY_CONSTANTS: usize = 5;

impl RigidBodyError {
    /// Error of each constant in independent error `k` (below [`RIGID_BODY_CONSTANTS`]), at one standard deviation.
    ///
    /// ```
    /// use frikan_shared::model::RigidBodyError;
    /// let mut error = RigidBodyError::default();
    /// error.factor[4] = 0.1; // given_scale in the first row
    /// error.factor[14] = 0.2; // given_scale by itself
    /// assert_eq!(error.row(0), [0.0, 0.0, 0.0, 0.0, 0.1]);
    /// assert_eq!(error.row(4), [0.0, 0.0, 0.0, 0.0, 0.2]);
    /// ```
    #[must_use]
    pub fn row(&self, k: usize) -> [f32; RIGID_BODY_CONSTANTS] {
        let mut row = [0.0; RIGID_BODY_CONSTANTS];
        let begin: usize = (0..k).map(|before| RIGID_BODY_CONSTANTS.saturating_sub(before)).sum();
        let own = self.factor.get(begin..).unwrap_or_default();
        row.iter_mut().skip(k).zip(own).for_each(|(constant, error)| *constant = *error);
        row
    }
}

/// Share of the top speed up to which friction may be that of break-away.
pub const SLOW_SHARE: f64 = 0.1;

/// A friction model with room for `CELLS` cells.
///
/// [`crate::validate`] says what a model has to satisfy; every decoded model does. Law and cells come first in memory, so that the
/// short offsets of a load reach them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[repr(C)]
pub struct Model<const CELLS: usize> {
    /// The static law.
    pub law: Law,
    /// Coefficients into which all tables index.
    pub cells: Pool<CELLS>,
    /// Input channels in the order in which the law counts them.
    pub inputs: heapless::Vec<Input, MAX_INPUTS>,
    /// Unit of the output.
    pub output_unit: Unit,
    /// Largest magnitude that the model ever puts out, positive and finite, in the unit of the output.
    pub output_limit: f32,
    /// Rigid-body parameters in force.
    pub rigid_body: RigidBody,
    /// Correction terms, added in their order.
    pub effects: heapless::Vec<Effect, MAX_EFFECTS>,
}

impl<const CELLS: usize> Model<CELLS> {
    /// Largest speed within the range of the velocity, in its unit; `None` where the model does not read it.
    #[must_use]
    pub fn top_speed(&self) -> Option<f32> {
        let velocity = self.inputs.iter().find(|input| input.quantity == Quantity::Velocity)?;
        Some(velocity.low.abs().max(velocity.high.abs()))
    }
}

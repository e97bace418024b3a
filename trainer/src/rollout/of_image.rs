//! A recording as an image and what is known of the actuator let it happen.

use frikan_shared::model::RigidBody;

use super::body::{Body, payload};
use super::image::ImageFriction;
use super::score::{Errors, Score};
use super::series::Series;
use super::simulate::{Recorded, Rig, State, recorded, simulate, starts};
use crate::actuator::{Kind, Open, Partial};
use crate::compile::host_model::HostModel;
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::recording::{Quantity, Recording};

/// After this time a joint under a recorded torque, current, duty or voltage is put back where it was recorded, s: nothing holds it there, and
/// after a while any error of the torque is a large one of the position.
const OPEN_LOOP_WINDOW_S: f64 = 0.5;

/// A simulated recording.
#[derive(Clone, Debug)]
pub struct Rollout {
    /// Simulated states, one a row.
    pub simulated: Vec<State>,
    /// Recorded ones.
    pub recorded: Vec<State>,
    /// How far they differ.
    pub score: Score,
}

/// After which time the simulation is put back to the recorded state, s: never where a position is commanded.
#[must_use]
pub fn default_window_s(kind: Kind) -> Option<f64> {
    (!kind.follows_position()).then_some(OPEN_LOOP_WINDOW_S)
}

/// Rows that are simulated at a time at least where only the score is asked for: some 100 B each.
const ROWS_AT_A_TIME: usize = 1 << 17;

/// Simulates a recording with the friction and rigid body of an image, and with actuator and payload of `joint`.
///
/// # Errors
/// `FRK-D009` for a column that is missing, `FRK-D014` for a constant, `FRK-N004` where the simulation diverges.
pub fn of_image(model: &HostModel, recording: &Recording, joint: &Joint, window_s: Option<f64>) -> Result<Rollout> {
    let in_file = |error: Error| error.in_file(recording.file());
    let (rig, mut friction) = rigged(model, recording, joint)?;
    let series = Series::of(recording, &rig.actuator)?;
    let simulated = simulate(&rig, &series, &mut friction, &starts(recording, window_s)?).map_err(in_file)?;
    let recorded = recorded(recording)?;
    Ok(Rollout { score: Score::of(&simulated, &recorded), simulated, recorded })
}

/// The score of [`of_image`] alone, in the memory of some rows.
///
/// # Errors
/// As [`of_image`].
pub fn score_of_image(model: &HostModel, recording: &Recording, joint: &Joint, window_s: Option<f64>) -> Result<Score> {
    let in_file = |error: Error| error.in_file(recording.file());
    let (rig, mut friction) = rigged(model, recording, joint)?;
    let (starts, recorded) = (starts(recording, window_s)?, Recorded::of(recording)?);
    let time = recording.values(Quantity::Time).unwrap_or_default();
    let mut errors = Errors::of_rows(recording.len());
    // The firmware's limit of the reference has a memory of its own that goes on from start to start.
    let at_least = if rig.actuator.kind.follows_position() { recording.len() } else { ROWS_AT_A_TIME };
    let mut left = &starts[..];
    while let Some((begin, _)) = left.first().copied() {
        let (own, later) = left.split_at(left.partition_point(|(row, _)| *row < begin + at_least));
        let end = later.first().map_or(recording.len(), |(row, _)| *row);
        left = later;
        // Back to the command that acts at the first row.
        let since = time[begin] - rig.actuator.delay_s;
        let first = time.partition_point(|time| *time <= since).saturating_sub(1).min(begin);
        let series = Series::of_rows(recording, &rig.actuator, &(first..end))?;
        let own: Vec<(usize, State)> = own.iter().map(|(row, state)| (row - first, *state)).collect();
        let simulated = simulate(&rig, &series, &mut friction, &own).map_err(in_file)?;
        (begin..end).zip(&simulated).for_each(|(row, simulated)| errors.add(simulated, &recorded.at(row)));
    }
    Ok(errors.score())
}

/// Actuator and body of a recording's joint, and its friction.
fn rigged<'m>(model: &'m HostModel, recording: &Recording, joint: &Joint) -> Result<(Rig, ImageFriction<'m>)> {
    let in_file = |error: Error| error.in_file(recording.file());
    let joint = joint.in_recording(&recording.label);
    let partial = Partial::of(joint.actuator.kind, &joint.actuator.constants);
    let has_kp = recording.channel(Quantity::Kp).is_some();
    if let Some(open) = partial.open.iter().find(|open| !(has_kp && **open == Open::Kp)) {
        let message = "a simulation needs this constant of the actuator; `trainer fit` identifies it and writes it beside its image";
        let key = format!("actuator.{}", open.constant(partial.actuator.kind).key());
        return Err(Error::new(&codes::MISSING_PARAMETER, message).in_column(key));
    }
    let body =
        Body::of(&with_given(&model.rigid_body, &joint), payload(recording, &joint).as_ref()).map_err(in_file)?;
    Ok((Rig { actuator: partial.actuator, body }, ImageFriction::new(model).map_err(in_file)?))
}

/// The rigid body of an image; that of joint.toml where the image, of friction alone, has none.
fn with_given(body: &RigidBody, joint: &Joint) -> RigidBody {
    let given = &joint.rigid_body;
    if *body != RigidBody::default() {
        return *body;
    }
    let (gravity, phase) = (given.gravity_torque_nm.unwrap_or(0.0), given.gravity_phase_rad.unwrap_or(0.0));
    RigidBody {
        inertia: given.inertia_kgm2.unwrap_or(0.0) as f32,
        gravity_sin: (gravity * libm::cos(phase)) as f32,
        gravity_cos: (gravity * libm::sin(phase)) as f32,
        ..*body
    }
}

//! A recording of commands as one of a torque, once the actuator is known.

use super::commanded::Commanded;
use super::identified::Identified;
use crate::error::Result;
use crate::fit::Outcome;
use crate::fit::model::{from_bytes, to_bytes};
use crate::joint::Joint;
use crate::recording::{Quantity, Recording};
use crate::rollout::Body;
use crate::samples::prepare_every_row;

/// Inertia of the payload of the first recording, kg m2, which the others are brought to.
pub(super) fn reference_inertia(recordings: &[Recording], joint: &Joint) -> f64 {
    let payload = |recording: &Recording| {
        crate::rollout::payload(recording, &joint.in_recording(&recording.label))
            .map(|payload| Body::of_payload(&payload))
    };
    recordings.first().and_then(payload).map_or(0.0, |body| body.inertia)
}

/// What stands as the load of the gear beside a torque that follows from commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Load {
    /// Nothing: for a law that is looked for in the torque and its motion.
    None,
    /// All of the torque: for a law that is known. One that is looked for would explain the torque by itself.
    OfActuator,
    /// What the payload takes, which follows from the motion alone.
    OfPayload,
}

/// The recording under the torque that its actuator made, less the gravity of its payload and what the inertia of that differs by from
/// `reference`, kg m2, with a load of the gear beside it.
///
/// # Errors
/// As `identify`.
pub(crate) fn known_torque(
    recording: &Recording,
    joint: &Joint,
    identified: &Identified,
    reference: f64,
    load: Load,
) -> Result<Recording> {
    let commanded = Commanded::of(recording, joint)?;
    let actuator = identified.complete(&commanded.partial).actuator;
    let applied = commanded.applied(&actuator);
    let bare = recording.clone().with_torque(vec![0.0; recording.len()], Vec::new());
    let motion = prepare_every_row(&bare, &identified.preparation)?;
    let (velocity, acceleration) = (motion.require_velocity()?, motion.acceleration.as_deref().unwrap_or_default());
    let position = recording.values(Quantity::Position).unwrap_or_default();
    let payload = commanded.payload.as_ref().map_or_else(Body::default, Body::of_payload);
    let excess = payload.inertia - reference;
    let carried = |row: usize| payload.gravity(position[row]) + excess * acceleration.get(row).copied().unwrap_or(0.0);
    let whole: Vec<f64> = match load {
        // A diagnosis filters torque and motion alike: what was filtered before it would lag behind the motion's own.
        Load::OfPayload => {
            let time = recording.values(Quantity::Time).unwrap_or_default();
            (0..recording.len()).map(|row| applied[row].at(difference(time, position, row))).collect()
        }
        Load::None | Load::OfActuator => (0..recording.len()).map(|row| applied[row].at(velocity[row])).collect(),
    };
    // What a controller that sees the motion late takes of the inertia.
    let late = |row: usize| applied[row].inertia * acceleration.get(row).copied().unwrap_or(0.0);
    let whole: Vec<f64> = whole.iter().enumerate().map(|(row, torque)| torque - late(row)).collect();
    let torque = whole.iter().enumerate().map(|(row, torque)| torque - carried(row)).collect();
    let is_diagnosed = load != Load::None;
    let load = match load {
        Load::None => None,
        Load::OfActuator => Some(whole),
        Load::OfPayload => commanded.payload.is_some().then(|| (0..recording.len()).map(carried).collect()),
    };
    let others = load.map(|load| (Quantity::LoadTorque.name().to_owned(), load)).into_iter().collect();
    let known = recording.clone().with_torque(torque, others);
    // An effect may go with the motion of another joint.
    Ok(if is_diagnosed { known.beside_unnamed_of(recording) } else { known })
}

/// Velocity at a row by the rows beside it, rad/s.
fn difference(time: &[f64], position: &[f64], row: usize) -> f64 {
    let (before, after) = (row.saturating_sub(1), (row + 1).min(position.len().saturating_sub(1)));
    let span = time[after] - time[before];
    if span > 0.0 { (position[after] - position[before]) / span } else { 0.0 }
}

/// A fit of such recordings as one of the joint without payload: its inertia is less by `reference`, kg m2, and what was identified of the
/// actuator stands before its other parameters.
///
/// # Errors
/// `FRK-D020` where the image would be refused.
pub(super) fn without_payload(mut outcome: Outcome, identified: &Identified, reference: f64) -> Result<Outcome> {
    let mut image = from_bytes(&outcome.image)?;
    image.model.rigid_body.inertia = (f64::from(image.model.rigid_body.inertia) - reference) as f32;
    outcome.image = to_bytes(&image)?;
    for parameter in outcome.parameters.iter_mut().filter(|parameter| parameter.name == "inertia") {
        parameter.value -= reference;
        parameter.ci95 = parameter.ci95.map(|bound| bound - reference);
    }
    outcome.parameters.splice(0..0, identified.parameters.iter().cloned());
    outcome.remarks.extend(identified.remarks.iter().cloned());
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::super::torque_space::as_given;
    use super::*;
    use crate::recording::parse;

    #[test]
    fn motions_of_other_joints_stay_for_a_diagnosis() {
        let pd = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 20\nkd_Nms_rad = 1\n";
        let joint = Joint::parse(pd).unwrap();
        let rows: String = (0..400)
            .map(|i| {
                let time = 0.01 * f64::from(i);
                format!("{time},{},{},{}\n", (3.0 * time).sin(), (3.0 * time).sin() + 0.1, (2.0 * time).cos())
            })
            .collect();
        let text = format!("time_s,position_rad,reference_position_rad,joint2_position_rad\n{rows}");
        let recording = parse("a.csv", text.as_bytes(), &joint).unwrap();
        let given = as_given(&recording, &joint).unwrap();
        let known = |load| known_torque(&recording, &joint, &given, 0.0, load).unwrap();
        assert!(known(Load::OfPayload).named("joint2_position_rad").is_some());
        assert!(known(Load::OfActuator).named("joint2_position_rad").is_some());
        assert!(known(Load::None).named("joint2_position_rad").is_none());
    }
}

//! The law that `trainer fit` finds in the very recording, as the model that a diagnosis starts from: whatever the law could
//! swallow of a hidden effect, it has swallowed.

use std::fmt::Write;

use frikan_trainer::diagnose::{Signals, model};
use frikan_trainer::fit::model::from_bytes;
use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::fit::{Options, fit};
use frikan_trainer::joint::Joint;
use frikan_trainer::recording;

/// Fits a law to the signals (a rigid-body torque given, N m and rad) and makes it what they are compared with.
///
/// # Errors
/// What keeps the recording from being fitted.
pub fn compare_with_own_law(signals: &mut Signals, seed: u64) -> Result<(), String> {
    let rigid_body = signals.rigid_body.as_ref().ok_or("no rigid-body torque is given")?;
    let mut csv = String::from("time_s,position_rad,torque_Nm,rigid_body_torque_Nm\n");
    for (i, body) in rigid_body.iter().enumerate() {
        let _ = writeln!(csv, "{},{},{},{body}", signals.time[i], signals.position[i], signals.torque[i]);
    }
    let joint = Joint::default();
    let recording = recording::parse("recording", csv.as_bytes(), &joint).map_err(|e| e.to_string())?;
    let options = Options { seed, representation: Some(Representation::Expression), ..Options::default() };
    let outcome = fit(&[recording], &[], &joint, &options, &|_| ()).map_err(|e| e.to_string())?;
    let image = from_bytes(&outcome.image).map_err(|e| e.to_string())?;
    let state = signals.states();
    let reference = model::at(&image.model, &state, state.rigid_body.as_deref()).map_err(|e| e.to_string())?;
    signals.compare_with(reference);
    Ok(())
}

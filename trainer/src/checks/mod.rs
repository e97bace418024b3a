//! Checks before anything is fitted or diagnosed: what is wrong with a recording as a measurement, and the recording as it is
//! safe to use. Knows recordings, filters and least squares; no model, no sentences.
//!
//! [`review`] is for what learns from the torque, [`review_motion`] for what only needs the motion. A recording without a fault
//! comes back as it was, bit for bit.

mod clock;
mod direction;
mod frozen;
mod held;
mod law;
mod measured;
mod motion;
mod note;
mod repeated;
mod rezeroed;
mod sign;
mod steps;
#[cfg(test)]
mod tests;
mod turned;
mod unit;
mod velocity;
mod wrapped;

pub use note::{Contradiction, Fault, Note, WrongUnit};

use crate::error::Result;
use crate::joint::Joint;
use crate::recording::Recording;

/// A recording as it is safe to use.
#[derive(Clone, Debug)]
pub struct Reviewed {
    /// Positions unwrapped, rows that say nothing left out, the motion interrupted where it has to be.
    pub recording: Recording,
    /// What was found, in the order of the checks; blocking faults are not mended.
    pub notes: Vec<Note>,
}

/// Every check.
///
/// # Errors
/// `FRK-D023` where torque, force or current was not measured, `FRK-D011` and `FRK-D026` where the clock is none.
pub fn review(recording: Recording, joint: &Joint) -> Result<Reviewed> {
    measured::require(&recording)?;
    let nearly = recording.nearly_named.iter().cloned();
    let nearly: Vec<Note> = nearly.map(|(column, known)| Note::of_all(Fault::NearlyNamed { column, known })).collect();
    let mut reviewed = review_motion(recording, joint)?;
    reviewed.notes.extend(nearly);
    reviewed.note(unit::position_in_degrees);
    // What else is compared with a law would only repeat that the units are wrong.
    if !reviewed.is_blocked() {
        reviewed.mend(frozen::without_frozen_torque);
        reviewed.mend(turned::without_turned_torque);
        reviewed.note(|recording| sign::wrong_sign(recording, joint));
    }
    reviewed.note(direction::one_direction);
    Ok(reviewed)
}

/// The checks of clock and motion.
///
/// # Errors
/// `FRK-D011` and `FRK-D026` where the clock is none.
pub fn review_motion(recording: Recording, joint: &Joint) -> Result<Reviewed> {
    let mut reviewed = Reviewed { recording, notes: Vec::new() };
    reviewed.mend(repeated::without_repeated_stamps);
    clock::require(&reviewed.recording)?;
    reviewed.mend(held::at_true_rate);
    reviewed.mend(repeated::without_repeated_rows);
    reviewed.mend(|recording| wrapped::unwrapped(recording, joint));
    reviewed.mend(rezeroed::put_back);
    reviewed.mend(velocity::without_contradiction);
    Ok(reviewed)
}

impl Reviewed {
    /// The first fault that nothing can be fitted beside.
    #[must_use]
    pub fn blocking(&self) -> Option<&Note> {
        self.notes.iter().find(|note| note.fault.is_blocking())
    }

    fn is_blocked(&self) -> bool {
        self.blocking().is_some()
    }

    /// A check that puts the recording right where it finds something.
    fn mend(&mut self, check: impl Fn(&Recording) -> Option<(Option<Recording>, Note)>) {
        if let Some((mended, note)) = check(&self.recording) {
            if let Some(mended) = mended {
                self.recording = mended;
            }
            self.notes.push(note);
        }
    }

    /// A check that only says.
    fn note(&mut self, check: impl Fn(&Recording) -> Option<Note>) {
        self.notes.extend(check(&self.recording));
    }
}

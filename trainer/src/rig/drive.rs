//! The drive under test: the same code on the host and on an emulated microcontroller.

use frikan_runtime::compensator::{Compensator, Limits};
use frikan_runtime::drive::{DriveInput, DriveSettings, JointDrive, OUTPUT_WORDS};
use frikan_runtime::shared::image::decode;
use frikan_runtime::shared::model::Model;
use frikan_runtime::supervised::SupervisionError;
use frikan_runtime::supervised::adaptation::Correction;

use crate::emulator::Lockstep;
use crate::error::Result;

/// What a drive answers to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Torque of the motor, N m.
    pub torque: f32,
    /// Velocity behind the encoder's filter, rad/s.
    pub velocity: f32,
    /// What of the torque compensates friction, N m.
    pub compensation: f32,
    /// Share of the gain that the monitor leaves, 0 to 1.
    pub gain_share: f32,
    /// How the friction differs from the model, as far as the drive has learnt it.
    pub correction: Correction,
    /// 0 active, 1 no model, 2 not finite, 3 implausible, 4 degraded.
    pub status: u32,
}

impl Answer {
    fn from_words(words: [u32; OUTPUT_WORDS]) -> Self {
        let [numbers @ .., status] = words;
        let [torque, velocity, compensation, gain_share, level, viscous, offset] = numbers.map(f32::from_bits);
        let correction = Correction { level, viscous, offset };
        Self { torque, velocity, compensation, gain_share, correction, status }
    }
}

/// A drive that answers samples one by one.
pub trait DriveUnderTest {
    /// The answer to a sample.
    ///
    /// # Errors
    /// Where the drive does not answer: never on the host.
    fn answer(&mut self, input: &DriveInput) -> Result<Answer>;

    /// Goes on with another image from the next sample on; without compensation where it is none.
    ///
    /// # Errors
    /// As [`DriveUnderTest::answer`], and where the image does not fit.
    fn replace_image(&mut self, image: &[u8]) -> Result<()>;
}

impl<const CELLS: usize> DriveUnderTest for JointDrive<CELLS> {
    fn answer(&mut self, input: &DriveInput) -> Result<Answer> {
        Ok(Answer::from_words(self.step(input).to_words()))
    }

    fn replace_image(&mut self, image: &[u8]) -> Result<()> {
        self.compensator().replace_model(decode(image).map(|image| image.model));
        Ok(())
    }
}

impl DriveUnderTest for Lockstep {
    fn answer(&mut self, input: &DriveInput) -> Result<Answer> {
        self.sample(&input.to_words()).map(Answer::from_words)
    }

    fn replace_image(&mut self, image: &[u8]) -> Result<()> {
        Self::replace_image(self, image)
    }
}

/// The drive with `model` on the host.
///
/// # Errors
/// [`SupervisionError`] where a setting of the supervision is out of range.
pub fn host_drive<const CELLS: usize>(
    model: Model<CELLS>,
    settings: &DriveSettings,
) -> std::result::Result<JointDrive<CELLS>, SupervisionError> {
    JointDrive::new(settings, Compensator::with_model(Ok(model), Limits::OFF))
}

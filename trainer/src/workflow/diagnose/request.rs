//! What a diagnosis is asked for.

use frikan_shared::image::Image;
use frikan_shared::units::Quantity;

use crate::compile::profile::Profile;
pub use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::preparation::rows::Lock;
use crate::fit::CELLS;
use crate::workflow::source::Source;

/// What a diagnosis is asked for.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// Recordings of the real joint, one behind the other; at least one.
    pub recordings: Vec<Source<'a>>,
    /// What they are compared with.
    pub against: Against<'a>,
    /// What is locked away for the proof.
    pub lock: Lock,
    /// Drive that has to have room for the improved image; the smallest documented one where `None`.
    pub target: Option<Profile>,
    /// Smallest effect worth acting on, as a share (0..1) of the torque beside the rigid body; the default where `None`.
    pub least_effect: Option<f64>,
    /// Whether sets of effects are weighed by one likelihood.
    pub by_likelihood: bool,
    /// Seed of the null draws.
    pub seed: u64,
    /// Memory to stay within, MB; 1000 where `None`. Of recordings that need more, stretches spread over them are read, and less is searched.
    pub memory_mb: Option<u32>,
}

/// What a recording is compared with.
#[derive(Clone, Debug)]
pub enum Against<'a> {
    /// A simulation of the same commanded motion.
    Simulation(Source<'a>),
    /// A fitted model.
    Model(Box<Image<CELLS>>),
    /// A static model of the recording itself.
    Itself(BaseKind),
}

impl Against<'_> {
    /// Whether it is a law that reads the load of the gear.
    pub(super) fn reads_load(&self) -> bool {
        matches!(self, Self::Model(image) if image.model.inputs.iter().any(|input| input.quantity == Quantity::Load))
    }
}

impl<'a> Request<'a> {
    /// The usual request: a fifth of every block locked away, the smallest documented drive, seed 0.
    #[must_use]
    pub fn of(recordings: &[Source<'a>], against: Against<'a>) -> Self {
        Self {
            recordings: recordings.to_vec(),
            against,
            lock: Lock::Spread,
            target: None,
            least_effect: None,
            by_likelihood: false,
            seed: 0,
            memory_mb: None,
        }
    }
}

/// What a page of a diagnosis tells beside it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Told<'a> {
    /// Sentences on the improved image.
    pub remarks: &'a [String],
    /// The command that puts a simulator right with the image, where one is written.
    pub put_right: Option<&'a str>,
    /// What made the page, for its foot.
    pub command: &'a str,
}

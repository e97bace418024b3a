//! What a caller may ask of a fit, and what a fit tells while it works.

use super::outcome::Representation;
use crate::compile::profile::Profile;
use crate::kan::{Architecture, FitOptions, Smoothing, Sparsity};
use crate::law::KnownForm;

/// Settings of a fit.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// One seed, one image.
    pub seed: u64,
    /// Inputs by name, velocity included; chosen by relevance when absent.
    pub inputs: Option<Vec<String>>,
    /// Form of the law in the image; the better one when absent.
    pub representation: Option<Representation>,
    /// The law of the literature that is fitted, over velocity; the one that the samples ask for when absent.
    pub form: Option<KnownForm>,
    /// Rate of the samples, Hz; follows the filter when absent.
    pub rate_hz: Option<f64>,
    /// What the law may cost on the drive.
    pub budget: Budget,
    /// Whether the image holds a table of integers, for a drive without floating-point unit.
    pub integers: bool,
    /// How the network is trained.
    pub training: Training,
    /// Memory to stay within, MB; 1000 when absent. Of recordings that need more, stretches spread over them are read.
    pub memory_mb: Option<u32>,
}

/// How the network is trained; what is absent is as [`FitOptions::new`] has it.
#[derive(Clone, Debug, Default)]
pub struct Training {
    /// Shape of the network, with as many inputs as are used; five nodes, beside two products where there are several inputs,
    /// when absent.
    pub network: Option<Architecture>,
    /// Independent starts, of which the best on held-out blocks is kept.
    pub restarts: Option<usize>,
    /// Most steps of one start.
    pub steps: Option<usize>,
    /// How often the cells of the network are halved at most.
    pub refinements: Option<usize>,
    /// Penalty on superfluous edges.
    pub sparsity: Option<Sparsity>,
}

impl Training {
    /// The settings of a network of so many inputs.
    pub(super) fn options(&self, inputs: usize, seed: u64) -> FitOptions {
        let text = if inputs == 1 { "[1,5,1]".to_owned() } else { format!("[{inputs},[5,2],1]") };
        // The text is one of those above, which all parse.
        let usual = || text.parse().unwrap_or_else(|_| Architecture::additive(inputs, &[5]));
        let plain = FitOptions::new(self.network.clone().unwrap_or_else(usual));
        FitOptions {
            seed,
            smoothing: Smoothing::Estimated,
            restarts: self.restarts.unwrap_or(plain.restarts),
            steps: self.steps.unwrap_or(plain.steps),
            refinements: self.refinements.unwrap_or(plain.refinements),
            sparsity: self.sparsity.unwrap_or(plain.sparsity),
            ..plain
        }
    }
}

/// Bytes of an image beside the cells of a table, at most, and of a cell.
const IMAGE_BYTES: usize = 96;
const CELL_BYTES: usize = 16;

/// What the law may cost on the drive.
#[derive(Clone, Debug, Default)]
pub struct Budget {
    /// Bytes of the image, provenance not counted.
    pub bytes: Option<usize>,
    /// Instructions of one evaluation on a Cortex-M4F.
    pub instructions: Option<u32>,
    /// The drive that has to have room for the model.
    pub target: Profile,
}

impl Budget {
    /// Cells that a table may have.
    pub(super) fn cells(&self) -> usize {
        let affordable = self.bytes.map_or(usize::MAX, |most| most.saturating_sub(IMAGE_BYTES) / CELL_BYTES);
        affordable.min(self.target.cells)
    }
}

/// What a fit is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Filtering, and taking the rigid body off.
    Separating,
    /// Training the network.
    Training,
    /// Pruning the network.
    Pruning,
    /// Looking for the formula.
    Searching,
    /// Fitting the classical laws.
    Comparing,
    /// Refitting on all samples and compiling the image.
    Compiling,
    /// Scoring the exported image.
    Scoring,
    /// Identifying the actuator of a joint that reports no torque, from its commands.
    Identifying,
    /// Simulating such a joint with its image.
    Simulating,
    /// Fitting constants of actuator, law and rigid body to the recorded motion of such a joint.
    FittingMotion,
}

impl Stage {
    /// As a line of progress says it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Separating => "separating friction",
            Self::Training => "training the network",
            Self::Pruning => "pruning the network",
            Self::Searching => "looking for the formula",
            Self::Comparing => "fitting classical laws",
            Self::Compiling => "compiling the image",
            Self::Scoring => "scoring the image",
            Self::Identifying => "identifying the actuator",
            Self::Simulating => "simulating the joint with the image",
            Self::FittingMotion => "fitting actuator, law and body to the motion",
        }
    }
}

/// A sign of life.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Steps done of this stage, where they are counted.
    pub steps: usize,
    /// Root mean square error at this point, where there is one.
    pub rmse: Option<f64>,
}

/// Called from worker threads.
pub type ProgressCallback<'a> = &'a (dyn Fn(&Progress) + Sync);

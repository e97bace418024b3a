//! What a fit brings back: everything that a terminal, a JSON file and a report show of it. Plain data.

use super::agreement::Agreement;
use super::integer_summary::IntegerSummary;
use crate::kan::{GraphSummary, Removed, Step};
use crate::parameter::Parameter;
use crate::recording::Axis;
use crate::samples::relevance::Relevance;
use frikan_runtime::supervised::DEFAULT_GAIN;

/// Points of a drawn curve.
pub(super) const CURVE_POINTS: usize = 241;
/// Most points of a picture.
pub(crate) const CLOUD_POINTS: usize = 4000;

/// The form in which a law goes into the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Representation {
    /// Tables of cubic pieces, made from the network.
    Table,
    /// A formula.
    Expression,
}

/// A law that may go into the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Coulomb and viscous friction, with every sign as physics has it.
    Simple,
    /// The same as the data have it, where a sign is wrong.
    SimpleAsFitted,
    /// The formula that was found.
    Found,
    /// The network, as tables.
    Network,
}

impl Form {
    /// All of them, in the order in which each has to beat the one before.
    pub const ALL: [Self; 4] = [Self::Simple, Self::SimpleAsFitted, Self::Found, Self::Network];

    /// Its place among all of them.
    pub(super) fn place(self) -> usize {
        self as usize
    }

    /// How an image holds it.
    #[must_use]
    pub fn representation(self) -> Representation {
        if self == Self::Network { Representation::Table } else { Representation::Expression }
    }

    /// Name in reports and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "Coulomb and viscous",
            Self::SimpleAsFitted => "Coulomb and viscous, signs as fitted",
            Self::Found => "the formula found",
            Self::Network => "the table of the network",
        }
    }
}

impl Representation {
    /// Name in JSON: `table` or `expression`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Expression => "expression",
        }
    }
}

/// A finished fit. Torques are in `unit`, all else in SI.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the joint; empty where none was given.
    pub joint: String,
    /// Rotary or linear.
    pub axis: Axis,
    /// Unit of actuator, rigid body and friction as printed: `N m`, `N` or `A`.
    pub unit: &'static str,
    /// Seed of the training.
    pub seed: u64,
    /// Filter and origin of the velocity, one sentence.
    pub filter: String,
    /// Inputs of the model in its order, velocity first.
    pub inputs: Vec<InputRange>,
    /// Relevance of every input that was offered, strongest first.
    pub relevance: Vec<Relevance>,
    /// The network and how it came about.
    pub network: NetworkSummary,
    /// The formula that was found.
    pub law: LawSummary,
    /// Classical friction laws fitted to the same samples, rigid body identified along with each.
    pub classical: Vec<ClassicalLaw>,
    /// Constants of the formula, then those of the rigid body as it is in the image.
    pub parameters: Vec<Parameter>,
    /// What was compared for the image; exactly one is chosen.
    pub candidates: Vec<Candidate>,
    /// Form of the law in the image.
    pub representation: Representation,
    /// Whether the candidates were compared on rows that they had not seen.
    pub held_out: bool,
    /// Why this form was chosen, one sentence.
    pub choice: String,
    /// The table of integers that the image holds in place of that form, where the drive calculates in integers.
    pub integers: Option<IntegerSummary>,
    /// What the data do not determine and what else was noticed, in sentences.
    pub remarks: Vec<String>,
    /// Whether every parameter is determined and every optimiser converged.
    pub sound: Soundness,
    /// Recordings that were fitted, as the exported image predicts them.
    pub train: Vec<Trace>,
    /// Score of the exported image over all training recordings together.
    pub train_score: Score,
    /// The same, rows in motion and rows at rest apart.
    pub train_split: SplitScore,
    /// Recordings that were not fitted, as the exported image predicts them.
    pub tests: Vec<Trace>,
    /// Samples of training: velocity and separated friction, at most a few thousand, for a picture over velocity.
    pub cloud: Vec<[f64; 2]>,
    /// The exported friction law over velocity, other inputs at their mean.
    pub law_curve: Vec<[f64; 2]>,
    /// Where the friction lies with 95 % according to the network: velocity, low, high; other inputs at their mean.
    pub band: Vec<[f64; 3]>,
    /// The image, as it is written to the file.
    pub image: Vec<u8>,
}

impl Outcome {
    /// Share of the friction that may be missing by the 95 % band, averaged over the velocities with the friction itself as the weight; 0
    /// to 1.
    #[must_use]
    pub fn uncertain_share(&self) -> f64 {
        uncertain_share(&self.band)
    }

    /// Gain for a supervised compensator: the drive's default, or less where the friction may lie further below the law.
    #[must_use]
    pub fn gain(&self) -> f64 {
        f64::from(DEFAULT_GAIN).min(1.0 - self.uncertain_share())
    }
}

/// As [`Outcome::uncertain_share`].
pub(super) fn uncertain_share(band: &[[f64; 3]]) -> f64 {
    let friction: f64 = band.iter().map(|[_, low, high]| 0.5 * (low + high).abs()).sum();
    let half: f64 = band.iter().map(|[_, low, high]| (0.5 * (low + high).abs()).min(0.5 * (high - low))).sum();
    if friction > 0.0 { half / friction } else { 1.0 }
}

/// Whether a fit may be relied upon; anything but `Sound` ends with exit status 4 and without an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Soundness {
    /// Determined and converged.
    Sound,
    /// Parameters cannot be told apart; which, in a sentence.
    NotIdentifiable(String),
    /// An optimiser ran out of steps; which, in a sentence.
    NotConverged(String),
    /// The law does what no joint can do; what, in a sentence.
    NotPhysical(String),
}

impl Soundness {
    /// This, or what `other` finds where nothing is wrong so far.
    pub(super) fn and(self, other: impl FnOnce() -> Self) -> Self {
        if self == Self::Sound { other() } else { self }
    }
}

/// An input of the model with its trained range.
#[derive(Clone, Debug, PartialEq)]
pub struct InputRange {
    /// Name, such as `velocity`.
    pub name: String,
    /// Unit as printed, such as `rad/s`.
    pub unit: &'static str,
    /// Smallest trained value.
    pub low: f64,
    /// Largest trained value.
    pub high: f64,
}

/// The network, before and after pruning.
#[derive(Clone, Debug)]
pub struct NetworkSummary {
    /// Shape that was trained, such as `[1,5,1]`.
    pub architecture: String,
    /// Nodes and edges with their attribution scores, as trained.
    pub before: GraphSummary,
    /// The same after pruning and refitting.
    pub after: GraphSummary,
    /// What pruning took away, in that order.
    pub removed: Vec<Removed>,
    /// Points of each edge's activation after pruning, in the order of `after.edges`; empty for pruned edges.
    pub activations: Vec<Vec<[f64; 2]>>,
    /// Steps of the training before pruning.
    pub history: Vec<Step>,
    /// The friction curve after a third, two thirds and all of the training: share of the steps, points over velocity.
    pub stages: Vec<(f64, Vec<[f64; 2]>)>,
    /// Root mean square error on training samples, unit of the target.
    pub rmse: f64,
}

/// The formula.
#[derive(Clone, Debug)]
pub struct LawSummary {
    /// As text.
    pub expression: String,
    /// As LaTeX.
    pub latex: String,
    /// Operators, inputs and constants.
    pub nodes: usize,
    /// Root mean square of its residuals on the training samples.
    pub rmse: f64,
    /// Laws that no simpler one equals, by complexity.
    pub front: Vec<FrontLaw>,
    /// Number of structures that were fitted.
    pub explored: usize,
}

/// A law on the front of error against complexity.
#[derive(Clone, Debug)]
pub struct FrontLaw {
    /// As text.
    pub expression: String,
    /// Operators, inputs and constants.
    pub nodes: usize,
    /// Root mean square of the residuals.
    pub rmse: f64,
    /// The same over blocks held out in turn.
    pub held_out_rmse: f64,
}

/// A friction law of the literature fitted to the same samples.
#[derive(Clone, Debug)]
pub struct ClassicalLaw {
    /// Its name.
    pub name: &'static str,
    /// Root mean square of its residuals.
    pub rmse: f64,
    /// Bayesian information criterion; lower is better.
    pub bic: f64,
    /// Constants of the law, then of the rigid body identified along with it.
    pub parameters: Vec<Parameter>,
}

/// One law that could go into the image.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Which.
    pub form: Form,
    /// How an image holds it.
    pub representation: Representation,
    /// One line: cells, or the formula's complexity.
    pub description: String,
    /// Root mean square error on the recorded, unfiltered torque of blocks that it was not fitted to (of all, where nothing can
    /// be held out), evaluated in the arithmetic of the drive.
    pub held_out_rmse: f64,
    /// What no joint can do and it does, in a sentence.
    pub violation: Option<String>,
    /// Size of its image, provenance not counted.
    pub bytes: usize,
    /// Instructions of one evaluation on a Cortex-M4F.
    pub instructions: u32,
    /// Whether the budget allows it.
    pub within_budget: bool,
    /// Whether it is the one in the image.
    pub chosen: bool,
}

/// How well a prediction agrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Number of rows.
    pub n: usize,
    /// Share of the variance that is explained.
    pub r2: f64,
    /// Root mean square error, unit of the actuator.
    pub rmse: f64,
    /// Norm of the residual over norm of the measurement.
    pub relative_error: f64,
}

/// How well a prediction agrees where the joint moves, and where it rests.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SplitScore {
    /// Rows in motion.
    pub moving: Score,
    /// Rows at rest.
    pub rest: RestScore,
}

/// Rows at rest, where friction is any value within break-away.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestScore {
    /// Number of rows.
    pub n: usize,
    /// Share of them, 0 to 1, that friction at break-away could hold; 1 where there is none.
    pub inside_breakaway: f64,
}

/// A recording as the exported image predicts it, one value a row, or of a very long recording at every [`stride`](Self::stride)-th row; scores
/// are of all rows.
#[derive(Clone, Debug)]
pub struct Trace {
    /// File name of the recording.
    pub label: String,
    /// Rows from one that is kept to the next.
    pub stride: usize,
    /// Time, s; row number where the recording has no clock.
    pub time: Vec<f64>,
    /// Velocity as the model sees it.
    pub velocity: Vec<f64>,
    /// Recorded actuator, or recorded friction where it came separated.
    pub measured: Vec<f64>,
    /// What the image predicts of it, rigid body included.
    pub predicted: Vec<f64>,
    /// Recorded actuator less the rigid body in force.
    pub friction: Vec<f64>,
    /// Friction alone, as predicted.
    pub predicted_friction: Vec<f64>,
    /// On the rows as recorded.
    pub score: Score,
    /// The same, rows in motion and rows at rest apart.
    pub split: SplitScore,
    /// After a low-pass, at 100 samples a second: what is left of noise beyond the motion's band does not count.
    pub filtered_score: Score,
    /// What [`score`](Self::score) is made of, and that of moving rows.
    pub(super) agreement: Agreement,
    pub(super) moving: Agreement,
}

#[cfg(test)]
mod tests {
    use super::uncertain_share;

    #[test]
    fn what_may_be_missing_is_weighted_by_the_friction() {
        assert!((uncertain_share(&[[-1.0, -2.2, -1.8], [0.0, -0.2, 0.2], [1.0, 1.8, 2.2]]) - 0.1).abs() < 1e-12);
        assert_eq!(uncertain_share(&[[1.0, -1.0, 1.0]]), 1.0);
        assert_eq!(uncertain_share(&[[1.0, -1.0, 2.0]]), 1.0);
        assert_eq!(uncertain_share(&[]), 1.0);
    }
}

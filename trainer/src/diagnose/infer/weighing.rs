//! Products of the columns of both sides for one noise model, and what a model of some members leaves.

use crate::diagnose::infer::candidates::Candidates;
use crate::diagnose::infer::side::Side;
use crate::diagnose::noise::autoregression::Noise;
use crate::inference::evidence::{Candidate, Model, Variant};
use crate::inference::products::products;
use crate::inference::reduced::{RandomEffects, Reduced};
use crate::inference::replay::{NullEvidence, Replay};
use crate::inference::sets::{Field, Member};
use crate::numerics::least_squares::{dot, fit_residual, orthonormal, project_out, weighted};
use crate::numerics::statistics::root_mean_square;
use nalgebra::{DMatrix, DVector};

/// Nats of a member before noise was replayed: a likelihood ratio of 150, very strong evidence by Kass and Raftery (1995).
pub(crate) const FIRST_PRICE: f64 = 5.0;
/// Candidates beside which the noise is first judged: an effect must not pass for noise.
const MEMBERS_BESIDE_NOISE: usize = 2;
/// Pieces of the residual that are drawn anew, each long beside what colour the noise model leaves.
const REPLAYED_PIECES: usize = 30;
/// Shapes that a simulation shows by itself and both sides share, at most. A limit of the computing time.
const MOST_SHOWN: usize = 10;

/// Products of both sides for one noise model.
pub(crate) struct Weighing {
    /// The recording's alone, base taken off.
    real: Reduced,
    /// The same with random effects integrated out.
    pub reduced: Reduced,
    /// Products over the rows of both sides, with the random effects that act there.
    both: Option<(Reduced, RandomEffects)>,
    /// Shapes that the simulation shows by itself.
    pub shown: Vec<Member>,
    /// Whitened columns at the recording's rows, base first, then candidates, then the target.
    white: Vec<Vec<f64>>,
    base: usize,
}

/// Friction of the base at the weighed rows, root mean square.
pub(crate) fn friction_of(real: &Side) -> f64 {
    let state = &real.prepared.state;
    let friction = real.prepared.rows.iter().map(|&i| state.base_friction_at(state.velocity[i])).collect::<Vec<_>>();
    root_mean_square(&real.on_rows(&friction)).max(f64::MIN_POSITIVE)
}

/// White noise as large as what base and smooth functions of all channels leave: that of the base alone would hide what recording and
/// simulation share.
pub(crate) fn white_noise(candidates: &Candidates, real: &Side) -> Noise {
    let (places, _) = candidates.shared(1.0, &[]);
    let columns: Vec<Vec<f64>> =
        real.columns.iter().cloned().chain(places.iter().map(|&place| candidates.real[place].clone())).collect();
    let left = fit_residual(&columns, &real.target, &real.runs);
    let deviation = root_mean_square(&real.on_rows(&left.unwrap_or_else(|| real.target.clone())));
    Noise::white(real.prepared.rows.len(), deviation.max(f64::MIN_POSITIVE))
}

/// Noise beside base, shared columns and the candidates that explain most, one after the other.
pub(crate) fn first_noise(candidates: &Candidates, real: &Side, simulated: Option<&Side>) -> Noise {
    let friction = friction_of(real);
    let weighing = Weighing::new(candidates, real, simulated, &white_noise(candidates, real), friction);
    let weighed = candidates.weighed(friction, weighing.random());
    let field = Field { reduced: &weighing.reduced, candidates: &weighed, price: FIRST_PRICE, temper: 1.0 };
    let members = field.forward(MEMBERS_BESIDE_NOISE);
    Noise::fit(&weighing.left(candidates, real, &weighed, &members), &real.runs, &real.features)
}

/// Weights of all columns with which random effects at some places explain a side: their means.
fn explained_weights(side: &Reduced, places: &[usize], precision: &[f64]) -> Option<DVector<f64>> {
    let means = RandomEffects::new(side, side, places.to_vec(), precision)?.means(side, side, &[]);
    let mut weights = DVector::zeros(side.moments.len());
    places.iter().zip(means).for_each(|(place, mean)| weights[*place] = mean);
    Some(weights)
}

impl Weighing {
    pub fn new(candidates: &Candidates, real: &Side, simulated: Option<&Side>, noise: &Noise, friction: f64) -> Self {
        let base = real.columns.len();
        let whitened = |side: &Side, columns: &[Vec<f64>], noise: &Noise| {
            let mut white = side.whitened(&side.columns, noise);
            white.extend(side.whitened(columns, noise));
            white.extend(side.whitened(std::slice::from_ref(&side.target), noise));
            white
        };
        let mut white = whitened(real, &candidates.real, noise);
        let mut of_all = products(&white);
        let target = white.len() - 1;
        // A simulation that was measured with the same noise has as much of it.
        let has_same_noise = simulated.is_some_and(|side| side.repeats > 1.0);
        for (place, own_noise) in candidates.own_noise.iter().enumerate().filter(|_| !has_same_noise) {
            of_all[(base + place, target)] -= own_noise;
            of_all[(target, base + place)] -= own_noise;
        }
        let mut of_real = Reduced::without_base(&of_all, base);
        let mut by_noise = None;
        let beside = simulated.and_then(|side| {
            let noise = noise.at_rows_of(&side.features);
            let white = whitened(side, &candidates.simulated, &noise);
            let of_simulated = Reduced::without_base(&(products(&white) * side.repeats), side.columns.len());
            // What the simulation shows by itself is there on both sides.
            let alone = candidates.weighed(friction, None);
            let field = Field { reduced: &of_simulated, candidates: &alone, price: FIRST_PRICE, temper: 1.0 };
            let shown = field.forward(MOST_SHOWN);
            let (places, precision) = candidates.shared(friction, &shown);
            if has_same_noise {
                // How large the noise is the recording says only so well: what it makes of the simulation is there as often as the recording asks for.
                let weights = explained_weights(&of_simulated, &places, &precision)?;
                of_real = of_real.without_sum(&weights);
                by_noise = Some(weights);
            }
            let all = of_real.plus(&of_simulated);
            let random = RandomEffects::new(&all, &of_real, places, &precision)?;
            Some((random.integrated_out(&all, &of_real), all, random, shown))
        });
        let of_noise = by_noise.map(|weights| weighted(&white[base..target], weights.as_slice()));
        white.splice(base..base, of_noise);
        let base = white.len() - 1 - candidates.real.len();
        match beside {
            Some((reduced, all, random, shown)) => {
                Self { real: of_real, reduced, both: Some((all, random)), shown, white, base }
            }
            None => Self { reduced: of_real.clone(), real: of_real, both: None, shown: Vec::new(), white, base },
        }
    }

    /// Whitened columns of the base.
    pub fn base(&self) -> &[Vec<f64>] {
        &self.white[..self.base]
    }

    /// Whitened columns of the candidates.
    pub fn columns(&self) -> &[Vec<f64>] {
        &self.white[self.base..self.white.len() - 1]
    }

    /// Whitened columns of the base and of some members.
    pub fn beside(&self, candidates: &Candidates, members: &[Member]) -> Vec<Vec<f64>> {
        let of_members = candidates.places(members).into_iter().map(|place| self.columns()[place].clone());
        self.base().iter().cloned().chain(of_members).collect()
    }

    /// The whitened target less the torque of coefficients of all columns.
    pub fn less(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut left = self.white.last().cloned().unwrap_or_default();
        left.iter_mut().zip(&weighted(self.columns(), coefficients)).for_each(|(left, torque)| *left -= torque);
        left
    }

    /// What noise like that which a model of some members leaves brings to every candidate.
    pub fn null(&self, weighed: &[Candidate], members: &[Member], seed: u64) -> NullEvidence {
        let left = self.left_white(weighed, members);
        let piece = (left.len() / REPLAYED_PIECES).max(1);
        let replay = Replay { residual: &left, piece, seed };
        let all = std::iter::once(0..left.len()).collect::<Vec<_>>();
        let basis = orthonormal(self.base(), &all);
        let columns = self.columns();
        let across = DMatrix::from_fn(basis.len(), columns.len(), |i, j| dot(&basis[i], &columns[j], &all));
        let own = replay.moments(columns) - replay.moments(&basis) * across;
        let moments = match &self.both {
            Some((_, random)) => random.beside(&own),
            None => own,
        };
        NullEvidence::new(&self.reduced, &moments, weighed)
    }

    /// Columns for which a random effect stands on the rows of both sides; `None` without a simulation.
    pub fn random(&self) -> Option<&[usize]> {
        self.both.as_ref().map(|(_, random)| random.places())
    }

    /// Coefficients of all columns of the recording in a model of some members: theirs, and the common ones beside them.
    pub fn coefficients(&self, weighed: &[Candidate], members: &[Member]) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.columns().len()];
        let of_members = self.of_members(weighed, members);
        if let Some((all, random)) = &self.both {
            for (place, mean) in random.places().iter().zip(random.means(all, &self.real, &of_members)) {
                coefficients[*place] += mean;
            }
        }
        let width = coefficients.len();
        of_members.into_iter().for_each(|(place, value)| coefficients[place % width] += value);
        coefficients
    }

    /// Coefficients of the common columns alone, beside some members.
    pub fn common(&self, weighed: &[Candidate], members: &[Member]) -> Vec<f64> {
        let mut coefficients = self.coefficients(weighed, members);
        coefficients.iter_mut().zip(self.own(weighed, members)).for_each(|(of, own)| *of -= own);
        coefficients
    }

    /// Coefficients of what the recording has beyond the common columns, in a model of some members.
    pub fn own(&self, weighed: &[Candidate], members: &[Member]) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.columns().len()];
        let width = coefficients.len();
        let own = self.of_members(weighed, members).into_iter().filter(|(place, _)| *place < width);
        own.for_each(|(place, value)| coefficients[place] += value);
        coefficients
    }

    /// Place and coefficient of each own and shared column of some members.
    fn of_members(&self, weighed: &[Candidate], members: &[Member]) -> Vec<(usize, f64)> {
        self.model(weighed, members).and_then(|model| model.coefficients()).unwrap_or_default()
    }

    /// Base, common columns and some members; `None` where that is singular to working precision.
    pub fn model(&self, weighed: &[Candidate], members: &[Member]) -> Option<Model<'_>> {
        let variants: Vec<&Variant> =
            members.iter().map(|member| &weighed[member.candidate].variants[member.variant]).collect();
        Model::new(&self.reduced, &variants)
    }

    /// What base, common columns and members leave at every row of the recording, by a plain fit of the base.
    pub fn left(&self, candidates: &Candidates, real: &Side, weighed: &[Candidate], members: &[Member]) -> Vec<f64> {
        let torque = weighted(&candidates.real, &self.coefficients(weighed, members));
        let mut target = real.target.clone();
        target.iter_mut().zip(&torque).for_each(|(target, torque)| *target -= torque);
        let of_members = candidates.places(members).into_iter().map(|place| candidates.real[place].clone());
        let columns: Vec<Vec<f64>> = real.columns.iter().cloned().chain(of_members).collect();
        fit_residual(&columns, &target, &real.runs).unwrap_or(target)
    }

    /// The same whitened, on the weighed rows.
    fn left_white(&self, weighed: &[Candidate], members: &[Member]) -> Vec<f64> {
        let mut left = self.less(&self.coefficients(weighed, members));
        let all = std::iter::once(0..left.len()).collect::<Vec<_>>();
        project_out(&mut left, &orthonormal(self.base(), &all), &all);
        left
    }
}

//! Every candidate with the columns of its shapes at the states of both sides, and its priors.

use crate::diagnose::hypotheses::function_form::Form;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::hypotheses::unnamed::{Generic, generic_rivals};
use crate::diagnose::infer::side::Side;
use crate::inference::evidence::{Candidate, Variant};
use crate::inference::sets::Member;
use crate::numerics::statistics::root_mean_square;
use crate::physics::{EffectId, Hypothesis, KNOWN_WITHIN_SHARE, Shape};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// Contribution of an effect to the torque over the friction (root mean squares) that its prior expects: effects that are worth a name
/// are of some per cent to the size of friction itself.
const EXPECTED_SHARE: f64 = 0.3;
/// Length scales of an unnamed function over the range of its channel, and the strength that stands for each where it is refitted:
/// from a broad function to a narrow feature (Matern 3/2; Solin and Sarkka 2020).
const LENGTH_SCALES: [(f64, f64); 3] = [(0.5, 20.0), (0.2, 200.0), (0.08, 2000.0)];

/// A shape of a candidate: its columns among all, and the relative prior variance of each.
#[derive(Clone, Debug)]
pub(crate) struct Shaped {
    pub shape: Shape,
    pub columns: Range<usize>,
    pub relative_variance: Vec<f64>,
    /// The coefficient of its scaled column where physics knows it.
    pub known: Option<f64>,
    pub log_weight: f64,
}

/// A candidate with its shapes.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub label: Label,
    pub log_prior: f64,
    pub repeats: bool,
    /// Whether the first coefficient may not be negative.
    pub only_positive: bool,
    pub shapes: Vec<Shaped>,
}

impl Entry {
    /// Whether it tells where and not why: a function without a name, or an event of any cause.
    pub fn tells_no_cause(&self) -> bool {
        self.is_function() || matches!(self.label, Label::Named(EffectId::TransientEvent))
    }

    /// Whether it is a smooth function without a name.
    pub fn is_function(&self) -> bool {
        matches!(&self.label, Label::Generic(rival) if rival.form == Form::Free)
    }
}

/// All candidates; columns have unit root mean square over the weighed rows of the recording.
#[derive(Default)]
pub(crate) struct Candidates {
    pub entries: Vec<Entry>,
    /// Filtered columns at the rows of the recording.
    pub real: Vec<Vec<f64>>,
    /// The same at the rows of the simulation.
    pub simulated: Vec<Vec<f64>>,
    /// What the noise of the recorded torque adds to the product of each column with it, both whitened.
    pub own_noise: Vec<f64>,
    /// Whether the simulation moves at the same times as the recording: else what happens at a time of one is not there in the other.
    one_clock: bool,
}

impl Candidates {
    /// Builds what the recording can show.
    pub fn new(hypotheses: &[Box<dyn Hypothesis + Send>], real: &Side, simulated: Option<&Side>) -> Self {
        let state = &real.prepared.state;
        let one_clock = simulated.is_some_and(|side| side.follows(real));
        let mut candidates = Self { one_clock, ..Self::default() };
        // A delay of the torque shifts every column: it is a parameter of the whole model.
        for hypothesis in hypotheses.iter().filter(|h| h.id() != EffectId::TimeMisalignment) {
            let shapes = hypothesis.shapes(state);
            let scanned = hypothesis.scanned(state).unwrap_or(shapes.len() as f64);
            candidates.entries.push(Entry {
                label: Label::Named(hypothesis.id()),
                log_prior: 0.0,
                repeats: hypothesis.repeats(),
                only_positive: hypothesis.only_positive(),
                shapes: Vec::new(),
            });
            candidates.extend(hypotheses, real, simulated, candidates.entries.len() - 1, shapes, -scanned.ln());
        }
        let rivals = generic_rivals(state);
        let log_prior = -(rivals.len().max(1) as f64).ln();
        for rival in rivals {
            candidates.entries.push(Entry {
                label: Label::Generic(rival),
                log_prior,
                repeats: false,
                only_positive: false,
                shapes: Vec::new(),
            });
            let entry = candidates.entries.len() - 1;
            if rival.form == Form::Free {
                candidates.add_function(hypotheses, real, simulated, entry, rival);
            } else {
                let shapes = rival.grid(state);
                let weight = -(shapes.len().max(1) as f64).ln();
                candidates.extend(hypotheses, real, simulated, entry, shapes, weight);
            }
        }
        candidates.entries.retain(|entry| !entry.shapes.is_empty());
        candidates
    }

    /// Adds shapes of a candidate, each with a weight of its own.
    pub fn extend(
        &mut self,
        hypotheses: &[Box<dyn Hypothesis + Send>],
        real: &Side,
        simulated: Option<&Side>,
        entry: usize,
        shapes: Vec<Shape>,
        log_weight: f64,
    ) {
        let label = self.entries[entry].label.clone();
        let named = hypotheses.iter().find(|hypothesis| label == Label::Named(hypothesis.id()));
        let shown_by = simulated.filter(|_| self.one_clock || !label.is_of_time());
        let built: Vec<[Vec<Vec<f64>>; 2]> = shapes
            .par_iter()
            .map(|shape| {
                let at = |side: &Side| side.filtered(hypotheses, (&label, shape), &real.prepared.state);
                [at(real), shown_by.map(at).unwrap_or_default()]
            })
            .collect();
        for (shape, [of_real, of_simulated]) in shapes.into_iter().zip(built) {
            let (columns, sizes) = self.add_columns(real, simulated, of_real, of_simulated);
            if !columns.is_empty() {
                let own_noise = real.product_with_own_noise(hypotheses, &label, &shape);
                if let (Some(first), Some(size)) = (self.own_noise.get_mut(columns.start), sizes.first()) {
                    *first = if *size > 0.0 { own_noise / size } else { 0.0 };
                }
                let relative_variance = vec![1.0; columns.len()];
                let known = named.and_then(|hypothesis| hypothesis.known_coefficient(&shape)).map(|c| c * sizes[0]);
                // A column that this recording does not show is expected nowhere.
                let known = known.filter(|known| *known > 0.0 && known.is_finite());
                self.entries[entry].shapes.push(Shaped { shape, columns, relative_variance, known, log_weight });
            }
        }
    }

    /// Adds an unnamed smooth function: one set of columns, a prior for each length scale.
    fn add_function(
        &mut self,
        hypotheses: &[Box<dyn Hypothesis + Send>],
        real: &Side,
        simulated: Option<&Side>,
        entry: usize,
        rival: Generic,
    ) {
        let shapes: Vec<Shape> = rival.variants(&real.prepared.state).into_iter().map(|(shape, _)| shape).collect();
        let Some(longest) = shapes.iter().map(|shape| shape[0]).max_by(f64::total_cmp) else { return };
        let label = Label::Generic(rival);
        let at = |side: &Side| side.filtered(hypotheses, (&label, &[longest, 0.0]), &real.prepared.state);
        let shown_by = simulated.filter(|_| self.one_clock || !label.is_of_time());
        let (columns, _) = self.add_columns(real, simulated, at(real), shown_by.map(at).unwrap_or_default());
        let first = longest as usize + 1 - columns.len();
        let named = |strength: f64| !shapes.iter().any(|shape| shape[1] == strength);
        let scales: Vec<(f64, f64)> = LENGTH_SCALES.into_iter().filter(|(_, strength)| !named(*strength)).collect();
        for (length, strength) in &scales {
            let density = |order: usize| {
                let wave = order as f64 * std::f64::consts::PI * length;
                (1.0 + wave * wave / 3.0).powi(-2)
            };
            self.entries[entry].shapes.push(Shaped {
                shape: vec![longest, *strength],
                columns: columns.clone(),
                relative_variance: (first..first + columns.len()).map(density).collect(),
                known: None,
                log_weight: -(scales.len() as f64).ln(),
            });
        }
    }

    /// Adds columns at unit root mean square; what the recording does not show stays zero. Their places, and the root mean square of each.
    fn add_columns(
        &mut self,
        real: &Side,
        simulated: Option<&Side>,
        mut of_real: Vec<Vec<f64>>,
        mut of_simulated: Vec<Vec<f64>>,
    ) -> (Range<usize>, Vec<f64>) {
        let begin = self.real.len();
        let mut sizes = Vec::with_capacity(of_real.len());
        if let Some(side) = simulated {
            of_simulated.resize_with(of_real.len(), || vec![0.0; side.prepared.rows.len()]);
        }
        for (place, column) in of_real.iter_mut().enumerate() {
            let size = root_mean_square(&real.on_rows(column));
            sizes.push(size);
            let scale = if size > 0.0 && size.is_finite() { size.recip() } else { 0.0 };
            let scaled = |value: &mut f64| *value = if scale == 0.0 { 0.0 } else { *value * scale };
            column.iter_mut().for_each(scaled);
            if let Some(column) = of_simulated.get_mut(place) {
                column.iter_mut().for_each(scaled);
                if column.iter().any(|value| !value.is_finite()) {
                    column.fill(0.0);
                }
            }
        }
        self.own_noise.resize(begin + of_real.len(), 0.0);
        self.real.extend(of_real);
        self.simulated.extend(of_simulated);
        (begin..self.real.len(), sizes)
    }

    /// Prior variance of a coefficient with a relative variance among others: together they are expected to contribute their share of
    /// the friction (root mean square).
    fn variance(friction: f64, relative: &[f64]) -> Vec<f64> {
        let sum: f64 = relative.iter().sum();
        relative.iter().map(|r| (EXPECTED_SHARE * friction).powi(2) * r / sum).collect()
    }

    /// Places of the columns of some members, one after the other.
    pub fn places(&self, members: &[Member]) -> Vec<usize> {
        members.iter().flat_map(|m| self.entries[m.candidate].shapes[m.variant].columns.clone()).collect()
    }

    /// What `inference` weighs; beside a simulation a candidate has a coefficient on all rows too, unless a random effect stands for it.
    pub fn weighed(&self, friction: f64, random: Option<&[usize]>) -> Vec<Candidate> {
        let shared = |shaped: &Shaped| match random {
            Some(random) if !random.contains(&shaped.columns.start) && self.is_shared(shaped.columns.start) => {
                let width = self.real.len();
                shaped.columns.start + width..shaped.columns.end + width
            }
            _ => 0..0,
        };
        let of_entry = |entry: &Entry| {
            let variant = |shaped: &Shaped| Variant {
                columns: shaped.columns.clone(),
                shared: shared(shaped),
                mean: vec![shaped.known.unwrap_or(0.0); shaped.columns.len()],
                variance: match shaped.known {
                    Some(known) => vec![(KNOWN_WITHIN_SHARE * known).powi(2)],
                    None => Self::variance(friction, &shaped.relative_variance),
                },
                log_weight: shaped.log_weight,
                only_positive: entry.only_positive && shaped.known.is_none(),
            };
            let variants: Vec<Variant> = entry.shapes.iter().map(variant).collect();
            Candidate { log_prior: entry.log_prior, variants, repeats: entry.repeats }
        };
        self.entries.iter().map(of_entry).collect()
    }

    /// The candidates with some of their shapes (places of candidate and shape) alone; unnamed functions keep theirs.
    pub fn only(&self, keep: impl Fn(Member) -> bool) -> Self {
        let mut kept = Self { one_clock: self.one_clock, ..Self::default() };
        let mut moved: BTreeMap<usize, usize> = BTreeMap::new();
        let mut take = |kept: &mut Self, columns: &Range<usize>| {
            if columns.is_empty() {
                return 0..0;
            }
            let begin = *moved.entry(columns.start).or_insert_with(|| {
                let begin = kept.real.len();
                kept.real.extend_from_slice(&self.real[columns.clone()]);
                kept.own_noise.extend_from_slice(&self.own_noise[columns.clone()]);
                if !self.simulated.is_empty() {
                    kept.simulated.extend_from_slice(&self.simulated[columns.clone()]);
                }
                begin
            });
            begin..begin + columns.len()
        };
        for (candidate, entry) in self.entries.iter().enumerate() {
            let stays = |variant: usize| entry.is_function() || keep(Member { candidate, variant });
            let shapes = entry.shapes.iter().enumerate().filter(|(variant, _)| stays(*variant));
            let shapes: Vec<Shaped> = shapes
                .map(|(_, shaped)| Shaped { columns: take(&mut kept, &shaped.columns), ..shaped.clone() })
                .collect();
            kept.entries.push(Entry { shapes, ..entry.clone() });
        }
        kept
    }

    /// Whether the simulation shows anything of a column; true of every column without a simulation.
    fn is_shared(&self, place: usize) -> bool {
        self.simulated.get(place).is_none_or(|column| column.iter().any(|value| *value != 0.0))
    }

    /// What recording and simulation may share, as random effects: smooth functions and the given shapes (places of candidate and shape);
    /// places of their columns, with the prior precision of each.
    pub fn shared(&self, friction: f64, shown: &[Member]) -> (Vec<usize>, Vec<f64>) {
        let (mut places, mut precision): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
        for member in shown {
            let shaped = &self.entries[member.candidate].shapes[member.variant];
            let variance = Self::variance(friction, &shaped.relative_variance);
            for (place, variance) in shaped.columns.clone().zip(variance) {
                if !places.contains(&place) {
                    places.push(place);
                    precision.push(variance.recip());
                }
            }
        }
        for entry in self.entries.iter().filter(|entry| entry.is_function()) {
            // The narrowest scale that is offered.
            let Some(shaped) = entry.shapes.last() else { continue };
            let variance = Self::variance(friction, &shaped.relative_variance);
            for (place, variance) in shaped.columns.clone().zip(variance) {
                if self.is_shared(place) && !places.contains(&place) {
                    places.push(place);
                    precision.push(variance.recip());
                }
            }
        }
        (places, precision)
    }
}

//! Every hypothesis as filtered columns: the named effects of the catalogue and the generic rivals.

use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::hypotheses::unnamed::generic_rivals;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, rows_in};
use crate::physics::{EffectId, Hypothesis, Shape};
use rayon::prelude::*;
use std::ops::Range;

/// One shape of a group and the columns that it occupies.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Shape parameters.
    pub shape: Shape,
    /// Columns of the design.
    pub columns: Range<usize>,
}

/// A hypothesis with all its variants.
#[derive(Clone, Debug)]
pub struct Group {
    /// What it stands for.
    pub label: Label,
    /// Its shapes.
    pub variants: Vec<Variant>,
}

/// Every hypothesis that this recording can show, filtered, one value a working row, scaled to unit root mean square.
#[derive(Clone, Debug)]
pub struct Design {
    /// Filtered columns.
    pub columns: Vec<Vec<f64>>,
    /// Groups of columns.
    pub groups: Vec<Group>,
}

impl Design {
    /// Builds the columns of the given hypotheses and of the generic rivals.
    pub fn new(prepared: &Prepared, hypotheses: &[Box<dyn Hypothesis + Send>], left_out: &[EffectId]) -> Self {
        let state = &prepared.state;
        let mut jobs: Vec<(Label, Shape, usize)> = Vec::new();
        for (index, hypothesis) in hypotheses.iter().enumerate().filter(|(_, h)| !left_out.contains(&h.id())) {
            jobs.extend(
                hypothesis.shapes(state).into_iter().map(|shape| (Label::Named(hypothesis.id()), shape, index)),
            );
        }
        let built: Vec<Vec<Vec<f64>>> = jobs
            .par_iter()
            .map(|(_, shape, index)| prepared.filtered_all(&hypotheses[*index].columns(state, shape)))
            .collect();
        let mut design = Self { columns: Vec::new(), groups: Vec::new() };
        for ((label, shape, _), columns) in jobs.into_iter().zip(built) {
            if columns.is_empty() {
                continue;
            }
            let begin = design.columns.len();
            design.columns.extend(columns);
            let variant = Variant { shape, columns: begin..design.columns.len() };
            match design.groups.last_mut().filter(|group| group.label == label) {
                Some(group) => group.variants.push(variant),
                None => design.groups.push(Group { label, variants: vec![variant] }),
            }
        }
        design.add_generic_rivals(prepared);
        let runs = prepared.open_runs();
        design.columns.par_iter_mut().for_each(|column| {
            let energy = dot(column, column, &runs);
            if energy > 0.0 && energy.is_finite() {
                let scale = (rows_in(&runs) as f64 / energy).sqrt();
                column.iter_mut().for_each(|v| *v *= scale);
            } else {
                column.fill(0.0);
            }
        });
        design
    }

    fn add_generic_rivals(&mut self, prepared: &Prepared) {
        let rivals = generic_rivals(&prepared.state);
        let built: Vec<Vec<Vec<f64>>> =
            rivals.par_iter().map(|rival| prepared.filtered_all(&rival.pool(&prepared.state))).collect();
        for (rival, columns) in rivals.into_iter().zip(built) {
            let begin = self.columns.len();
            self.columns.extend(columns);
            let variants = rival
                .variants(&prepared.state)
                .into_iter()
                .map(|(shape, place)| Variant { shape, columns: begin + place.start..begin + place.end })
                .collect();
            self.groups.push(Group { label: Label::Generic(rival), variants });
        }
    }
}

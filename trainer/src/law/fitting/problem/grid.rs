//! Where an optimisation starts: grids over the non-linear constants, for one structure or for terms added to a fit.

use super::{Effort, Fit, Held, Problem};
use crate::law::fitting::projection::{Basis, dot};
use crate::law::model::structure::{Nonlinear, SignForm, Structure, Term};

/// What a fitted law leaves and what it holds already, for terms that may be added to it.
pub struct Ground {
    sign: SignForm,
    known: Vec<(Nonlinear, f64)>,
    basis: Basis,
    residual: Vec<f64>,
}

impl Problem<'_> {
    /// A fitted law that terms are to be added to.
    pub fn ground(&self, parent: &Fit) -> Ground {
        let mut basis = self.nuisance.clone();
        self.tape(&parent.structure).run(&parent.params, &[]).values.iter().for_each(|column| {
            basis.push(column);
        });
        let mut residual = self.target.clone();
        basis.remove_from(&mut residual);
        Ground { sign: parent.structure.sign(), known: parent.nonlinear(), basis, residual }
    }

    /// Adds terms to a fitted law without moving its constants: the values of the newly needed constants that serve best
    /// among their starts, and the sum of squares then.
    pub fn screen(&self, ground: &Ground, added: &[Term]) -> (Vec<(Nonlinear, f64)>, f64) {
        let layout = self.extents.layout();
        let Ground { sign, known, basis, residual } = ground;
        let before = dot(residual, residual);
        let child = Structure::new(*sign, added.iter().copied());
        let names = child.nonlinear();
        let axes: Vec<Vec<f64>> = names
            .iter()
            .map(|n| match known.iter().find(|(k, _)| k == n) {
                Some((_, value)) => vec![*value],
                None => self.extents.range(*n, *sign).starts,
            })
            .collect();
        let tape = self.tape_of(&child.columns(layout));
        let mut best = (f64::INFINITY, Vec::new());
        for index in 0..axes.iter().map(Vec::len).product() {
            let mut rest = index;
            let psi: Vec<f64> = axes
                .iter()
                .map(|axis| {
                    let value = axis[rest % axis.len()];
                    rest /= axis.len();
                    value
                })
                .collect();
            let mut extra = Basis::default();
            for mut column in tape.run(&psi, &[]).values {
                let size = dot(&column, &column);
                basis.remove_from(&mut column);
                if dot(&column, &column) > 1e-16 * size {
                    extra.push(&column);
                }
            }
            let mut left = residual.clone();
            let gained: f64 = extra.remove_from(&mut left).iter().map(|p| p * p).sum();
            let rss = (before - gained).max(0.0);
            if rss < best.0 {
                best = (rss, psi);
            }
        }
        (names.into_iter().zip(best.1).collect(), best.0)
    }

    /// Fits from a grid over the constants in `open`, the others starting at `known`; the best `polish` grid points that
    /// are no neighbours of a better one are optimised.
    pub fn fit_grid(
        &self,
        structure: &Structure,
        known: &[(Nonlinear, f64)],
        held: Held<'_>,
        polish: usize,
        effort: Effort,
    ) -> Fit {
        let names = structure.nonlinear();
        let ranges = self.ranges(structure);
        let axes: Vec<Vec<f64>> = names
            .iter()
            .zip(&ranges)
            .map(|(n, range)| match known.iter().find(|(k, _)| k == n) {
                Some((_, value)) => vec![*value],
                None => range.starts.clone(),
            })
            .collect();
        let tape = self.tape(structure);
        let total: usize = axes.iter().map(Vec::len).product();
        let place = |mut index: usize| -> Vec<usize> {
            axes.iter()
                .map(|axis| {
                    let i = index % axis.len();
                    index /= axis.len();
                    i
                })
                .collect()
        };
        let value = |place: &[usize]| -> Vec<f64> { place.iter().zip(&axes).map(|(&i, a)| a[i]).collect() };
        let mut ranked: Vec<(f64, Vec<usize>)> = (0..total)
            .map(|index| {
                let place = place(index);
                let rss = if total == 1 { 0.0 } else { self.at(&tape, &value(&place), held.coefficient, &[]).rss };
                (if rss.is_nan() { f64::INFINITY } else { rss }, place)
            })
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut chosen: Vec<Vec<usize>> = Vec::new();
        for (_, place) in ranked {
            let near = chosen.iter().any(|c| c.iter().zip(&place).all(|(a, b)| a.abs_diff(*b) <= 1));
            if !near {
                chosen.push(place);
            }
            if chosen.len() == polish {
                break;
            }
        }
        chosen
            .iter()
            .map(|place| self.fit_from(structure, &value(place), held, effort))
            .min_by(|a, b| a.rss.total_cmp(&b.rss))
            .expect("a grid has at least one point")
    }
}

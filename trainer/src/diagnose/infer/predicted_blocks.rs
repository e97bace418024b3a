//! How well sets of effects predict blocks of the recording that they have not seen.

use crate::diagnose::infer::side::Side;
use crate::diagnose::infer::weighing::Weighing;
use crate::inference::evidence::Variant;
use crate::inference::products::products;
use crate::inference::reduced::Reduced;
use crate::inference::sets::{Field, Set};
use crate::inference::temper::{BlockProducts, exponent};
use crate::numerics::least_squares::{orthonormal, project_out};
use std::ops::Range;

/// Sets by which blocks are predicted. A limit of the computing time: those behind weigh next to nothing.
const PREDICTING_SETS: usize = 40;

/// The exponent with which the leading sets predict blocks that they have not seen.
pub(crate) fn temper_of(weighing: &Weighing, real: &Side, field: &Field, sets: &[Set]) -> f64 {
    let leading: Vec<&Set> = sets.iter().take(PREDICTING_SETS).collect();
    let mut places: Vec<usize> = leading
        .iter()
        .flat_map(|set| set.members.iter().flat_map(|member| field.variant(*member).columns.clone()))
        .collect();
    places.sort_unstable();
    places.dedup();
    let columns = weighing.columns();
    let all = std::iter::once(0..columns.first().map_or(0, Vec::len)).collect::<Vec<_>>();
    let basis = orthonormal(weighing.base(), &all);
    let target = weighing.less(&weighing.common(field.candidates, &leading[0].members));
    let mut beside: Vec<Vec<f64>> = places.iter().map(|&place| columns[place].clone()).collect();
    beside.push(target);
    beside.iter_mut().for_each(|column| project_out(column, &basis, &all));
    let of_rows = |rows: Range<usize>| {
        let part: Vec<Vec<f64>> = beside.iter().map(|column| column[rows.clone()].to_vec()).collect();
        let gram = products(&part);
        let width = places.len();
        BlockProducts {
            gram: gram.view((0, 0), (width, width)).clone_owned(),
            moments: gram.view((0, width), (width, 1)).column(0).clone_owned(),
        }
    };
    let blocks: Vec<BlockProducts> = real.blocks().into_iter().map(of_rows).collect();
    let BlockProducts { gram, moments } = of_rows(all[0].clone());
    let whole = Reduced { gram, moments, energy: 0.0 };
    let moved = |variant: &Variant| {
        let begin = places.binary_search(&variant.columns.start).unwrap_or(0);
        Variant { columns: begin..begin + variant.columns.len(), shared: 0..0, ..variant.clone() }
    };
    let variants: Vec<Vec<Variant>> =
        leading.iter().map(|set| set.members.iter().map(|member| moved(field.variant(*member))).collect()).collect();
    let of_sets: Vec<Vec<&Variant>> = variants.iter().map(|set| set.iter().collect()).collect();
    let priors: Vec<f64> = leading.iter().map(|set| field.weight(set) - field.temper * set.log_evidence).collect();
    exponent(&whole, &blocks, &of_sets, &priors)
}

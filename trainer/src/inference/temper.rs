//! How far the evidence is to be believed: the exponent with which the mixture of all sets predicts blocks of rows that it has not seen
//! (SafeBayes: Grunwald and van Ommen 2017). One where the model holds; less where its formulas or its noise are wrong.

use crate::inference::evidence::{Model, Variant, log_sum_exp};
use crate::inference::reduced::Reduced;
use nalgebra::{DMatrix, DVector};

/// Exponents that are tried: thirds of a factor of two, down to where a likelihood ratio of a million is one of two.
const LEAST_EXPONENT: f64 = 0.05;
const STEP: f64 = 0.794;

/// Products of one block's rows.
pub(crate) struct BlockProducts {
    pub gram: DMatrix<f64>,
    pub moments: DVector<f64>,
}

/// The exponent under which sets, weighed by all blocks but one, predict that one well: the mean of its logarithm under the predictive
/// likelihood, since few blocks tell it only roughly; `log_priors` are those of the sets.
pub(crate) fn exponent(whole: &Reduced, blocks: &[BlockProducts], sets: &[Vec<&Variant>], log_priors: &[f64]) -> f64 {
    let evidence = |reduced: &Reduced| -> Vec<f64> {
        sets.iter().map(|set| Model::new(reduced, set).map_or(f64::NEG_INFINITY, |model| model.log_evidence)).collect()
    };
    let with_all = evidence(whole);
    let without: Vec<Vec<f64>> = blocks
        .iter()
        .map(|block| {
            evidence(&Reduced {
                gram: &whole.gram - &block.gram,
                moments: &whole.moments - &block.moments,
                ..whole.clone()
            })
        })
        .collect();
    let score = |exponent: f64| -> f64 {
        let of_block = |without: &Vec<f64>| {
            let weights: Vec<f64> =
                without.iter().zip(log_priors).map(|(evidence, prior)| exponent * evidence + prior).collect();
            let total = log_sum_exp(weights.iter().copied());
            let terms: Vec<f64> = (0..sets.len())
                .filter(|&set| without[set].is_finite() && with_all[set].is_finite())
                .map(|set| weights[set] - total + with_all[set] - without[set])
                .collect();
            log_sum_exp(terms.iter().copied())
        };
        without.iter().map(of_block).sum()
    };
    let tried = std::iter::successors(Some(1.0), |exponent| Some(exponent * STEP)).take_while(|e| *e >= LEAST_EXPONENT);
    let scored: Vec<(f64, f64)> = tried.map(|exponent| (score(exponent), f64::ln(exponent))).collect();
    let total = log_sum_exp(scored.iter().map(|(score, _)| *score));
    scored.iter().map(|(score, logarithm)| (score - total).exp() * logarithm).sum::<f64>().exp()
}

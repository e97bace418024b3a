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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::products::products;
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// The exponent for two rival columns in twelve blocks; `apart` is the deviation of the coefficient from block to block.
    fn found(apart: f64) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let mut draw = || normal(&mut random);
        let blocks: Vec<BlockProducts> = (0..12)
            .map(|_| {
                let coefficient = 0.1 + apart * draw();
                let columns: Vec<Vec<f64>> = (0..2).map(|_| (0..200).map(|_| draw()).collect()).collect();
                let target = columns[0].iter().map(|c| coefficient * c + draw()).collect();
                let gram = products(&[columns, vec![target]].concat());
                BlockProducts {
                    gram: gram.view((0, 0), (2, 2)).clone_owned(),
                    moments: gram.view((0, 2), (2, 1)).column(0).clone_owned(),
                }
            })
            .collect();
        let sum = |of: fn(&BlockProducts) -> DMatrix<f64>| blocks.iter().map(of).reduce(|a, b| a + b).unwrap();
        let gram = sum(|block| block.gram.clone());
        let moments = sum(|block| DMatrix::from_column_slice(2, 1, block.moments.as_slice()));
        let whole = Reduced { gram, moments: DVector::from_column_slice(moments.as_slice()), energy: 0.0 };
        let variant = |column: usize| Variant {
            columns: column..column + 1,
            shared: 0..0,
            mean: vec![0.0],
            variance: vec![1.0],
            log_weight: 0.0,
            only_positive: false,
        };
        let [first, second] = [variant(0), variant(1)];
        exponent(&whole, &blocks, &[vec![], vec![&first], vec![&second]], &[0.0, -3.0, -3.0])
    }

    #[test]
    fn evidence_that_blocks_contradict_is_believed_less() {
        let (agreed, contradicted) = (found(0.0), found(0.6));
        assert!(agreed > 0.3, "{agreed}");
        assert!(contradicted < 0.6 * agreed, "{contradicted} beside {agreed}");
    }
}

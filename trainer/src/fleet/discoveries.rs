//! Many tests at once: the share of false ones among the discoveries is held (Benjamini and Hochberg 1995).

/// The smallest share of false discoveries at which each of these probabilities is a discovery, in their order.
pub(super) fn adjusted(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|&a, &b| probabilities[b].total_cmp(&probabilities[a]));
    let count = probabilities.len() as f64;
    let mut adjusted = vec![1.0; probabilities.len()];
    let mut least: f64 = 1.0;
    for (larger, &index) in order.iter().enumerate() {
        let rank = count - larger as f64;
        least = least.min(probabilities[index] * count / rank);
        adjusted[index] = least;
    }
    adjusted
}

/// The probability that one of several tests of one joint is as small as the smallest by chance (Bonferroni); 1 without a test.
pub(super) fn of_any(probabilities: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = probabilities.clone().count() as f64;
    probabilities.fold(1.0, f64::min).min(1.0 / count.max(1.0)) * count.max(1.0)
}

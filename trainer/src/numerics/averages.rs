//! Weighted averages over neighbours in a list, one for each row: what a low-pass makes of values that are known at more places than it
//! puts out.

use super::products::dot;
use std::ops::Range;

/// Rows, each with the places that it averages over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Averages {
    spans: Vec<Range<usize>>,
    /// Weights of the places of each row, row after row.
    weights: Vec<f64>,
    /// Where those of a row begin.
    begins: Vec<usize>,
}

impl Averages {
    /// Adds a row that averages over the places from `first` on with these weights, which are scaled to a sum of one.
    pub fn push(&mut self, first: usize, weights: impl Iterator<Item = f64>) {
        let begin = self.weights.len();
        self.weights.extend(weights);
        let sum: f64 = self.weights[begin..].iter().sum();
        self.weights[begin..].iter_mut().for_each(|weight| *weight /= sum);
        self.spans.push(first..first + self.weights.len() - begin);
        self.begins.push(begin);
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spans.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    /// The average of each row over `values`, one a place.
    #[must_use]
    pub fn over(&self, values: &[f64]) -> Vec<f64> {
        let row = |(span, begin): (&Range<usize>, &usize)| match span.len() {
            1 => values[span.start],
            count => dot(&self.weights[*begin..begin + count], &values[span.clone()]),
        };
        self.spans.iter().zip(&self.begins).map(row).collect()
    }

    /// The same for some of the rows, over no more places than they need, which are told in their order.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> (Self, Vec<usize>) {
        let places = self.spans.iter().map(|span| span.end).max().unwrap_or(0);
        let mut needed = vec![false; places];
        rows.iter().for_each(|&row| needed[self.spans[row].clone()].fill(true));
        let kept: Vec<usize> = (0..places).filter(|&place| needed[place]).collect();
        let mut selected = Self::default();
        for &row in rows {
            let (span, begin) = (&self.spans[row], self.begins[row]);
            // The places of a row follow each other, and all of them are kept.
            let first = kept.partition_point(|place| *place < span.start);
            selected.push(first, self.weights[begin..begin + span.len()].iter().copied());
        }
        (selected, kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_averaged_and_some_of_them_need_fewer_places() {
        let mut averages = Averages::default();
        averages.push(0, [1.0, 1.0, 2.0].into_iter());
        averages.push(1, [3.0, 1.0].into_iter());
        averages.push(4, [5.0].into_iter());
        let values = [4.0, 8.0, 2.0, 99.0, 7.0];
        assert_eq!(averages.over(&values), [4.0, 6.5, 7.0]);
        let (selected, kept) = averages.select(&[1, 2]);
        assert_eq!(kept, [1, 2, 4]);
        let left: Vec<f64> = kept.iter().map(|&place| values[place]).collect();
        assert_eq!(selected.over(&left), [6.5, 7.0]);
    }
}

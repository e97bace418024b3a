//! Derivatives of the residuals with respect to the unknowns: sparse rows, gradients and normal equations.

use std::ops::Range;

use super::dataset::{Dataset, fold_chunks};
use super::model::{Model, Unknowns};
use crate::kan::network::trace::Trace;

/// One row of the Jacobian: runs of consecutive unknowns, in ascending order.
#[derive(Default)]
struct Row {
    runs: Vec<Range<usize>>,
    values: Vec<f64>,
}

impl Row {
    fn fill(&mut self, model: &Model, unknowns: &Unknowns, dataset: &Dataset, row: usize, trace: &mut Trace) -> f64 {
        let residual = model.residual(dataset, row, trace);
        trace.backward(&model.network);
        self.runs.clear();
        self.values.clear();
        let parameters = model.network.parameters();
        for (index, layer) in model.network.layers().iter().enumerate() {
            for (position, edge) in layer.edges.iter().enumerate() {
                let Some(start) = unknowns.start(index, position) else { continue };
                let (adjoint, edge_trace) = trace.edge(index, position, layer.inputs);
                let support = edge.basis.order() + 1;
                let first = start + edge_trace.local.first;
                let gain = adjoint * parameters[edge.scale()];
                self.runs.push(first..first + support);
                self.values.extend(edge_trace.local.value[..support].iter().map(|b| gain * b));
                if unknowns.with_base {
                    let base = start + edge.basis.len();
                    self.runs.push(base..base + 1);
                    self.values.push(adjoint * edge_trace.silu);
                }
            }
        }
        if unknowns.len() > unknowns.linear_start() {
            self.runs.push(unknowns.linear_start()..unknowns.len());
            self.values.extend(dataset.linear.iter().zip(&model.linear_width).map(|(column, w)| column[row] / w));
        }
        residual
    }
}

/// Sums over samples that one Gauss-Newton step needs; the matrix is `J'J`, upper triangle, row-major.
#[derive(Clone)]
pub(in crate::kan) struct NormalEquations {
    pub(in crate::kan) size: usize,
    pub(in crate::kan) matrix: Vec<f64>,
    /// `J'r`, half the gradient of the residual sum.
    pub(in crate::kan) gradient: Vec<f64>,
    pub(in crate::kan) residual_sum: f64,
}

impl NormalEquations {
    fn zeros(size: usize) -> Self {
        Self { size, matrix: vec![0.0; size * size], gradient: vec![0.0; size], residual_sum: 0.0 }
    }

    pub(in crate::kan) fn of(model: &Model, unknowns: &Unknowns, dataset: &Dataset, rows: &[Range<usize>]) -> Self {
        let chunk = |rows: &[Range<usize>]| {
            let mut sums = Self::zeros(unknowns.len());
            let mut trace = Trace::for_training(&model.network, unknowns.with_base);
            let mut jacobian_row = Row::default();
            for row in rows.iter().cloned().flatten() {
                let residual = jacobian_row.fill(model, unknowns, dataset, row, &mut trace);
                sums.add(&jacobian_row, residual);
            }
            sums
        };
        fold_chunks(rows, None, chunk, |sum: Option<Self>, part| match sum {
            None => Some(part),
            Some(mut sum) => {
                sum.matrix.iter_mut().zip(&part.matrix).for_each(|(a, b)| *a += b);
                sum.gradient.iter_mut().zip(&part.gradient).for_each(|(a, b)| *a += b);
                sum.residual_sum += part.residual_sum;
                Some(sum)
            }
        })
        .unwrap_or_else(|| Self::zeros(unknowns.len()))
    }

    fn add(&mut self, row: &Row, residual: f64) {
        self.residual_sum += residual * residual;
        let mut before = 0;
        for (k, run) in row.runs.iter().enumerate() {
            for (within, index) in run.clone().enumerate() {
                let value = row.values[before + within];
                self.gradient[index] += value * residual;
                let target = &mut self.matrix[index * self.size..(index + 1) * self.size];
                let mut position = before;
                for other in &row.runs[k..] {
                    let values = &row.values[position..position + other.len()];
                    position += other.len();
                    // Cubic edges come in runs of four: a fixed length lets the compiler use vectors.
                    match (<&mut [f64; 4]>::try_from(&mut target[other.clone()]), <&[f64; 4]>::try_from(values)) {
                        (Ok(sums), Ok(values)) => (0..4).for_each(|i| sums[i] += value * values[i]),
                        _ => target[other.clone()].iter_mut().zip(values).for_each(|(sum, v)| *sum += value * v),
                    }
                }
            }
            before += run.len();
        }
    }
}

/// Derivatives of the normalised output with respect to all unknowns, one dense row for each row of the data.
pub(in crate::kan) fn derivatives(model: &Model, unknowns: &Unknowns, dataset: &Dataset) -> Vec<Vec<f64>> {
    let (mut trace, mut row) = (Trace::for_training(&model.network, unknowns.with_base), Row::default());
    (0..dataset.rows())
        .map(|sample| {
            row.fill(model, unknowns, dataset, sample, &mut trace);
            let mut dense = vec![0.0; unknowns.len()];
            row.runs.iter().cloned().flatten().zip(&row.values).for_each(|(i, v)| dense[i] = *v);
            dense
        })
        .collect()
}

/// Sum of squared residuals and its full gradient, without a matrix.
pub(in crate::kan) fn residual_sum_and_gradient(
    model: &Model,
    unknowns: &Unknowns,
    dataset: &Dataset,
    rows: &[Range<usize>],
) -> (f64, Vec<f64>) {
    let chunk = |rows: &[Range<usize>]| {
        let mut trace = Trace::for_training(&model.network, unknowns.with_base);
        let mut jacobian_row = Row::default();
        let (mut sum, mut gradient) = (0.0, vec![0.0; unknowns.len()]);
        for row in rows.iter().cloned().flatten() {
            let residual = jacobian_row.fill(model, unknowns, dataset, row, &mut trace);
            sum += residual * residual;
            let indices = jacobian_row.runs.iter().cloned().flatten();
            for (index, value) in indices.zip(&jacobian_row.values) {
                gradient[index] += 2.0 * residual * value;
            }
        }
        (sum, gradient)
    };
    fold_chunks(rows, (0.0, vec![0.0; unknowns.len()]), chunk, |(sum, mut gradient), (part, part_gradient)| {
        gradient.iter_mut().zip(&part_gradient).for_each(|(a, b)| *a += b);
        (sum + part, gradient)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kan::Architecture;
    use crate::kan::Blocks;
    use crate::kan::Network;
    use crate::kan::Random;

    fn randomised(architecture: &Architecture, dataset: &Dataset, seed: u64) -> Model {
        let mut random = Random::new(seed, 0);
        let mut network = Network::zeros(architecture).unwrap();
        network.parameters.iter_mut().for_each(|p| *p = random.uniform(-0.9, 0.9));
        let mut model = Model::scaled_to(network, dataset, &dataset.training_rows());
        model.linear.iter_mut().for_each(|a| *a = random.normal());
        model
    }

    #[test]
    fn gradient_agrees_with_finite_differences() {
        let mut random = Random::new(3, 1);
        let mut column = |n: usize| (0..n).map(|_| random.uniform(-2.0, 3.0)).collect::<Vec<f64>>();
        let inputs = [column(40), column(40)];
        let linear = [column(40)];
        let target = column(40);
        let blocks = Blocks::default();
        let dataset = Dataset { inputs: &inputs, target: &target, linear: &linear, blocks: &blocks };
        for (shape, outer_tanh) in
            [("[2,1]", false), ("[2,3,1]", true), ("[2,[2,2],[1,1],1]", false), ("[2,[1,1],2,1]", true)]
        {
            let mut architecture: Architecture = shape.parse().unwrap();
            architecture.outer_tanh = outer_tanh;
            let mut model = randomised(&architecture, &dataset, 5);
            model.network.set_active(0, 1, 0, false).unwrap();
            let unknowns = Unknowns::of(&model, true);
            let (_, gradient) = residual_sum_and_gradient(&model, &unknowns, &dataset, &dataset.training_rows());
            let normal = NormalEquations::of(&model, &unknowns, &dataset, &dataset.training_rows());
            let start = unknowns.read(&model);
            let step = 1e-6;
            for i in 0..unknowns.len() {
                let mut at = |amount: f64| {
                    let mut values = start.clone();
                    values[i] += amount;
                    unknowns.write(&values, &mut model);
                    model.residual_sum(&dataset, &dataset.training_rows())
                };
                let difference = (at(step) - at(-step)) / (2.0 * step);
                let tolerance = 1e-5 * (1.0 + difference.abs());
                assert!((difference - gradient[i]).abs() < tolerance, "{shape} {i}: {difference} {}", gradient[i]);
                assert!((2.0 * normal.gradient[i] - gradient[i]).abs() < 1e-9 * (1.0 + gradient[i].abs()));
            }
        }
    }

    #[test]
    fn normal_matrix_is_the_product_of_the_rows() {
        let inputs = [vec![-0.9, -0.1, 0.3, 0.8, 0.95]];
        let target = vec![1.0, 2.0, -1.0, 0.5, 0.0];
        let blocks = Blocks::default();
        let dataset = Dataset { inputs: &inputs, target: &target, linear: &[], blocks: &blocks };
        let model = randomised(&"[1,2,1]".parse().unwrap(), &dataset, 1);
        let unknowns = Unknowns::of(&model, true);
        let normal = NormalEquations::of(&model, &unknowns, &dataset, &dataset.training_rows());
        let n = unknowns.len();
        let mut expected = vec![0.0; n * n];
        for dense in derivatives(&model, &unknowns, &dataset) {
            (0..n * n).for_each(|k| expected[k] += dense[k / n] * dense[k % n]);
        }
        for i in 0..n {
            for j in i..n {
                assert!((normal.matrix[i * n + j] - expected[i * n + j]).abs() < 1e-12);
            }
        }
    }
}

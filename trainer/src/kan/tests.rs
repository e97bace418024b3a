//! The room as a whole: laws of the paper, noise, linear columns, decoys, and data that are no pleasure.

use std::slice::from_ref;

use super::*;

/// Coulomb, Stribeck and viscous friction of the paper's six axes: k1, k2 [N m], k3 [rad/s], k4 [N m s/rad].
const AXES: [[f64; 4]; 6] = [
    [22.0, 8.0, 0.10, 0.03],
    [23.0, 10.0, 0.13, 0.16],
    [24.0, 12.0, 0.16, 0.29],
    [25.0, 14.0, 0.19, 0.42],
    [26.0, 16.0, 0.22, 0.55],
    [27.0, 18.0, 0.25, 0.68],
];

fn friction([coulomb, stribeck, velocity, viscous]: [f64; 4], v: f64) -> f64 {
    (coulomb + stribeck * (-(v / velocity).abs()).exp()) * (50.0 * v).tanh() + viscous * v
}

fn column(random: &mut Random, rows: usize) -> Vec<f64> {
    (0..rows).map(|_| random.uniform(-1.0, 1.0)).collect()
}

fn options(shape: &str) -> FitOptions {
    FitOptions::new(shape.parse().unwrap())
}

fn silent(_: &Progress) {}

/// A fit of all rows, without linear columns.
fn trained(inputs: &[Vec<f64>], target: &[f64], options: &FitOptions) -> FitResult {
    let blocks = Blocks::default();
    fit(&Dataset { inputs, target, linear: &[], blocks: &blocks }, options, &silent).unwrap()
}

fn rmse(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn learns_the_paper_s_clean_laws_to_four_millinewtonmetres() {
    for (axis, parameters) in AXES.into_iter().enumerate() {
        let mut random = Random::new(axis as u64, 0);
        let (v, test) = (column(&mut random, 1000), column(&mut random, 2000));
        let torque: Vec<f64> = v.iter().map(|&v| friction(parameters, v)).collect();
        let truth: Vec<f64> = test.iter().map(|&v| friction(parameters, v)).collect();
        let options = FitOptions { restarts: 3, tolerance: 3e-3, ..options("[1,5,1]") };
        let result = trained(&[v], &torque, &options);
        let fitted = result.network.evaluate_columns(from_ref(&test));
        let error = rmse(&fitted, &truth);
        let miss = |i: &usize| (fitted[*i] - truth[*i]).abs();
        let worst = (0..test.len()).max_by(|a, b| miss(a).total_cmp(&miss(b))).unwrap();
        assert!(error < 4e-3, "axis {}: {error}, worst {} at {} rad/s", axis + 1, miss(&worst), test[worst]);
    }
}

#[test]
fn finer_cells_are_taken_as_long_as_they_pay() {
    let mut random = Random::new(5, 0);
    let (v, test) = (column(&mut random, 1000), column(&mut random, 2000));
    let torque: Vec<f64> = v.iter().map(|&v| friction(AXES[0], v)).collect();
    let truth: Vec<f64> = test.iter().map(|&v| friction(AXES[0], v)).collect();
    let coarse: FitOptions =
        FitOptions { architecture: Architecture::additive(1, &[]).with_resolution(8, 3), ..options("[1,1]") };
    let error = |refinements| {
        let result = trained(from_ref(&v), &torque, &FitOptions { refinements, ..coarse.clone() });
        (rmse(&result.network.evaluate_columns(from_ref(&test)), &truth), result.network.coefficient_count())
    };
    let [(before, few), (after, many)] = [error(0), error(3)];
    assert!(after < 0.02 * before && many > 5 * few, "{before} with {few}, {after} with {many} coefficients");
    // Noise pays for no finer cells than it has to.
    let noisy: Vec<f64> = torque.iter().map(|f| f + 5.0 * random.normal()).collect();
    let result = trained(from_ref(&v), &noisy, &FitOptions { refinements: 3, ..coarse });
    let error = rmse(&result.network.evaluate_columns(from_ref(&test)), &truth);
    assert!(error < 1.2, "{error}");
}

#[test]
fn a_pull_towards_few_edges_leaves_few() {
    let mut random = Random::new(6, 0);
    let v = column(&mut random, 800);
    let torque: Vec<f64> = v.iter().map(|v| (3.0 * v).tanh() + 0.02 * random.normal()).collect();
    let blocks = Blocks::default();
    let dataset = Dataset { inputs: from_ref(&v), target: &torque, linear: &[], blocks: &blocks };
    let busy = |optimiser, sparsity| {
        let steps = if optimiser == Optimiser::GaussNewton { 60 } else { 600 };
        let smoothing = Smoothing::Fixed(1e-6);
        let options = FitOptions { optimiser, steps, smoothing, sparsity, ..options("[1,5,1]") };
        let result = trained(from_ref(&v), &torque, &options);
        let scores = Attribution::of(&result.network, &dataset, &dataset.training_rows()).edges;
        (scores.iter().flatten().filter(|score| **score > 0.05).count(), result.train_rmse)
    };
    for (optimiser, weight) in [(Optimiser::GaussNewton, 3e-3), (Optimiser::Lbfgs, 3e-2)] {
        let (all, _) = busy(optimiser, Sparsity::NONE);
        let (few, error) = busy(optimiser, Sparsity { l1: weight, entropy: weight });
        assert!(few + 4 <= all && error < 0.1, "{optimiser:?}: {few} of {all} edges, {error}");
    }
}

#[test]
fn does_not_follow_noise() {
    for (axis, (ratio, floor)) in [(0.03, 0.9999), (0.12, 0.9988), (0.20, 0.9957)].into_iter().enumerate() {
        let parameters = AXES[[0, 3, 5][axis]];
        let mut random = Random::new(9, axis as u64);
        let (v, test) = (column(&mut random, 1000), column(&mut random, 2000));
        let clean: Vec<f64> = v.iter().map(|&v| friction(parameters, v)).collect();
        let spread = clean.iter().copied().fold(f64::MIN, f64::max) - clean.iter().copied().fold(f64::MAX, f64::min);
        let noisy: Vec<f64> = clean.iter().map(|f| f + 0.5 * ratio * spread * random.normal()).collect();
        let truth: Vec<f64> = test.iter().map(|&v| friction(parameters, v)).collect();
        let result = trained(&[v], &noisy, &options("[1,5,1]"));
        let error = rmse(&result.network.evaluate_columns(&[test]), &truth);
        let mean = truth.iter().sum::<f64>() / truth.len() as f64;
        let r2 = 1.0 - error * error / (truth.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / truth.len() as f64);
        assert!(r2 > floor, "{r2} at {ratio}");
    }
}

#[test]
fn one_seed_gives_one_result_on_any_number_of_threads() {
    let mut random = Random::new(4, 0);
    let v = column(&mut random, 9000);
    let torque: Vec<f64> = v.iter().map(|&v| friction(AXES[0], v) + random.normal()).collect();
    let options = FitOptions { steps: 4, restarts: 3, ..options("[1,2,1]") };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let result = pool.install(|| trained(from_ref(&v), &torque, &options));
        serde_json::to_vec(&result).unwrap()
    };
    let one = on(1);
    assert!(one == on(2));
    assert!(one == on(1));
    let other = trained(from_ref(&v), &torque, &FitOptions { seed: 1, ..options.clone() });
    assert!(serde_json::to_vec(&other).unwrap() != one);
}

#[test]
fn identifies_rigid_body_columns_together_with_friction() {
    let mut random = Random::new(2, 0);
    let rows = 3000;
    let (v, acceleration, position) = (column(&mut random, rows), column(&mut random, rows), column(&mut random, rows));
    let gravity: Vec<f64> = position.iter().map(|q| (3.0 * q).sin()).collect();
    let torque: Vec<f64> = (0..rows)
        .map(|i| friction(AXES[1], v[i]) + 12.5 * acceleration[i] + 70.0 * gravity[i] + 0.3 * random.normal())
        .collect();
    let inputs = [v.clone()];
    let linear = [acceleration, gravity];
    let blocks = Blocks { train: vec![], validation: vec![0..500, 2500..3000] };
    let dataset = Dataset { inputs: &inputs, target: &torque, linear: &linear, blocks: &blocks };
    for base_weights in [false, true] {
        let result = fit(&dataset, &FitOptions { base_weights, ..options("[1,3,1]") }, &silent).unwrap();
        assert!((result.linear_coefficients[0] - 12.5).abs() < 0.05, "{:?}", result.linear_coefficients);
        assert!((result.linear_coefficients[1] - 70.0).abs() < 0.05, "{:?}", result.linear_coefficients);
        assert!(result.validation_rmse.unwrap() < 0.32);
        let truth: Vec<f64> = v.iter().map(|&v| friction(AXES[1], v)).collect();
        let mut network = result.network.clone();
        // The constant belongs to friction or to an offset: the caller decides, here by symmetry.
        network.shift_output(-0.5 * (network.evaluate(&[0.5]) + network.evaluate(&[-0.5])));
        assert!(rmse(&network.evaluate_columns(&inputs), &truth) < 0.1);
    }
}

#[test]
fn learns_friction_that_grows_with_load() {
    let mut random = Random::new(6, 0);
    let (v, load) = (column(&mut random, 2000), column(&mut random, 2000));
    let torque: Vec<f64> =
        (0..2000).map(|i| (20.0 + 8.0 * load[i]) * (20.0 * v[i]).tanh() + 3.0 * v[i] + 0.1 * random.normal()).collect();
    for shape in ["[2,4,1]", "[2,[2,1],1]"] {
        let result = trained(&[v.clone(), load.clone()], &torque, &FitOptions { restarts: 3, ..options(shape) });
        assert!(result.train_rmse < 0.15, "{shape}: {}", result.train_rmse);
        let truth = (20.0 + 8.0 * 0.5) * 4f64.tanh() + 0.6;
        assert!((result.network.evaluate(&[0.2, 0.5]) - truth).abs() < 0.2);
    }
}

#[test]
fn pruning_drops_decoys_and_keeps_the_inputs_that_matter() {
    for correlation in [0.0, 0.8] {
        let mut random = Random::new(8, 0);
        let (v, load) = (column(&mut random, 1200), column(&mut random, 1200));
        let decoy: Vec<f64> = v.iter().map(|v| correlation * v + (1.0 - correlation) * random.normal()).collect();
        let torque: Vec<f64> = (0..1200).map(|i| friction(AXES[0], v[i]) + 5.0 * load[i] + random.normal()).collect();
        let inputs = [v, load, decoy];
        let blocks = Blocks::default();
        let dataset = Dataset { inputs: &inputs, target: &torque, linear: &[], blocks: &blocks };
        let options = options("[3,3,1]");
        let full = fit(&dataset, &options, &silent).unwrap();
        let pruned = prune(&full, &dataset, &options, &PruneOptions::default(), &silent).unwrap();
        let used = pruned.result.network.live_nodes()[0].clone();
        assert_eq!(used, [true, true, false], "{correlation}: {:?}", pruned.removed);
        assert!(pruned.result.train_rmse < full.train_rmse * 1.03);
    }
}

#[test]
fn survives_what_recordings_contain() {
    let mut random = Random::new(5, 0);
    let v = column(&mut random, 300);
    let clean: Vec<f64> = v.iter().map(|&v| friction(AXES[0], v)).collect();
    let constant = vec![3.0; 300];
    let finite = |inputs: &[Vec<f64>], target: &[f64], shape: &str| {
        let result = trained(inputs, target, &options(shape));
        assert!(result.train_rmse.is_finite());
        let point: Vec<f64> = inputs.iter().map(|column| column[0] + 0.3).collect();
        assert!(result.network.evaluate(&point).is_finite());
        result
    };
    // A constant input, a constant target, one velocity only, four samples, two values.
    assert!(finite(&[v.clone(), constant.clone()], &clean, "[2,3,1]").train_rmse < 1.0);
    assert!(finite(from_ref(&v), &constant, "[1,5,1]").train_rmse < 1e-6);
    finite(from_ref(&constant), &clean, "[1,2,1]");
    finite(&[v[..4].to_vec()], &clean[..4], "[1,5,1]");
    let steps: Vec<f64> = v.iter().map(|v| v.signum()).collect();
    finite(from_ref(&steps), &steps, "[1,[2,1],1]");
    // Outliers in target and input.
    let mut wild = clean.clone();
    wild[7] = 1e9;
    finite(from_ref(&v), &wild, "[1,5,1]");
    let mut far = v.clone();
    far[3] = 1e6;
    finite(&[far], &clean, "[1,5,1]");
}

#[test]
fn every_optimiser_learns_and_says_how_it_ended() {
    let v: Vec<f64> = (0..400).map(|i| -1.0 + f64::from(i) / 200.0).collect();
    let torque: Vec<f64> = v.iter().map(|v| 3.0 * (4.0 * v).tanh() + v).collect();
    let blocks = Blocks { train: vec![0..150, 200..400], validation: vec![150..200] };
    let inputs = [v];
    let dataset = Dataset { inputs: &inputs, target: &torque, linear: &[], blocks: &blocks };
    let trials =
        [(Optimiser::GaussNewton, 50, 0.01), (Optimiser::Lbfgs, 200, 0.03), (Optimiser::Adam { rate: 0.02 }, 600, 0.1)];
    for (optimiser, steps, bound) in trials {
        let options = FitOptions { optimiser, steps, tolerance: 1e-4, ..options("[1,3,1]") };
        let result = fit(&dataset, &options, &silent).unwrap();
        assert!(result.train_rmse < bound, "{optimiser:?}: {}", result.train_rmse);
        assert!(result.convergence.gradient_norm.is_finite() && result.convergence.evaluations > 0);
        assert_eq!(result.history.len(), result.convergence.steps + 1);
        let rmse_at = |share: f64| rmse(&result.network_at(share).evaluate_columns(&inputs), &torque);
        assert!(rmse_at(0.0) >= rmse_at(1.0));
    }
}

//! Other people's recordings, read from `../shared/recordings`: every one loads, and published figures come back.

use std::ops::Range;
use std::path::Path;

use frikan_tests::recordings;
use frikan_trainer::joint::Joint;
use frikan_trainer::numerics::regression::least_squares;
use frikan_trainer::recording::{self, Recording};
use frikan_trainer::samples::relevance::relevance;
use frikan_trainer::samples::rigid_body::{TermKind, separate};
use frikan_trainer::samples::{Preparation, Request, Samples, prepare, prepare_every_row};

fn load(path: &Path, joint: &Joint) -> Recording {
    recording::load(path, joint).unwrap_or_else(|error| panic!("{error}"))
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), x| (sum + x * x, count + 1));
    (sum / count as f64).sqrt()
}

/// Sixteen equal blocks.
fn blocks(length: usize) -> Vec<Range<usize>> {
    (0..16).map(|k| k * length / 16..(k + 1) * length / 16).collect()
}

/// Janot, Gautier and Brunot (2019): Coulomb and viscous friction with offset, 100 Hz after a low-pass.
#[test]
fn emps_gives_the_published_parameters() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::default();
    let train = load(&folder.join("emps/train.csv"), &joint);
    let request = Request { rate_hz: Some(100.0), ..Request::default() };
    let preparation = Preparation::plan(&[&train], &joint, &request).unwrap();
    let samples = prepare(&train, &preparation).unwrap();
    let velocity = samples.velocity.clone().unwrap();
    let force = samples.actuator.clone().unwrap();
    let sign = velocity.iter().map(|v| v.signum()).collect();
    let columns = [samples.acceleration.clone().unwrap(), velocity, sign, vec![1.0; force.len()]];
    let fit = least_squares(&columns, &force, &blocks(force.len()));
    let relative = 100.0 * fit.rmse / rms(force.iter().copied());
    println!("{preparation}\n{:?}, relative error {relative:.3} %", fit.coefficients);
    for (found, published) in fit.coefficients.iter().zip([95.1, 203.5, 20.39, -3.165]) {
        assert!((found / published - 1.0).abs() < 0.03, "{found} against {published}");
    }
    assert!((relative - 4.08).abs() < 0.15, "{relative}");
}

/// Without any law given, at the rate that the filter chooses, the mass still comes out.
#[test]
fn emps_mass_comes_out_beside_a_bending_friction_law() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::default();
    let train = load(&folder.join("emps/train.csv"), &joint);
    let preparation = Preparation::plan(&[&train], &joint, &Request::default()).unwrap();
    let samples = prepare(&train, &preparation).unwrap();
    let separation = separate(&samples, &joint).unwrap();
    println!("{preparation}\n{:?}", separation.parameters);
    let mass = separation.parameters.iter().find(|p| p.kind == TermKind::Inertia).unwrap();
    assert!((mass.value / 95.1 - 1.0).abs() < 0.01, "{mass:?}");
    let offset = separation.parameters.iter().find(|p| p.kind == TermKind::TorqueOffset).unwrap();
    assert!((offset.value / -3.165 - 1.0).abs() < 0.1, "{offset:?}");
    // Inertia is the whole rigid body of this axis: what is left stays on the side of its velocity.
    let velocity = samples.velocity.as_deref().unwrap();
    let power: f64 = separation.friction.iter().zip(velocity).map(|(f, v)| f * v).sum();
    assert!(power > 0.0);
}

/// The hand-made linear model of the same terms reaches 385 N m on the unseen trajectory.
#[test]
fn kr300_axis_3_predicts_an_unseen_trajectory() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::default();
    let [a, b, test] = ["A", "B", "C"].map(|run| load(&folder.join(format!("kr300/axis3-{run}.csv")), &joint));
    let preparation = Preparation::plan(&[&a, &b], &joint, &Request::default()).unwrap();
    let parts = [&a, &b].map(|recording| prepare(recording, &preparation).unwrap());
    let samples = Samples::join(parts.into()).unwrap();
    let columns = |samples: &Samples| {
        let velocity = samples.velocity.clone().unwrap();
        // Friction of this axis turns over within a milliradian per second.
        let sign = velocity.iter().map(|v| (v / 0.001).tanh()).collect();
        let ones = vec![1.0; velocity.len()];
        [samples.rigid_body.clone().unwrap(), samples.acceleration.clone().unwrap(), velocity, sign, ones]
    };
    let fit = least_squares(&columns(&samples), samples.actuator.as_ref().unwrap(), &blocks(samples.len()));
    let rows = prepare_every_row(&test, &preparation).unwrap();
    assert_eq!(rows.len(), test.len());
    let recorded = &test.actuator().unwrap().values;
    let by_row = columns(&rows);
    let predicted = |row: usize| by_row.iter().zip(&fit.coefficients).map(|(column, c)| c * column[row]).sum::<f64>();
    let rmse = rms((0..rows.len()).map(|row| recorded[row] - predicted(row)));
    println!("{preparation}\n{:?}, {rmse:.1} N m on C", fit.coefficients);
    assert!(rmse < 385.0, "{rmse}");
}

#[test]
fn every_recording_loads() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::parse("[drive]\ncounts_per_turn = 8192").unwrap();
    let mut loaded = 0;
    for kind in std::fs::read_dir(&folder).unwrap() {
        let kind = kind.unwrap().path();
        if !kind.is_dir() {
            continue;
        }
        for file in std::fs::read_dir(&kind).unwrap() {
            let path = file.unwrap().path();
            let is_recording = path.extension().is_some_and(|e| e == "csv") && !path.ends_with("runs.csv");
            if is_recording {
                let recording = load(&path, &joint);
                assert!(recording.len() > 1000 && recording.content_hash != 0);
                look(&recording, &joint);
                loaded += 1;
            }
        }
    }
    assert!(loaded > 40, "{loaded}");
}

/// Walks a recording as far as its columns allow, and says what comes out.
fn look(recording: &Recording, joint: &Joint) {
    let label = &recording.label;
    let preparation = match Preparation::plan(&[recording], joint, &Request::default()) {
        Ok(preparation) => preparation,
        Err(error) => {
            assert_eq!(error.exit_status(), 3);
            return println!("{error}");
        }
    };
    let samples = prepare(recording, &preparation).unwrap();
    assert_eq!(samples.segments.last().unwrap().end, samples.len());
    println!("{label}: {preparation}; {} samples at {:?} Hz", samples.len(), samples.rate_hz);
    let friction = match (&samples.friction, separate(&samples, joint)) {
        (Some(friction), _) => friction.clone(),
        (None, Ok(separation)) => {
            for p in &separation.parameters {
                print!(" {} {:.4} +- {:.4};", p.kind.name(), p.value, p.standard_error);
            }
            println!(" rmse {:.4} lost rank {}", separation.rmse, separation.rank_deficiency);
            separation.friction
        }
        (None, Err(error)) => return println!(" {error}"),
    };
    for row in relevance(&samples, &friction).unwrap() {
        let mark = if row.picked { '*' } else { ' ' };
        println!("  {mark} {:<22} {:>8.4} {:>8.4} {:>8.4}", row.input, row.correlation, row.explained, row.added);
        assert!(row.correlation.abs() <= 1.0 + 1e-9 && row.explained <= 1.0 && row.added <= 1.0);
    }
}

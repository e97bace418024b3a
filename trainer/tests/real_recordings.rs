//! Other people's recordings, read from `../shared/recordings`: every one loads, and published figures come back.

use std::path::{Path, PathBuf};

use frikan_trainer::joint::Joint;
use frikan_trainer::recording::{self, Recording};
use frikan_trainer::samples::regression::least_squares;
use frikan_trainer::samples::rigid_body::{TermKind, separate};
use frikan_trainer::samples::{Preparation, Request, Samples, prepare, prepare_every_row};

/// The folder of recordings; `None`, said aloud, where it is absent. In CI its absence is a failure.
fn recordings() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/recordings");
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var_os("CI").is_none(), "{} is absent", folder.display());
    eprintln!("skipped: {} is absent", folder.display());
    None
}

fn load(path: &Path, joint: &Joint) -> Recording {
    recording::load(path, joint).unwrap_or_else(|error| panic!("{error}"))
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), x| (sum + x * x, count + 1));
    (sum / count as f64).sqrt()
}

#[test]
fn emps_gives_the_published_parameters() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::default();
    let train = load(&folder.join("emps/train.csv"), &joint);
    for rate_hz in [None, Some(100.0)] {
        let preparation = Preparation::plan(&[&train], &joint, &Request { rate_hz, ..Request::default() }).unwrap();
        let samples = prepare(&train, &preparation).unwrap();
        println!("{preparation}; {:?} Hz, {} samples", samples.rate_hz, samples.len());
        let velocity = samples.velocity.clone().unwrap();
        let force = samples.actuator.clone().unwrap();
        let columns = [
            samples.acceleration.clone().unwrap(),
            velocity.clone(),
            velocity.iter().map(|v| v.signum()).collect(),
            vec![1.0; velocity.len()],
        ];
        let fit = least_squares(&columns, &force, &[0..velocity.len()]);
        let relative = 100.0 * rms(fit.residuals.iter().copied()) / rms(force.iter().copied());
        println!("{:?} relative error {relative:.3} %", fit.coefficients);
        for (found, published) in fit.coefficients.iter().zip([95.1, 203.5, 20.39, -3.165]) {
            assert!((found / published - 1.0).abs() < 0.03, "{found} against {published}");
        }
        if rate_hz.is_some() {
            assert!((relative - 4.08).abs() < 0.15, "{relative}");
        }
        let separation = separate(&samples, &joint).unwrap();
        for p in &separation.parameters {
            println!("{:?} {} +- {}", p.kind, p.value, p.standard_error);
        }
        println!("flexible rel {}", 100.0 * separation.rmse / rms(force.iter().copied()));
        let mass = separation.parameters.iter().find(|p| p.kind == TermKind::Inertia).unwrap();
        assert!((mass.value / 95.1 - 1.0).abs() < 0.03, "{mass:?}");
    }
}

#[test]
fn kr300_axis_3_predicts_an_unseen_trajectory() {
    let Some(folder) = recordings() else { return };
    let joint = Joint::default();
    let train: Vec<Recording> =
        ["A", "B"].iter().map(|t| load(&folder.join(format!("kr300/axis3-{t}.csv")), &joint)).collect();
    let test = load(&folder.join("kr300/axis3-C.csv"), &joint);
    let preparation = Preparation::plan(&train.iter().collect::<Vec<_>>(), &joint, &Request::default()).unwrap();
    let samples = Samples::join(train.iter().map(|r| prepare(r, &preparation).unwrap()).collect()).unwrap();
    println!("{preparation}; {:?} Hz, {} samples", samples.rate_hz, samples.len());
    let columns = |s: &Samples| {
        let v = s.velocity.clone().unwrap();
        let sign = v.iter().map(|v| (v / 0.01).tanh()).collect();
        let offset = vec![1.0; v.len()];
        vec![s.rigid_body.clone().unwrap(), s.acceleration.clone().unwrap(), v, sign, offset]
    };
    let fit = least_squares(&columns(&samples), samples.actuator.as_ref().unwrap(), &[0..samples.len()]);
    let rows = prepare_every_row(&test, &preparation).unwrap();
    let recorded = &test.actuator().unwrap().values;
    let prediction = columns(&rows);
    let rmse = rms((0..rows.len())
        .map(|i| recorded[i] - prediction.iter().zip(&fit.coefficients).map(|(column, c)| c * column[i]).sum::<f64>()));
    println!("{:?} rmse on C {rmse:.1} N m", fit.coefficients);
    let separation = separate(&samples, &joint).unwrap();
    for p in &separation.parameters {
        println!("{:?} {} +- {}", p.kind, p.value, p.standard_error);
    }
    assert!(rmse < 395.0);
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
                loaded += 1;
            }
        }
    }
    assert!(loaded > 40, "{loaded}");
}

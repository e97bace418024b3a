//! What a diagnosis tells of the model that it writes, computed again from what `trainer predict` writes on the same rows.

use std::path::Path;

use frikan_tests::command::called;
use frikan_tests::table::columns;
use serde_json::Value;

const ELBOW: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/elbow.toml");

fn is_sealed(time: f64, when_s: &[[f64; 2]]) -> bool {
    when_s.iter().any(|[from, to]| (*from..=*to).contains(&time))
}

/// Root mean square of the residuals of a model at rows within stretches of time, and the number of these rows.
fn residual_rmse(folder: &Path, model: &str, when_s: &[[f64; 2]]) -> (f64, usize) {
    called(folder, &format!("predict {model} real.csv --joint joint.toml -o predicted.csv --quiet"));
    let rows = columns(&folder.join("predicted.csv"), ["time_s", "residual_Nm"]);
    let sealed = rows.iter().filter(|[time, _]| is_sealed(*time, when_s));
    let squares: Vec<f64> = sealed.map(|[_, residual]| residual * residual).collect();
    ((squares.iter().sum::<f64>() / squares.len() as f64).sqrt(), squares.len())
}

/// What a diagnosis tells of its sealed rows, and the stretches that they lie in.
fn sealed(folder: &Path, arguments: &str) -> (Value, Vec<[f64; 2]>) {
    called(folder, &format!("diagnose real.csv --joint joint.toml {arguments} --json told.json --quiet"));
    let told: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("told.json")).unwrap()).unwrap();
    let when_s = serde_json::from_value(told["sealed"]["when_s"].clone()).unwrap();
    (told["sealed"].clone(), when_s)
}

#[test]
fn the_error_of_a_written_model_is_that_of_its_predictions_on_rows_that_decided_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::copy(ELBOW, at.join("joint.toml")).unwrap();
    called(at, "simulate joint.toml --effect position_ripple=2 --duration 60 --seed 11 -o real.csv --quiet");
    called(at, "fit real.csv --joint joint.toml --inputs velocity -o law.frk --quiet --steps 30 --restarts 1");
    let (sealed, when_s) = sealed(at, "--model law.frk -o improved.frk");
    assert!(when_s.len() >= 5, "{sealed}");
    for (model, side) in [("law.frk", "before"), ("improved.frk", "after")] {
        let (rmse, rows) = residual_rmse(at, model, &when_s);
        assert_eq!(sealed["n"], rows, "{model}");
        let claimed = sealed[side]["rmse"].as_f64().unwrap();
        assert!((rmse - claimed).abs() < 1e-6 * claimed, "{model}: {rmse} for {claimed}");
    }
    let [ratio, low, high] = [&sealed["ratio"], &sealed["ci95"][0], &sealed["ci95"][1]].map(|v| v.as_f64().unwrap());
    assert!(low < ratio && ratio < high && high < 1.0, "{sealed}");
}

/// At rest friction is anything within break-away, and a model of moving friction is neither wrong nor right.
#[test]
fn no_sealed_row_is_one_at_which_the_joint_rests() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::copy(ELBOW, at.join("joint.toml")).unwrap();
    called(at, "simulate joint.toml --effect presliding=1 --duration 60 --seed 7 -o real.csv --quiet");
    let (_, when_s) = sealed(at, "-o improved.frk");
    let rows = columns(&at.join("real.csv"), ["time_s", "position_rad"]);
    let rests = |pair: &&[[f64; 2]]| pair[0][1] == pair[1][1];
    assert!(rows.windows(2).filter(rests).count() > 500, "the joint of this recording rests");
    let sealed: Vec<&[[f64; 2]]> = rows.windows(2).filter(|pair| is_sealed(pair[0][0], &when_s)).collect();
    assert!(sealed.len() > 200, "{}", sealed.len());
    let rest: Vec<f64> = sealed.into_iter().filter(rests).map(|pair| pair[0][0]).collect();
    assert!(rest.is_empty(), "at rest: {rest:?}");
}

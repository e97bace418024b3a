//! What a diagnosis tells of the model that it writes, computed again from what `trainer predict` writes on the same rows.

use std::path::Path;

use frikan_tests::command::run;
use serde_json::Value;

const ELBOW: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/elbow.toml");

fn called(folder: &Path, arguments: &str) {
    let words: Vec<&str> = arguments.split_whitespace().collect();
    let done = run(folder, &words);
    assert!(done.status <= 1, "{arguments}: {}", done.messages);
}

/// Root mean square of the residuals of a model at rows within stretches of time, and the number of these rows.
fn residual_rmse(folder: &Path, model: &str, when_s: &[[f64; 2]]) -> (f64, usize) {
    called(folder, &format!("predict {model} real.csv --joint joint.toml -o predicted.csv --quiet"));
    let mut table = csv::Reader::from_path(folder.join("predicted.csv")).unwrap();
    let place = |name: &str, header: &csv::StringRecord| header.iter().position(|column| column == name).unwrap();
    let header = table.headers().unwrap().clone();
    let (time, residual) = (place("time_s", &header), place("residual_Nm", &header));
    let rows = table.records().map(|row| {
        let row = row.unwrap();
        [time, residual].map(|column| row[column].parse::<f64>().unwrap())
    });
    let sealed: Vec<f64> = rows
        .filter(|[time, _]| when_s.iter().any(|[from, to]| (*from..=*to).contains(time)))
        .map(|[_, residual]| residual * residual)
        .collect();
    ((sealed.iter().sum::<f64>() / sealed.len() as f64).sqrt(), sealed.len())
}

#[test]
fn the_error_of_a_written_model_is_that_of_its_predictions_on_rows_that_decided_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::copy(ELBOW, at.join("joint.toml")).unwrap();
    called(at, "simulate joint.toml --effect position_ripple=2 --duration 60 --seed 11 -o real.csv --quiet");
    called(at, "fit real.csv --joint joint.toml --inputs velocity -o law.frk --quiet --steps 30 --restarts 1");
    called(at, "diagnose real.csv --model law.frk --joint joint.toml -o improved.frk --json told.json --quiet");
    let told: Value = serde_json::from_str(&std::fs::read_to_string(at.join("told.json")).unwrap()).unwrap();
    let sealed = &told["sealed"];
    let when_s: Vec<[f64; 2]> = serde_json::from_value(sealed["when_s"].clone()).unwrap();
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

//! `trainer loop` on the command line: on the host and on an emulated drive, image swaps, bad input.

use std::path::Path;

use frikan_tests::command::run;
use frikan_tests::{fixtures, models};
use serde_json::Value;

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let joint = fixtures::folder().join("elbow.toml").display().to_string();
    let line = [&["loop", joint.as_str(), "--json", "--quiet"], arguments].concat();
    let run = run(folder, &line);
    assert_eq!(run.status, 0, "{} {}", run.output, run.messages);
    serde_json::from_str(&run.output).unwrap()
}

#[test]
fn an_emulated_drive_moves_the_joint_as_the_host_does_bit_for_bit_across_image_swaps() {
    // The firmware is found from inside the checkout.
    let folder = fixtures::folder();
    let fitted = fixtures::folder().join("elbow.frk").display().to_string();
    let line = ["--motion", "sine", "--adapt", "--duration", "6", "--swap-image", fitted.as_str(), "--swap-at", "3"];
    let on_host = json(&folder, &line);
    let on_target = json(&folder, &[&line[..], &["--target", "cortex-m4f"]].concat());
    assert_eq!(on_host["trace_crc32"], on_target["trace_crc32"], "{on_host} {on_target}");
    assert_eq!((&on_host["instructions"], &on_target["target"]), (&Value::Null, &"cortex-m4f".into()));
    assert_eq!(on_target["status"]["active"], on_target["steps"]);
    let most = on_target["instructions"]["max"].as_u64().unwrap();
    assert!((100..2000).contains(&most), "{on_target}");
    let unswapped = json(&folder, &line[..5]);
    assert_ne!(unswapped["trace_crc32"], on_host["trace_crc32"]);
    let level = unswapped["correction"]["level"].as_f64().unwrap();
    assert!((level - 1.0).abs() < 0.05 && level != 1.0, "{unswapped}");
    let fixed = json(&folder, &["--motion", "sine", "--duration", "6"]);
    assert_eq!(fixed["correction"]["level"], 1.0);
}

#[test]
fn the_trace_is_a_recording_and_the_page_tells_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let result = json(folder.path(), &["--duration", "4", "-o", "trace.csv", "--report", "page.html"]);
    let ratio =
        result["uncompensated"]["rms_error"].as_f64().unwrap() / result["compensated"]["rms_error"].as_f64().unwrap();
    assert!(ratio > 4.0, "{result}");
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains(&format!("CRC-32 {}", result["trace_crc32"].as_str().unwrap())), "{page:.2000}");
    // The trace is read, and followed again.
    let again = json(folder.path(), &["--motion", "trace.csv"]);
    assert_eq!((again["motion"].as_str(), again["steps"].as_u64()), (Some("recorded"), result["steps"].as_u64()));
    let error = |of: &Value| of["compensated"]["rms_error"].as_f64().unwrap();
    assert!((error(&again) / error(&result) - 1.0).abs() < 0.2, "{result} {again}");
}

#[test]
fn a_hidden_effect_is_that_of_the_recording_with_the_same_seed() {
    let folder = tempfile::tempdir().unwrap();
    let line = |seed| ["--duration", "2", "--effect", "position_ripple=2", "--seed", seed];
    let [first, second] = ["1", "2"].map(|seed| json(folder.path(), &line(seed)));
    assert_eq!(first["trace_crc32"], json(folder.path(), &line("1"))["trace_crc32"]);
    assert_ne!(first["trace_crc32"], second["trace_crc32"]);
}

#[test]
fn what_cannot_be_run_is_refused_by_name_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let joint = fixtures::folder().join("elbow.toml").display().to_string();
    std::fs::write(folder.path().join("no.frk"), b"no image").unwrap();
    for (arguments, status, words) in [
        (&["--motion", "waltz"][..], 2, "reversals"),
        (&["--friction-scale=-1"], 2, "--friction-scale"),
        (&["--gain=-1"], 2, "gain"),
        (&["--duration", "1e9"], 2, "samples"),
        (&["--image", "no.frk"], 3, "no.frk"),
    ] {
        let line = [&["loop", joint.as_str(), "-o", "trace.csv"], arguments].concat();
        let run = run(folder.path(), &line);
        assert!(run.status == status && run.messages.contains(words), "{arguments:?}: {} {}", run.status, run.messages);
        assert!(!folder.path().join("trace.csv").exists());
    }
}

/// Position loop, table with one presliding element, monitor and plausibility; the first sample works out what the sample period gives.
#[test]
fn a_sample_of_the_whole_drive_stays_within_its_budget_on_cortex_m4f() {
    let folder = tempfile::tempdir().unwrap();
    let mut models = models::with_every_effect().into_iter();
    let (_, model) = models.find(|(name, _)| name == "table of 1 inputs with one element").unwrap();
    std::fs::write(folder.path().join("model.frk"), models::image(&model)).unwrap();
    for (more, budget) in [(&[][..], 860), (&["--adapt"], 1010)] {
        let line = ["--image", "model.frk", "--motion", "sine", "--duration", "4", "--target", "cortex-m4f"];
        let run = json(folder.path(), &[&line[..], more].concat());
        let most = run["instructions"]["max"].as_u64().unwrap();
        assert!(most <= budget, "{more:?}: {}", run["instructions"]);
    }
}

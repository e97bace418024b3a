//! A law from a recording: its constants with their intervals, and the friction as a drive computes it.
//!
//! ```sh
//! cargo run -p frikan-trainer --example law -- fixtures/stribeck.csv
//! ```

use std::fmt::Write as _;
use std::path::Path;

use frikan_runtime::evaluate::evaluate;
use frikan_runtime::shared::model::MAX_INPUTS;
use frikan_trainer::error::Result;
use frikan_trainer::fit::{Options, model};
use frikan_trainer::joint::Joint;

/// What a fit of the recording tells; `joint` is its joint file, where there is one.
fn law_of(recording: &Path, joint: Option<&Path>) -> Result<String> {
    let joint = joint.map_or_else(|| Ok(Joint::default()), Joint::load)?;
    let fitted = frikan_trainer::fit(&[recording.into()], &[], &joint, &Options::default(), &|_| {})?;
    let outcome = &fitted.outcome;
    let mut told = format!("friction = {}\n", outcome.law.expression);
    for parameter in &outcome.parameters {
        let [low, high] = parameter.ci95;
        // Writing to a string cannot fail.
        let _ =
            writeln!(told, "{:.4} {} <- {} in [{low:.4}, {high:.4}]", parameter.value, parameter.unit, parameter.name);
    }
    // The bytes that `trainer fit -o` writes, and a drive reads; the first input is the velocity.
    let image = model::from_bytes(&outcome.image)?;
    for velocity in [-0.5, -0.1, 0.1, 0.5] {
        let mut inputs = [0.0; MAX_INPUTS];
        inputs[0] = velocity;
        let _ = writeln!(told, "{:.4} {} at {velocity} rad/s", evaluate(&image.model, &inputs), outcome.unit);
    }
    Ok(told)
}

fn main() -> Result<()> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [recording, joint @ ..] = files.as_slice() else {
        eprintln!("law RECORDING [JOINT.toml]");
        return Ok(());
    };
    print!("{}", law_of(recording.as_ref(), joint.first().map(Path::new))?);
    Ok(())
}

#[test]
fn the_published_law_is_told() {
    let told = law_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/stribeck.csv"), None).unwrap();
    assert!(
        told.starts_with("friction = ") && told.contains("coulomb_torque") && told.contains("N m at 0.5 rad/s"),
        "{told}"
    );
}

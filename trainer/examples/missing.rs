//! What a simulation leaves out of a recording. Both are made here, of a joint whose contact bends before it slides and of one whose contact
//! does not; yours come from files (`"real.csv".into()`).
//!
//! ```sh
//! cargo run -p frikan-trainer --example missing -- fixtures/elbow.toml
//! ```

use std::path::Path;

use frikan_trainer::error::Result;
use frikan_trainer::joint::Joint;
use frikan_trainer::plant::{self, Hidden};
use frikan_trainer::workflow::Source;
use frikan_trainer::workflow::diagnose::{Against, Diagnosed, Request};

/// The diagnosis of a joint with presliding beside a simulation without it.
fn compared(joint: &Path) -> Result<Diagnosed> {
    let joint = Joint::load(joint)?;
    let mut simulated = plant::Joint::described_by(&joint)?;
    simulated.campaign.trajectories.truncate(4);
    let mut real = simulated.clone();
    real.effects.push(Hidden { name: "presliding".to_owned(), amplitude: 1.0 });
    let [real, simulated] =
        [(real, 7), (simulated, 8)].map(|(joint, seed)| plant::simulate(&joint, seed).map(|r| r.to_csv()));
    let (real, simulated) = (real?, simulated?);

    let real = Source::Bytes { label: "real.csv", bytes: real.as_bytes() };
    let simulated = Source::Bytes { label: "simulated.csv", bytes: simulated.as_bytes() };
    let request = Request::of(&[real], Against::Simulation(simulated));
    frikan_trainer::diagnose(&request, &joint, &|stage| eprintln!("{stage}"))
}

fn main() -> Result<()> {
    let Some(joint) = std::env::args().nth(1) else {
        eprintln!("missing JOINT.toml");
        return Ok(());
    };
    let found = compared(joint.as_ref())?;
    print!("{}", found.text());
    for finding in &found.diagnosis.findings {
        println!("{}: probability {:.2}", finding.effect.name(), finding.probability);
    }
    if let Some(image) = found.image() {
        println!("the improved model has {} bytes", image.len());
    }
    Ok(())
}

#[test]
fn what_was_hidden_is_named() {
    let found = compared(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/elbow.toml")).unwrap();
    let named: Vec<&str> = found.diagnosis.findings.iter().map(|finding| finding.effect.name()).collect();
    assert_eq!(named, ["presliding"]);
}

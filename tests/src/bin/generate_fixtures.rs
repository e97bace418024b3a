//! Writes the generated part of `fixtures/`: `generate_fixtures recordings FOLDER` or `generate_fixtures bits FOLDER`.

use std::path::Path;
use std::process::ExitCode;

use frikan_tests::fixtures::{output_bits, separated_recording};
use frikan_tests::paper::JOINTS;
use frikan_trainer::error::Result;
use frikan_trainer::files::write_whole;
use frikan_trainer::fit::model;

fn recordings(folder: &Path) -> Result<()> {
    for (name, seed) in [("stribeck.csv", 1), ("stribeck-test.csv", 2)] {
        write_whole(&folder.join(name), separated_recording(JOINTS[0], 1000, seed).as_bytes())?;
    }
    Ok(())
}

fn bits(folder: &Path) -> Result<()> {
    for name in ["elbow", "stribeck", "integers"] {
        let (_, image) = model::load(&folder.join(name).with_extension("frk"))?;
        write_whole(&folder.join(name).with_extension("bits"), output_bits(&image.model).as_bytes())?;
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["recordings", folder] => recordings(Path::new(folder)),
        ["bits", folder] => bits(Path::new(folder)),
        _ => {
            eprintln!("generate_fixtures (recordings|bits) FOLDER");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_status())
        }
    }
}

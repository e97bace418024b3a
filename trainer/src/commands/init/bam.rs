//! A servo from the parameters that BAM knows of it: joint.toml, and its friction as an image.

use std::path::Path;

use super::super::output::{Outputs, say};
use super::Init;
use crate::bam::{Parameters, Surroundings, image, joint_file};
use crate::error::{Error, Result, codes};
use crate::files::read_text;
use crate::fit::model;
use crate::joint::{Joint, Payload};

/// Largest file of parameters that is read, in bytes.
const SIZE_LIMIT_BYTES: u64 = 1 << 20;

/// The text of a parameter file of BAM; `None` where the path names anything else.
pub(super) fn text(path: &Path) -> Result<Option<String>> {
    let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    if !is_json {
        return Ok(None);
    }
    Ok(Some(read_text(path, SIZE_LIMIT_BYTES)?).filter(|text| Parameters::are_in(text)))
}

/// Writes joint.toml and the image, as far as they are asked for.
pub(super) fn run(arguments: &Init, path: &Path, text: &str) -> Result<()> {
    let in_file = |error: Error| error.in_file(path.display().to_string());
    let parameters = Parameters::parse(text).map_err(in_file)?;
    let surroundings = surroundings(arguments)?;
    let (variant, actuator) = (parameters.variant.name(), &parameters.actuator);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let title = format!("Rhoban's BAM, friction model {variant} of the actuator {actuator:?}, from {name:?}");
    let (toml, remarks) = joint_file(&parameters, &surroundings, &title);
    Joint::parse(&toml)?;
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, toml);
    if let Some(path) = &arguments.image {
        let image = image(&parameters, &surroundings).map_err(in_file)?;
        outputs.add(path, model::to_bytes(&image)?);
    }
    outputs.write()?;
    if !arguments.quiet {
        say(&title);
        remarks.iter().for_each(|remark| say(&format!("  {remark}")));
    }
    Ok(())
}

fn surroundings(arguments: &Init) -> Result<Surroundings> {
    let refused = |name: &str, value: f64, rule: &str| {
        Err(Error::new(&codes::USAGE, format!("`{name}` has to be a finite number {rule}"))
            .with_value(value.to_string()))
    };
    for (name, value) in [("--supply", arguments.supply), ("--firmware-kp", arguments.firmware_kp)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return refused(name, value, "above zero");
        }
    }
    for (name, value) in [("--payload-kg", arguments.payload_kg), ("--payload-m", arguments.payload_m)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
            return refused(name, value, "of at least zero");
        }
    }
    let payload = arguments.payload_kg.zip(arguments.payload_m);
    let payload = payload.map(|(mass_kg, distance_m)| Payload { mass_kg, distance_m, phase_rad: 0.0 });
    Ok(Surroundings { supply: arguments.supply, firmware_kp: arguments.firmware_kp, payload })
}

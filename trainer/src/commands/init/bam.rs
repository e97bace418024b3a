//! A servo from the parameters that BAM knows of it: joint.toml, and its friction as an image.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::output::{Outputs, say};
use crate::bam::{Parameters, Surroundings, image, joint_file};
use crate::error::{Error, Result, codes};
use crate::files::read_text;
use crate::fit::model;
use crate::joint::{Joint, Payload};

/// Largest file of parameters that is read, in bytes.
const SIZE_LIMIT_BYTES: u64 = 1 << 20;

/// What goes with a parameter file of BAM.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub struct OfBam {
    /// Of a parameter file of BAM: also write its friction, with the armature, as an image
    #[arg(long, value_name = "MODEL.frk")]
    pub image: Option<PathBuf>,
    /// Of a parameter file of BAM: supply voltage of the servo, V
    #[arg(long, value_name = "V")]
    pub supply: Option<f64>,
    /// Of a parameter file of BAM: gain of the firmware as it counts it
    #[arg(long, value_name = "GAIN")]
    pub firmware_kp: Option<f64>,
    /// Of a parameter file of BAM: mass that hangs at the joint, kg; its gravity is the torque from outside
    #[arg(long, value_name = "KG", requires = "payload_m")]
    pub payload_kg: Option<f64>,
    /// How far from the axis, m
    #[arg(long, value_name = "M", requires = "payload_kg")]
    pub payload_m: Option<f64>,
}

/// The text of a parameter file of BAM; `None` where the path names anything else.
pub(super) fn text(path: &Path) -> Result<Option<String>> {
    let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    if !is_json {
        return Ok(None);
    }
    Ok(Some(read_text(path, SIZE_LIMIT_BYTES)?).filter(|text| Parameters::are_in(text)))
}

/// Writes joint.toml and the image, as far as they are asked for.
pub(super) fn run(options: &OfBam, (path, text): (&Path, &str), output: &Path, quiet: bool) -> Result<()> {
    let in_file = |error: Error| error.in_file(path.display().to_string());
    let parameters = Parameters::parse(text).map_err(in_file)?;
    let surroundings = surroundings(options)?;
    let (variant, actuator) = (parameters.variant.name(), &parameters.actuator);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let title = format!("Rhoban's BAM, friction model {variant} of the actuator {actuator:?}, from {name:?}");
    let (toml, remarks) = joint_file(&parameters, &surroundings, &title);
    Joint::parse(&toml)?;
    let mut outputs = Outputs::default();
    outputs.add(output, toml);
    if let Some(path) = &options.image {
        let image = image(&parameters, &surroundings).map_err(in_file)?;
        outputs.add(path, model::to_bytes(&image)?);
    }
    outputs.write()?;
    if !quiet {
        say(&title);
        remarks.iter().for_each(|remark| say(&format!("  {remark}")));
    }
    Ok(())
}

fn surroundings(options: &OfBam) -> Result<Surroundings> {
    let refused = |name: &str, value: f64, rule: &str| {
        Err(Error::new(&codes::USAGE, format!("`{name}` has to be a finite number {rule}"))
            .with_value(value.to_string()))
    };
    for (name, value) in [("--supply", options.supply), ("--firmware-kp", options.firmware_kp)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return refused(name, value, "above zero");
        }
    }
    for (name, value) in [("--payload-kg", options.payload_kg), ("--payload-m", options.payload_m)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
            return refused(name, value, "of at least zero");
        }
    }
    let payload = options.payload_kg.zip(options.payload_m);
    let payload = payload.map(|(mass_kg, distance_m)| Payload { mass_kg, distance_m, phase_rad: 0.0 });
    Ok(Surroundings { supply: options.supply, firmware_kp: options.firmware_kp, payload })
}

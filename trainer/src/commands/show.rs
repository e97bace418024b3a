//! `trainer show`: what an image holds, for a reader.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use frikan_shared::authentication::Trust;
use frikan_shared::image::{FORMAT_VERSION, Image, image_crc32, image_version};
use frikan_shared::model::{Law, LawError, RIGID_BODY_CONSTANTS, RigidBodyError};

use super::output::{Outputs, refuse_unwritable};
use crate::error::Result;
use crate::export::dump::{Found, images, in_use};
use crate::export::readable::readable;
use crate::export::terms::{Term, terms};
use crate::files::read_whole;
use crate::fit::{CELLS, model};
use crate::key;
use crate::law::{Language, canonical, expression_of, render, significant};

/// Significant digits of printed figures.
const DIGITS: usize = 6;

/// Largest dump that is read: the flash of a large microcontroller.
const DUMP_LIMIT_BYTES: u64 = 16 << 20;

/// Show what an image holds: joint, inputs and ranges, law, rigid body, provenance. Or what a dump of flash holds.
#[derive(Args, Clone, Debug)]
pub struct Show {
    /// Image to show, or a dump of flash with images in it
    #[arg(value_name = "MODEL.frk|DUMP")]
    pub model: PathBuf,
    /// Say whether the image in use is this one; exit status 1 where it is not
    #[arg(long, value_name = "MODEL.frk")]
    pub compare: Option<PathBuf>,
    /// Write everything that the image says as JSON, as `export --to json` does; `-` for standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Ask for the tag of the key in this file, as the drive does
    #[arg(long, value_name = "KEY")]
    pub key_file: Option<PathBuf>,
    /// Ask for a signature by the secret of the public key in this file, as the drive does
    #[arg(long, value_name = "KEY", conflicts_with = "key_file")]
    pub public_key_file: Option<PathBuf>,
}

/// Runs the command and returns its exit status.
///
/// # Errors
/// `FRK-D020` for what holds no image, `FRK-D022` for what is no key, `FRK-I...` when a file cannot be read.
pub fn run(arguments: &Show) -> Result<u8> {
    let read = [
        Some(&arguments.model),
        arguments.compare.as_ref(),
        arguments.key_file.as_ref(),
        arguments.public_key_file.as_ref(),
    ];
    refuse_unwritable(&arguments.json, &read.into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let key = arguments.key_file.as_deref().map(key::load).transpose()?;
    let public_key = arguments.public_key_file.as_deref().map(key::public).transpose()?;
    let trust = key.as_ref().map(Trust::Key).or_else(|| public_key.as_ref().map(Trust::Signed));
    let wanted = arguments.compare.as_deref().map(model::load).transpose()?;
    let bytes = read_whole(&arguments.model, DUMP_LIMIT_BYTES)?;
    let found = images(&bytes, trust);
    if !found.iter().any(|found| found.image.is_ok()) {
        // Nothing to show: what a decoder says of the file as a whole.
        return model::from_bytes(&bytes).map(|_| 0).map_err(|e| e.in_file(arguments.model.display().to_string()));
    }
    let is_dump = found.len() > 1
        || found.iter().any(|found| found.image.as_ref().is_ok_and(|image| image.0.len() < bytes.len()));
    let mut text = String::new();
    for found in &found {
        // Writing to a string cannot fail.
        let _ = describe_found(&mut text, found, is_dump);
    }
    let in_use = in_use(&found).and_then(|found| found.image.as_ref().ok());
    let mut status = 0;
    if let (Some(path), Some((wanted, _))) = (&arguments.compare, &wanted) {
        let is_the_one = in_use.is_some_and(|(bytes, _)| bytes == wanted);
        let verdict = match (is_the_one, in_use) {
            (true, _) => "this is the image of",
            (false, Some(_)) => "this is NOT the image of",
            (false, None) => "no image is in use, not that of",
        };
        let _ = writeln!(text, "verdict     {verdict} {}", path.display());
        status = u8::from(!is_the_one);
    }
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.json {
        // A dump without an image in use shows the first that it holds.
        let shown = in_use.or_else(|| found.iter().find_map(|found| found.image.as_ref().ok()));
        outputs.add(path, shown.map_or_else(String::new, |(bytes, image)| readable(bytes, image)));
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        outputs.add(Path::new("-"), text);
    }
    outputs.write().map(|()| status)
}

/// One image, or what is wrong with it; in a dump, where it lies.
fn describe_found(out: &mut String, found: &Found<'_>, is_dump: bool) -> std::fmt::Result {
    if is_dump {
        let slot =
            found.sequence.map_or_else(String::new, |sequence| format!(", in an intact slot, sequence {sequence}"));
        writeln!(out, "found       at byte {:#x} of the dump{slot}", found.offset)?;
    }
    match &found.image {
        Ok((bytes, image)) => describe(out, bytes, image)?,
        Err(error) => writeln!(out, "image       refused: {error}")?,
    }
    match found.authentic {
        Some(true) if found.release > 0 => writeln!(out, "tag         authentic, release {}", found.release),
        Some(true) => writeln!(out, "tag         authentic"),
        Some(false) => writeln!(out, "tag         NOT authentic: the drive refuses this image"),
        None => Ok(()),
    }
}

/// A correction term: its equation, its parameters, and what it remembers.
fn describe_term(out: &mut String, term: &Term) -> std::fmt::Result {
    let figure = |value: f32| significant(f64::from(value), DIGITS);
    writeln!(out, "effect      {}: {}", term.effect, term.equation)?;
    for parameter in &term.parameters {
        writeln!(out, "            {} {} {}", parameter.name, figure(parameter.value), parameter.unit)?;
    }
    if let Some(channel) = term.distance_from {
        let distance = if channel == "position" { "the change of the position" } else { "velocity times period" };
        writeln!(out, "            dq is {distance}")?;
    }
    for state in &term.state {
        let range =
            state.range.map_or_else(String::new, |[low, high]| format!(", {} to {}", figure(low), figure(high)));
        writeln!(out, "            remembers the {} in {}{range}", state.name, state.unit)?;
    }
    Ok(())
}

fn describe(out: &mut String, bytes: &[u8], image: &Image<CELLS>) -> std::fmt::Result {
    let (model, provenance) = (&image.model, &image.provenance);
    let joint = if provenance.joint.is_empty() { "(unnamed)" } else { provenance.joint.as_str() };
    writeln!(out, "joint       {joint}")?;
    for input in &model.inputs {
        let (low, high) = (significant(f64::from(input.low), DIGITS), significant(f64::from(input.high), DIGITS));
        let name = input.quantity.name();
        writeln!(
            out,
            "input       {name} from {low} to {high} {}, held at the nearer end outside",
            input.unit.symbol()
        )?;
    }
    let unit = model.output_unit.symbol();
    writeln!(out, "output      {unit}, at most {}", significant(f64::from(model.output_limit), DIGITS))?;
    match &model.law {
        Law::Geometric(table) => {
            writeln!(out, "law         table of {} cubic cells that grow from zero", table.cells())?
        }
        Law::Uniform(table) => writeln!(out, "law         table of {} equal cubic cells", table.cells)?,
        Law::IntegerTable(table) => writeln!(out, "law         integer table of {} cubic cells", table.cells())?,
        Law::Network(network) => writeln!(
            out,
            "law         network of {} inputs and {} hidden nodes, its edges integer tables",
            network.sources().len(),
            network.layers().iter().map(|layer| layer.nodes()).sum::<usize>()
        )?,
        Law::Expression(program) => {
            let names: Vec<&str> = model.inputs.iter().map(|input| input.quantity.name()).collect();
            let expression = expression_of(program).map(|e| render(&canonical(&e), Language::Unicode, &names));
            writeln!(out, "law         {}", expression.as_deref().unwrap_or("a program that no formula says"))?;
            writeln!(out, "            {} operations", program.operations.len())?;
        }
    }
    for term in terms(model) {
        describe_term(out, &term)?;
    }
    let body = model.rigid_body;
    let constants = [
        ("inertia", body.inertia),
        ("gravity, sine", body.gravity_sin),
        ("gravity, cosine", body.gravity_cos),
        ("offset", body.offset),
        ("scale of a given torque", body.given_scale),
    ];
    for ((name, value), error) in constants.into_iter().zip(standard_errors(provenance.rigid_body_error)) {
        let error = if error > 0.0 { format!(" +- {}", significant(error, DIGITS)) } else { String::new() };
        if value != 0.0 {
            writeln!(out, "rigid body  {name} {}{error}", significant(f64::from(value), DIGITS))?;
        }
    }
    let LawError { slow, sliding } = provenance.law_error;
    if slow.max(sliding) > 0.0 {
        let [slow, sliding] = [slow, sliding].map(|error| significant(f64::from(error), DIGITS));
        writeln!(
            out,
            "law error   {sliding} {unit} sliding, {slow} {unit} slower, beside the noise of the recordings"
        )?;
    }
    writeln!(
        out,
        "provenance  trainer {}, seed {}, recordings {:016x}",
        provenance.trainer_version, provenance.seed, provenance.recordings_hash
    )?;
    writeln!(
        out,
        "image       format {}, {} bytes, {} cells, CRC-32 {:08x}",
        image_version(bytes).unwrap_or(FORMAT_VERSION),
        bytes.len(),
        model.cells.len(),
        image_crc32(bytes).unwrap_or(0)
    )
}

/// Standard error of each constant of a rigid body.
fn standard_errors(error: RigidBodyError) -> [f64; RIGID_BODY_CONSTANTS] {
    let of =
        |constant: usize| (0..RIGID_BODY_CONSTANTS).map(|k| f64::from(error.row(k)[constant]).powi(2)).sum::<f64>();
    core::array::from_fn(|constant| of(constant).sqrt())
}

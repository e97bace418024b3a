//! `trainer show`: what an image holds, for a reader.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use frikan_shared::image::{FORMAT_VERSION, Image, image_crc32};
use frikan_shared::model::Law;

use super::output::print;
use crate::error::Result;
use crate::fit::{CELLS, model};
use crate::law::canonical::canonical;
use crate::law::program::expression_of;
use crate::law::render::significant;
use crate::law::{Language, render};

/// Significant digits of printed figures.
const DIGITS: usize = 6;

/// Show what an image holds: joint, inputs and ranges, law, rigid body, provenance.
#[derive(Args, Clone, Debug)]
pub struct Show {
    /// Image to show
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D020` for what is no image, `FRK-I...` when it cannot be read.
pub fn run(arguments: &Show) -> Result<()> {
    let (bytes, image) = model::load(&arguments.model)?;
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = describe(&mut text, &bytes, &image);
    print(&text)
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
            network.sources.len(),
            network.layers.iter().map(|layer| layer.nodes()).sum::<usize>()
        )?,
        Law::Expression(program) => {
            let names: Vec<&str> = model.inputs.iter().map(|input| input.quantity.name()).collect();
            let expression = expression_of(program).map(|e| render(&canonical(&e), Language::Unicode, "", &names));
            writeln!(out, "law         {}", expression.as_deref().unwrap_or("a program that no formula says"))?;
            writeln!(out, "            {} operations", program.operations.len())?;
        }
    }
    for effect in &model.effects {
        writeln!(out, "effect      {effect:?}")?;
    }
    let body = model.rigid_body;
    for (name, value) in [
        ("inertia", body.inertia),
        ("gravity, sine", body.gravity_sin),
        ("gravity, cosine", body.gravity_cos),
        ("offset", body.offset),
        ("scale of a given torque", body.given_scale),
    ] {
        if value != 0.0 {
            writeln!(out, "rigid body  {name} {}", significant(f64::from(value), DIGITS))?;
        }
    }
    writeln!(
        out,
        "provenance  trainer {}, seed {}, recordings {:016x}",
        provenance.trainer_version, provenance.seed, provenance.recordings_hash
    )?;
    writeln!(
        out,
        "image       format {FORMAT_VERSION}, {} bytes, {} cells, CRC-32 {:08x}",
        bytes.len(),
        model.cells.len(),
        image_crc32(bytes).unwrap_or(0)
    )
}

//! `trainer export`: an image in the form that a tool chain takes.

use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use frikan_shared::image::{Image, image_crc32};
use frikan_shared::model::Law;
use serde_json::json;

use super::output::Outputs;
use crate::error::{Error, Result, codes};
use crate::fit::{CELLS, model};
use crate::law::canonical::canonical;
use crate::law::program::expression_of;
use crate::law::{Language, render};

/// Export an image for a build or a flash tool.
#[derive(Args, Clone, Debug)]
pub struct Export {
    /// Image to export
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Form to export to
    #[arg(long, value_enum)]
    pub to: Format,
    /// First address, for `hex`
    #[arg(long, default_value = "0", value_parser = address, value_name = "ADDRESS")]
    pub address: u32,
    /// File to write; `-` for standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// A form of export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// The bytes of the image
    Bin,
    /// Intel HEX
    Hex,
    /// An array for a C compiler
    CHeader,
    /// Everything that the image says, readable
    Json,
    /// The law as a C function of doubles
    C,
    /// The law as a Rust function
    Rust,
    /// The law as a Python function over NumPy arrays
    Python,
    /// The law as a string for SymPy
    Sympy,
    /// The law in LaTeX
    Latex,
    /// The law as text
    Text,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D020` for what is no image, `FRK-I...` when a file cannot be read or written.
pub fn run(arguments: &Export) -> Result<()> {
    let (bytes, image) = model::load(&arguments.model)?;
    let content = match arguments.to {
        Format::Bin => bytes,
        Format::Hex => intel_hex(&bytes, arguments.address).into_bytes(),
        Format::CHeader => c_header(&bytes, &image).into_bytes(),
        Format::Json => readable(&bytes, &image).into_bytes(),
        Format::C => law(&image, Language::C)?,
        Format::Rust => law(&image, Language::Rust)?,
        Format::Python => law(&image, Language::Python)?,
        Format::Sympy => law(&image, Language::SymPy)?,
        Format::Latex => law(&image, Language::Latex)?,
        Format::Text => law(&image, Language::Unicode)?,
    };
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, content);
    outputs.refuse_overwriting(&[arguments.model.as_path()])?;
    outputs.write()
}

/// The law of an image, inputs by their names, without rigid body and effects.
fn law(image: &Image<CELLS>, language: Language) -> Result<Vec<u8>> {
    let Law::Expression(program) = &image.model.law else {
        let message = "the image holds a table, which has no formula; fit with `--representation expression`";
        return Err(Error::new(&codes::USAGE, message));
    };
    let expression = expression_of(program)
        .ok_or_else(|| Error::new(&codes::USAGE, "the program holds operations that no formula has"))?;
    let names: Vec<String> = image.model.inputs.iter().map(|input| identifier(input.quantity.name())).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let text = render(&canonical(&expression), language, "friction", &names);
    Ok(format!("{}\n", text.trim_end()).into_bytes())
}

/// A channel's name as every language takes it.
fn identifier(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("x_{plain}") }
}

fn address(text: &str) -> std::result::Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "an address such as 0x08060000 is expected".to_owned())
}

/// Intel HEX records of sixteen bytes with extended linear addresses (Intel 1988).
fn intel_hex(bytes: &[u8], first: u32) -> String {
    let mut text = String::new();
    let mut record = |offset: u16, kind: u8, data: &[u8]| {
        let mut fields = vec![data.len() as u8, (offset >> 8) as u8, offset as u8, kind];
        fields.extend_from_slice(data);
        let sum = fields.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
        fields.push(sum.wrapping_neg());
        text.push(':');
        for byte in fields {
            // Writing to a string cannot fail.
            let _ = write!(text, "{byte:02X}");
        }
        text.push('\n');
    };
    let mut upper = None;
    let mut at = 0usize;
    while at < bytes.len() {
        let address = u64::from(first) + at as u64;
        let high = (address >> 16) as u16;
        if upper != Some(high) {
            record(0, 4, &high.to_be_bytes());
            upper = Some(high);
        }
        // A record may not run over the end of its 64 KiB.
        let room = (0x1_0000 - (address & 0xFFFF)) as usize;
        let length = room.min(16).min(bytes.len() - at);
        record(address as u16, 0, &bytes[at..at + length]);
        at += length;
    }
    record(0, 1, &[]);
    text
}

fn c_header(bytes: &[u8], image: &Image<CELLS>) -> String {
    let mut text = String::from("/* Frikan friction image");
    if !image.provenance.joint.is_empty() {
        let joint = image.provenance.joint.replace("*/", "* /");
        let _ = write!(text, " of joint \"{}\"", joint.escape_debug());
    }
    let _ = writeln!(
        text,
        ", {} bytes, CRC-32 {:08x}. Made by `trainer export --to c-header`; do not edit. */",
        bytes.len(),
        image_crc32(bytes).unwrap_or(0)
    );
    text.push_str("#ifndef FRIKAN_IMAGE_H\n#define FRIKAN_IMAGE_H\n\n#include <stdint.h>\n\n");
    let _ = writeln!(text, "#define FRIKAN_IMAGE_BYTES {}u\n", bytes.len());
    text.push_str("static const uint8_t frikan_image[FRIKAN_IMAGE_BYTES] = {\n");
    for chunk in bytes.chunks(12) {
        text.push_str("   ");
        for byte in chunk {
            let _ = write!(text, " 0x{byte:02x},");
        }
        text.push('\n');
    }
    text.push_str("};\n\n#endif\n");
    text
}

fn readable(bytes: &[u8], image: &Image<CELLS>) -> String {
    let (model, provenance) = (&image.model, &image.provenance);
    let inputs: Vec<_> = model
        .inputs
        .iter()
        .map(|input| {
            json!({"input": input.quantity.name(), "unit": input.unit.symbol(), "low": input.low, "high": input.high})
        })
        .collect();
    let cells: Vec<[f32; 4]> = model.cells.iter().map(|cell| cell.floats()).collect();
    let body = model.rigid_body;
    let object = json!({
        "schema": "frikan.image/1",
        "joint": provenance.joint.as_str(),
        "trainer_version": provenance.trainer_version.as_str(),
        "recordings_hash": format!("{:016x}", provenance.recordings_hash),
        "seed": provenance.seed,
        "bytes": bytes.len(),
        "crc32": image_crc32(bytes).unwrap_or(0),
        "inputs": inputs,
        "output_unit": model.output_unit.symbol(),
        "output_limit": model.output_limit,
        "rigid_body": {
            "inertia": body.inertia, "gravity_sin": body.gravity_sin, "gravity_cos": body.gravity_cos,
            "offset": body.offset, "given_scale": body.given_scale,
        },
        "law": model.law,
        "effects": model.effects.as_slice(),
        "cells": cells,
    });
    format!("{object:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_records_have_their_checksum_and_cross_a_bank() {
        let text = intel_hex(&[0xAB; 20], 0x0800_FFF8);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], ":020000040800F2");
        assert!(lines[1].starts_with(":08FFF800ABAB"));
        assert_eq!(lines[2], ":020000040801F1");
        assert_eq!(lines.last(), Some(&":00000001FF"));
        for line in lines {
            let bytes: Vec<u8> =
                (1..line.len()).step_by(2).map(|i| u8::from_str_radix(&line[i..i + 2], 16).unwrap()).collect();
            assert_eq!(bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte)), 0, "{line}");
        }
    }
}

//! Law and effects of an image as a co-simulation unit of FMI 3.0 (Modelica Association 2022, FMI 3.0.2): description, C sources, and a
//! library of the platform where there is one.

mod description;

use std::io::{Cursor, Write};

use frikan_shared::image::Image;
use zip::ZipWriter;
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;

use self::description::{Description, build};
use super::source::{c, moves_link, parameters};
use crate::error::Result;
use crate::fit::CELLS;

/// The functions of FMI around `begin` and `advance`.
const FMI: &str = include_str!("fmi3.c");

/// Name of the unit of an image whose checksum is `crc32`, and so of its library and its law: two units link together.
fn identifier(crc32: u32) -> String {
    format!("joint_friction_{crc32:08x}")
}

/// A unit without library.
#[derive(Clone, Debug)]
pub struct CoSimulation {
    /// Its name.
    pub identifier: String,
    description: String,
    /// Names and texts of the sources.
    pub sources: Vec<(String, String)>,
}

/// A library for one platform.
#[derive(Clone, Debug)]
pub struct Library {
    /// Name of the platform in FMI 3.0, such as `x86_64-linux`.
    pub platform: &'static str,
    /// Its file, such as `joint_friction.so`.
    pub file: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The unit of an image whose checksum is `crc32`: the channels of the model are its inputs, the friction in the sign of the velocity and,
/// where effects move the link, the correction of the position its outputs.
///
/// # Errors
/// `FRK-U005` for an integer table.
pub fn unit(image: &Image<CELLS>, title: &str, crc32: u32) -> Result<CoSimulation> {
    let identifier = identifier(crc32);
    let c::Evaluator { header, source } = c::evaluator(&identifier, title, image)?;
    let token = format!("frikan-{crc32:08x}");
    let model = &image.model;
    let moves_link = moves_link(model);
    let names = parameters(model);
    let description = Description { identifier: &identifier, title, token: &token, model, names: &names, moves_link };
    let interface = format!(
        "/* {title}. Made by `trainer export --to fmu`; do not edit. */\n#include \"{identifier}.h\"\n\n#define TOKEN \"{token}\"\n\
         enum {{ INPUTS = {}, OUTPUTS = {} }};\n\n{}\n{FMI}",
        names.len(),
        1 + usize::from(moves_link),
        calls(&identifier, names.len(), model.effects.is_empty(), moves_link),
    );
    let sources = [(format!("{identifier}.c"), source), (format!("{identifier}.h"), header)];
    let sources = sources.into_iter().chain([("fmi3.c".to_owned(), interface)]).collect();
    Ok(CoSimulation { description: description.xml(), identifier, sources })
}

/// `begin` and `advance`: the outputs before the first step, and after one.
fn calls(identifier: &str, inputs: usize, is_static: bool, moves_link: bool) -> String {
    let values: Vec<String> = (0..inputs).map(|place| format!("(float)input[{place}]")).collect();
    let values = values.join(", ");
    let no_position = if moves_link { "    output[1] = 0.0;\n" } else { "" };
    let begin = format!("    output[0] = {identifier}_friction({values});\n{no_position}");
    let (memory, advance) = if is_static {
        ("typedef struct { char nothing; } Memory;".to_owned(), format!("    (void)memory, (void)step;\n{begin}"))
    } else {
        let position = if moves_link { "    output[1] = memory->position;\n" } else { "" };
        (
            format!("typedef {identifier}_state Memory;"),
            format!("    output[0] = {identifier}_step(memory, step, {values});\n{position}"),
        )
    };
    format!(
        "{memory}\n\nstatic void begin(const double *input, double *output) {{\n{begin}}}\n\n\
         static void advance(Memory *memory, float step, const double *input, double *output) {{\n{advance}}}\n"
    )
}

impl CoSimulation {
    /// Names of the sources that make the library.
    pub fn compiled(&self) -> impl Iterator<Item = &str> {
        self.sources.iter().map(|(name, _)| name.as_str()).filter(|name| name.ends_with(".c"))
    }

    /// The unit as a file, the same bytes for the same parts.
    ///
    /// # Errors
    /// Where a part is too large for an archive.
    pub fn archive(&self, library: Option<&Library>) -> ZipResult<Vec<u8>> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
        let mut add = |name: String, bytes: &[u8]| -> ZipResult<()> {
            archive.start_file(name, options)?;
            Ok(archive.write_all(bytes)?)
        };
        add("modelDescription.xml".to_owned(), self.description.as_bytes())?;
        for (name, text) in &self.sources {
            add(format!("sources/{name}"), text.as_bytes())?;
        }
        add("sources/buildDescription.xml".to_owned(), build(&self.identifier, self.compiled()).as_bytes())?;
        if let Some(Library { platform, file, bytes }) = library {
            add(format!("binaries/{platform}/{file}"), bytes)?;
        }
        Ok(archive.finish()?.into_inner())
    }
}

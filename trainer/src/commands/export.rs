//! `trainer export`: an image in the form that a tool chain takes.

mod fmu;
mod model_file;
mod number;
mod slot;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use frikan_shared::authentication::release_block;
use frikan_shared::image::Image;
use frikan_shared::model::Law;

use self::model_file::ModelFileArguments;
use self::number::number;
use self::slot::FlashArguments;
use super::measurement::{joint, table_in_counts};
use super::output::{Outputs, print, refuse_unwritable, say};
use crate::error::{Error, Result, codes};
use crate::export::elf::{Processor, object_file};
use crate::export::flashing::{Addressing, commands};
use crate::export::simulator::Simulator;
use crate::export::source::{c, integers, python, rust};
use crate::export::{c_array, hex, readable, title, uf2};
use crate::fit::{CELLS, model};
use crate::key;
use crate::law::{Language, canonical, expression_of, render};

/// Export an image for a build tool, a flash tool or a simulator, and print the commands that flash it.
#[derive(Args, Clone, Debug)]
pub struct Export {
    /// Image to export
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Form to export to
    #[arg(long, value_enum)]
    pub to: Format,
    /// First address: needed for `hex` and `uf2` (there a multiple of 256), else for the commands
    #[arg(long, value_parser = number, value_name = "ADDRESS")]
    pub address: Option<u32>,
    /// Put the header of a flash slot in front, with this sequence number
    #[arg(long, value_parser = number, value_name = "SEQUENCE")]
    pub slot: Option<u32>,
    /// How the flash of the slot is written
    #[command(flatten)]
    pub flash: FlashArguments,
    /// Put the tag of the key in this file behind the image, for drives that ask for one
    #[arg(long, value_name = "KEY")]
    pub key_file: Option<PathBuf>,
    /// Put a signature by the secret in this file, 64 hexadecimal digits, behind the image, and print the public key for the drives
    #[arg(long, value_name = "SECRET", conflicts_with = "key_file")]
    pub signing_key_file: Option<PathBuf>,
    /// Number the release, under tag or signature: a drive refuses an older one than its firmware has seen
    #[arg(long, value_parser = number, value_name = "NUMBER")]
    pub release: Option<u32>,
    /// Processor family, needed for `uf2`: a boot loader takes no file of another (github.com/microsoft/uf2, `utils/uf2families.json`)
    #[arg(long, value_parser = number, value_name = "NUMBER")]
    pub family: Option<u32>,
    /// Processor, for `elf`
    #[arg(long, value_enum, default_value = "arm")]
    pub processor: ElfProcessor,
    /// Chip, for the commands, as probe-rs names it
    #[arg(long, value_name = "NAME")]
    pub chip: Option<String>,
    /// A simulator's model file, for the forms of simulators
    #[command(flatten)]
    pub model_file: ModelFileArguments,
    /// File to write; `-` for standard output. `c` writes the header beside it
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// A form of export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// The bytes as they go to flash
    Bin,
    /// Intel HEX
    Hex,
    /// UF2, for boot loaders that show up as a drive
    Uf2,
    /// An object file with the bytes in its section `.frikan`, at the symbol FILE_image
    Elf,
    /// The bytes as the array FILE_image for a C compiler
    CHeader,
    /// Law and effects as C source that needs nothing else, the very bits of the drive: FILE.c and FILE.h; an integer table from counts to counts
    C,
    /// Everything that the image says, readable
    Json,
    /// Law and effects as a Rust module for `no_std`, the very bits of the drive
    Rust,
    /// Law and effects as a Python module that needs nothing else, in double precision
    Python,
    /// The law as a string for SymPy
    Sympy,
    /// The law in LaTeX
    Latex,
    /// The law as text
    Text,
    /// MuJoCo 4.0: joint attributes and, with `--into` where law or effects ask for it, a passive motor with LuGre friction and cogging
    Mujoco,
    /// MuJoCo: `armature`, `frictionloss`, `damping` of a joint (three numbers of `damping` need 4.0); without `--into` a default class to
    /// include
    MjcfPatch,
    /// URDF: the `dynamics` of a joint
    Urdf,
    /// SDFormat (Gazebo, Drake): the `dynamics` of a joint's axis
    Sdf,
    /// USD: a layer over a joint with the friction of PhysX 5.6; `--joint-name` is the path of its prim
    Usd,
    /// Isaac Lab: an actuator with the friction of PhysX, and the law as a table, as Python
    Isaac,
    /// Drake: rotor inertia, and the law as a system, as Python
    Drake,
    /// Rhoban's BAM: motor, inertia and friction of a servo, as the JSON of its models m1, m2 and m5; `--joint-name` is BAM's name of the actuator
    Bam,
    /// FMI 3.0: law and effects as a co-simulation unit, with C sources and, where a C compiler is found, the library of this platform
    Fmu,
}

/// A processor of `elf`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ElfProcessor {
    /// 32-bit Arm
    Arm,
    /// 32-bit RISC-V
    Riscv32,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D020` for what is no image, `FRK-D022` for what is no key, `FRK-U001` and `FRK-U005` where the form does not suit the model
/// or the options, or the address does not suit the form, `FRK-I...` when a file cannot be read or written.
pub fn run(arguments: &Export) -> Result<()> {
    let mut read = vec![arguments.model.as_path()];
    read.extend(arguments.key_file.as_deref());
    read.extend(arguments.signing_key_file.as_deref());
    read.extend(arguments.model_file.inputs());
    let header = (arguments.to == Format::C).then(|| c_names(&arguments.output)).transpose()?.map(|(_, header)| header);
    refuse_unwritable([Some(&arguments.output), header.as_ref()].into_iter().flatten(), &read)?;
    let (image_bytes, image) = model::load(&arguments.model)?;
    let title = title(&image_bytes, &image);
    let bytes = flashed(arguments, image_bytes.clone())?;
    let place = place(arguments, bytes.len())?;
    let mut outputs = Outputs::default();
    let for_simulator =
        |simulator| arguments.model_file.write((&arguments.model, &image), simulator, &title).map(String::into_bytes);
    let content = match arguments.to {
        Format::Bin => bytes.clone(),
        Format::Hex => hex::intel_hex(&bytes, place.address).into_bytes(),
        Format::Uf2 => uf2::uf2(&bytes, place.address, place.family),
        Format::Elf => object_file(&stem(&arguments.output), &bytes, processor(arguments.processor))?,
        Format::CHeader => c_array::c_header(&stem(&arguments.output), &bytes, &title).into_bytes(),
        Format::Json => readable::readable(&image_bytes, &image).into_bytes(),
        Format::Rust => rust::module(&title, &image)?.into_bytes(),
        Format::Python => python::module(&title, &image)?.into_bytes(),
        Format::Sympy => law(&image, Language::SymPy)?,
        Format::Latex => law(&image, Language::Latex)?,
        Format::Text => law(&image, Language::Unicode)?,
        Format::Mujoco => for_simulator(Simulator::Mujoco)?,
        Format::MjcfPatch => for_simulator(Simulator::MjcfPatch)?,
        Format::Urdf => for_simulator(Simulator::Urdf)?,
        Format::Sdf => for_simulator(Simulator::Sdf)?,
        Format::Usd => for_simulator(Simulator::Usd)?,
        Format::Isaac => for_simulator(Simulator::Isaac)?,
        Format::Drake => for_simulator(Simulator::Drake)?,
        Format::Bam => for_simulator(Simulator::Bam)?,
        Format::Fmu => {
            let (file, told) = fmu::file(&image_bytes, &image, &title)?;
            say(told.trim_end());
            file
        }
        Format::C => {
            let (name, header) = c_names(&arguments.output)?;
            let joint = joint(arguments.model_file.joint.as_deref(), false)?;
            let evaluator = match table_in_counts(&image_bytes, &image.model, &joint.drive)? {
                Some((units, _)) => integers::evaluator(&name, &title, &image.model, units)?,
                None => c::evaluator(&name, &title, &image)?,
            };
            outputs.add(&header, evaluator.header);
            evaluator.source.into_bytes()
        }
    };
    outputs.add(&arguments.output, content);
    outputs.write()?;
    if arguments.output == Path::new("-") { Ok(()) } else { print(&advice(arguments, bytes.len())) }
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
    let text = render(&canonical(&expression), language, &names);
    Ok(format!("{}\n", text.trim_end()).into_bytes())
}

/// A channel's name as every language takes it.
fn identifier(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("x_{plain}") }
}

/// Whether a format holds the bytes of flash.
fn is_of_flash(format: Format) -> bool {
    matches!(format, Format::Bin | Format::Hex | Format::Uf2 | Format::Elf | Format::CHeader)
}

/// What goes to flash: the image, its tag behind it and the header of its slot in front, as asked for.
fn flashed(arguments: &Export, image: Vec<u8>) -> Result<Vec<u8>> {
    let is_signed = arguments.key_file.is_some() || arguments.signing_key_file.is_some();
    if arguments.release.is_some() && !is_signed {
        return Err(Error::new(
            &codes::USAGE,
            "a release has a number under a tag or a signature: `--key-file` or `--signing-key-file`",
        ));
    }
    let dressed = arguments.slot.is_some() || is_signed;
    if dressed && !is_of_flash(arguments.to) {
        return Err(Error::new(&codes::USAGE, "this form is not the bytes of flash: it takes neither slot nor key"));
    }
    let mut bytes = image;
    bytes.extend(arguments.release.iter().flat_map(|number| release_block(*number)));
    if let Some(path) = &arguments.key_file {
        let tag = key::load(path)?.tag(&bytes);
        bytes.extend(tag);
    }
    if let Some(path) = &arguments.signing_key_file {
        let signer = key::signer(path)?;
        let signature = signer.sign(&bytes);
        bytes.extend(signature);
        let public_key: String = signer.public_key().iter().map(|byte| format!("{byte:02x}")).collect();
        say(&format!("public key {public_key}"));
    }
    match arguments.slot {
        Some(sequence) => arguments.flash.slot(sequence, &bytes, arguments.address),
        None => arguments.flash.refused_without_slot().map(|()| bytes),
    }
}

/// The name of a file, by which what it defines is called; `frikan` for standard output.
fn stem(output: &Path) -> String {
    let stem = output.file_stem().filter(|stem| *stem != "-");
    stem.map_or_else(|| "frikan".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Where the bytes go in flash, as far as the form says it; 0 where it does not.
struct Place {
    address: u32,
    family: u32,
}

/// Checks where `bytes` bytes are to go.
fn place(arguments: &Export, bytes: usize) -> Result<Place> {
    let missing = |option: &str, what: &str| {
        let form = arguments.to.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
        Error::new(&codes::USAGE, format!("`--to {form}` needs `{option}`, {what}"))
    };
    let holds_address = matches!(arguments.to, Format::Hex | Format::Uf2);
    let address = match arguments.address {
        None if holds_address => {
            return Err(missing("--address", "the address in flash of the first byte, such as 0x08060000"));
        }
        address => address.unwrap_or(0),
    };
    let pages = if arguments.to == Format::Uf2 { bytes.next_multiple_of(uf2::PAGE_BYTES) } else { bytes };
    if u64::from(address) + pages as u64 > 1 << 32 {
        let message = format!("{pages} bytes from this address on leave the 32 bits of an address");
        return Err(Error::new(&codes::USAGE, message).with_value(format!("{address:#010x}")));
    }
    let family = match (arguments.to, arguments.family) {
        (Format::Uf2, None) => return Err(missing("--family", "the number of the processor family")),
        (_, family) => family.unwrap_or(0),
    };
    if arguments.to == Format::Uf2 && !(address as usize).is_multiple_of(uf2::PAGE_BYTES) {
        let message =
            format!("a boot loader writes pages of {} bytes: `--address` must be a multiple", uf2::PAGE_BYTES);
        return Err(Error::new(&codes::USAGE, message).with_value(format!("{address:#010x}")));
    }
    Ok(Place { address, family })
}

/// The commands by which the file gets into the drive.
fn advice(arguments: &Export, bytes: usize) -> String {
    let file = arguments.output.display().to_string();
    let chip = arguments.chip.as_deref();
    match arguments.to {
        Format::Bin => commands(&file, arguments.address, bytes, Addressing::None, chip),
        Format::Hex => commands(&file, arguments.address, bytes, Addressing::Inside, chip),
        Format::Uf2 => format!("cp {file} /media/BOOT-LOADER/\n"),
        _ => String::new(),
    }
}

fn processor(processor: ElfProcessor) -> Processor {
    match processor {
        ElfProcessor::Arm => Processor::Arm,
        ElfProcessor::Riscv32 => Processor::Riscv32,
    }
}

/// The name of the evaluator and the path of its header, from the path of its source.
fn c_names(source: &Path) -> Result<(String, PathBuf)> {
    let name = source.file_stem().filter(|_| source.extension().is_some_and(|extension| extension == "c"));
    let name = name.ok_or_else(|| Error::new(&codes::USAGE, "`--to c` writes two files: name one that ends in .c"))?;
    Ok((name.to_string_lossy().into_owned(), source.with_extension("h")))
}

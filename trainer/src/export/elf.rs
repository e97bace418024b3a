//! An object file whose only section is the image, for a linker to place.

use object::write::{Object, Symbol, SymbolSection};
use object::{
    Architecture, BinaryFormat, Endianness, FileFlags, SectionKind, SymbolFlags, SymbolKind, SymbolScope, elf,
};

use super::c_array::image_symbol;
use crate::error::{Error, Result, codes};

/// The section in which the image lies.
pub const SECTION: &str = ".frikan";

/// Processors for which objects are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Processor {
    /// 32-bit Arm, EABI version 5.
    Arm,
    /// 32-bit RISC-V without hardware floating point.
    Riscv32,
}

/// The object file of an image, which begins on a multiple of 4, at the symbol `NAME_image`, whose size is the image's.
///
/// # Errors
/// `FRK-I001` where it cannot be made.
pub fn object_file(name: &str, bytes: &[u8], processor: Processor) -> Result<Vec<u8>> {
    let (architecture, e_flags) = match processor {
        Processor::Arm => (Architecture::Arm, elf::EF_ARM_EABI_VER5),
        Processor::Riscv32 => (Architecture::Riscv32, Default::default()),
    };
    let mut object = Object::new(BinaryFormat::Elf, architecture, Endianness::Little);
    object.flags = FileFlags::Elf { os_abi: elf::ELFOSABI_NONE, abi_version: 0, e_flags };
    let section = object.add_section(Vec::new(), SECTION.into(), SectionKind::ReadOnlyData);
    let value = object.append_section_data(section, bytes, 4);
    object.add_symbol(Symbol {
        name: image_symbol(name).into_bytes(),
        value,
        size: bytes.len() as u64,
        kind: SymbolKind::Data,
        scope: SymbolScope::Linkage,
        weak: false,
        section: SymbolSection::Section(section),
        flags: SymbolFlags::None,
    });
    object.write().map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()))
}

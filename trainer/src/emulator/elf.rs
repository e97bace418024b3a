//! What the linked firmware says of itself: the flash kept for the image, sizes, symbols.

use std::path::Path;

use object::{File, Object, ObjectSection, ObjectSymbol, SectionFlags, elf};

use crate::error::{Error, Result, codes};

/// The flash that a target keeps for the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    /// Address of the first byte.
    pub(super) start: u64,
    /// Length in bytes.
    pub(super) bytes: u64,
}

/// Memory that a program takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Footprint {
    /// Code, constants and initial values, bytes.
    pub flash_bytes: u64,
    /// Static data, bytes; the stack is not part of it.
    pub ram_bytes: u64,
}

impl Footprint {
    /// What this program takes beyond another.
    #[must_use]
    pub fn beyond(self, other: Self) -> Self {
        Self {
            flash_bytes: self.flash_bytes.saturating_sub(other.flash_bytes),
            ram_bytes: self.ram_bytes.saturating_sub(other.ram_bytes),
        }
    }
}

/// Reads the symbols `_image_start` and `_image_end` that every `memory.x` defines.
pub(super) fn image_window(path: &Path) -> Result<Window> {
    with_elf(path, |file| {
        let address = |name| file.symbols().find(|symbol| symbol.name() == Ok(name)).map(|symbol| symbol.address());
        let (start, end) = address("_image_start").zip(address("_image_end"))?;
        Some(Window { start, bytes: end.checked_sub(start)? })
    })
}

/// Flash and static RAM of a linked program.
///
/// # Errors
/// `FRK-I001` to `FRK-I003` where the file cannot be read, `FRK-I007` where it is not an ELF file.
pub fn footprint(path: &Path) -> Result<Footprint> {
    with_elf(path, |file| {
        let mut footprint = Footprint { flash_bytes: 0, ram_bytes: 0 };
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags, .. } = section.flags() else { continue };
            let allocated = sh_flags.0 & elf::SHF_ALLOC.0 != 0;
            // The linker scripts' fictitious sections for heap and stack hold no program.
            if !allocated || matches!(section.name(), Ok(".stack" | ".heap")) {
                continue;
            }
            let in_file = section.file_range().is_some();
            footprint.flash_bytes += if in_file { section.size() } else { 0 };
            footprint.ram_bytes += if sh_flags.0 & elf::SHF_WRITE.0 != 0 { section.size() } else { 0 };
        }
        Some(footprint)
    })
}

/// Names of functions that a drive's firmware must not hold: panics, unwinding and allocation.
const FORBIDDEN: [&str; 8] = [
    "panicking",
    "panic_fmt",
    "panic_bounds_check",
    "rust_begin_unwind",
    "unwrap_failed",
    "__rust_alloc",
    "__rust_realloc",
    "alloc_error",
];

/// Symbols of a linked program that a drive's firmware must not hold, in the order of the file.
///
/// # Errors
/// As [`footprint`].
pub fn forbidden_symbols(path: &Path) -> Result<Vec<String>> {
    with_elf(path, |file| {
        let names = file.symbols().filter(|symbol| symbol.kind() == object::SymbolKind::Text);
        let names = names.filter_map(|symbol| symbol.name().ok());
        Some(names.filter(|name| FORBIDDEN.iter().any(|part| name.contains(part))).map(str::to_owned).collect())
    })
}

/// Parses the file and takes from it what `read` finds.
fn with_elf<R>(path: &Path, read: impl FnOnce(&File<'_>) -> Option<R>) -> Result<R> {
    let bytes = std::fs::read(path).map_err(|error| Error::from_io(path, &error))?;
    let found = File::parse(&*bytes).ok().and_then(|file| read(&file));
    found.ok_or_else(|| {
        Error::new(&codes::FIRMWARE_BUILD, "this is not the ELF file of a firmware").in_file(path.display().to_string())
    })
}

//! An image in the forms that build tools, flash tools and simulators take. Knows images and models; knows nothing of files or commands.

pub mod c_array;
pub mod dump;
pub mod elf;
pub mod flashing;
pub mod fmu;
pub mod hex;
pub mod readable;
pub mod simulator;
pub mod source;
pub mod terms;
pub mod uf2;

use frikan_shared::image::{Image, image_crc32};

use crate::fit::CELLS;

/// What an image is, in half a line that may stand in a comment of C: its joint and its checksum.
#[must_use]
pub fn title(bytes: &[u8], image: &Image<CELLS>) -> String {
    let crc32 = image_crc32(bytes).unwrap_or(0);
    let joint = image.provenance.joint.replace("*/", "* /").replace("/*", "/ *");
    match joint.as_str() {
        "" => format!("Frikan friction image, CRC-32 {crc32:08x}"),
        joint => format!("Frikan friction image of joint \"{}\", CRC-32 {crc32:08x}", joint.escape_debug()),
    }
}

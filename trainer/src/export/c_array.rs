//! An array for a C compiler.

use std::fmt::Write;

/// A header with `bytes` as `frikan_image`.
#[must_use]
pub fn c_header(bytes: &[u8], title: &str) -> String {
    let mut text =
        format!("/* {title}, {} bytes. Made by `trainer export --to c-header`; do not edit. */\n", bytes.len());
    text.push_str("#ifndef FRIKAN_IMAGE_H\n#define FRIKAN_IMAGE_H\n\n#include <stdint.h>\n\n");
    // Writing to a string cannot fail.
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

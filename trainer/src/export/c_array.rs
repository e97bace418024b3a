//! An array for a C compiler.

use std::fmt::Write;

use super::source::identifier;

/// The symbol of an image's first byte.
pub(super) fn image_symbol(name: &str) -> String {
    format!("{}_image", identifier(name))
}

/// A header with `bytes` as `NAME_image`; what of `name` C does not take becomes `_`.
#[must_use]
pub fn c_header(name: &str, bytes: &[u8], title: &str) -> String {
    let symbol = image_symbol(name);
    let upper = symbol.to_ascii_uppercase();
    let mut text =
        format!("/* {title}, {} bytes. Made by `trainer export --to c-header`; do not edit. */\n", bytes.len());
    // Writing to a string cannot fail.
    let _ = writeln!(text, "#ifndef {upper}_H\n#define {upper}_H\n\n#include <stdint.h>\n");
    let _ = writeln!(text, "#define {upper}_BYTES {}u\n", bytes.len());
    let _ = writeln!(text, "static const uint8_t {symbol}[{upper}_BYTES] = {{");
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

//! Numbers of the command line as data sheets write them.

/// A number in decimal or, behind `0x`, hexadecimal digits.
pub(super) fn number(text: &str) -> std::result::Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "a number such as 1 or 0x08060000 is expected".to_owned())
}

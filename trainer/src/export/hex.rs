//! Intel HEX (Intel 1988).

use std::fmt::Write;

/// Records of sixteen bytes with extended linear addresses; the first byte goes to `first`, and the last one below 2^32.
#[must_use]
pub fn intel_hex(bytes: &[u8], first: u32) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_have_their_checksum_and_cross_a_bank() {
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

//! Key files: 64 hexadecimal digits, as `openssl rand -hex 32` writes them.

use std::path::Path;

use frikan_shared::authentication::signature::{PublicKey, Signer};
use frikan_shared::authentication::{KEY_BYTES, Key};

use crate::error::{Error, Result, codes};
use crate::files::read_whole;

/// Largest file that is read; digits and some blanks.
const LIMIT_BYTES: u64 = 1024;

/// The key in a file that trainer and drive share.
///
/// # Errors
/// `FRK-D022` for anything but 64 hexadecimal digits; the message says nothing of what is there. `FRK-I...` where it cannot be read.
pub fn load(path: &Path) -> Result<Key> {
    digits(path).map(Key::new)
}

/// The secret of whoever signs images, from the seed in a file.
///
/// # Errors
/// As [`load`].
pub fn signer(path: &Path) -> Result<Signer> {
    digits(path).map(Signer::new)
}

/// The public key in a file, as `export --signing-key-file` prints it.
///
/// # Errors
/// As [`load`].
pub fn public(path: &Path) -> Result<PublicKey> {
    digits(path).map(PublicKey::new)
}

fn digits(path: &Path) -> Result<[u8; KEY_BYTES]> {
    let bytes = read_whole(path, LIMIT_BYTES)?;
    parse(&bytes).ok_or_else(|| {
        Error::new(&codes::BAD_KEY, "64 hexadecimal digits are expected").in_file(path.display().to_string())
    })
}

fn parse(bytes: &[u8]) -> Option<[u8; KEY_BYTES]> {
    let text = str::from_utf8(bytes).ok()?.trim();
    let digits: Vec<u8> = text.chars().map(|c| c.to_digit(16).map(|digit| digit as u8)).collect::<Option<_>>()?;
    let (pairs, []) = digits.as_chunks::<2>() else { return None };
    let key: Vec<u8> = pairs.iter().map(|[high, low]| 16 * high + low).collect();
    key.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_sixty_four_digits_are_a_key() {
        let digits = "0fF1".repeat(16);
        let key = parse(format!("{digits}\r\n").as_bytes()).unwrap();
        assert_eq!(key[..4], [0x0F, 0xF1, 0x0F, 0xF1]);
        for bad in
            ["", "0f", &digits[1..], &format!("{digits}00"), &digits.replace('F', "g"), &digits.replace('f', "é")]
        {
            assert_eq!(parse(bad.as_bytes()), None, "{bad}");
        }
    }
}

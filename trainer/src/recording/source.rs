//! Bytes in: a file or standard input, compressed or not, with a fingerprint of what was read.

use std::io::{self, Read};
use std::path::Path;

use crc::{CRC_64_XZ, Crc, Digest, Table};
use flate2::read::MultiGzDecoder;

use crate::error::{Error, Result, codes};
use crate::files;

/// First bytes of gzip (RFC 1952).
const GZIP: [u8; 2] = [0x1f, 0x8b];

static FINGERPRINT: Crc<u64, Table<16>> = Crc::<u64, Table<16>>::new(&CRC_64_XZ);

/// The bytes of `path`; `-` is standard input.
///
/// # Errors
/// `FRK-I...` when it cannot be opened.
pub(super) fn open(path: &Path) -> Result<Box<dyn Read>> {
    if path == Path::new("-") {
        return Ok(Box::new(io::stdin().lock()));
    }
    Ok(Box::new(files::open(path)?))
}

/// CRC-64/XZ of everything that passes through.
pub(super) struct Fingerprinted<R> {
    inner: R,
    digest: Digest<'static, u64, Table<16>>,
}

impl<R> Fingerprinted<R> {
    pub(super) fn new(inner: R) -> Self {
        Self { inner, digest: FINGERPRINT.digest() }
    }

    /// CRC-64/XZ of the bytes read so far.
    pub(super) fn fingerprint(&self) -> u64 {
        self.digest.clone().finalize()
    }
}

impl<R: Read> Read for Fingerprinted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.inner.read(buffer)?;
        self.digest.update(&buffer[..length]);
        Ok(length)
    }
}

/// The error of a source that fails while it is read.
pub(super) fn failed(error: &io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::IsADirectory => Error::new(&codes::IS_A_DIRECTORY, error.to_string()),
        io::ErrorKind::UnexpectedEof => Error::new(&codes::CUT_SHORT, "the compressed data end before their end"),
        io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => {
            Error::new(&codes::DAMAGED, format!("the data are damaged: {error}"))
        }
        _ => Error::new(&codes::INPUT_OUTPUT, error.to_string()),
    }
}

/// The same bytes, decompressed where they are gzip.
///
/// # Errors
/// That of the source.
pub(super) fn decompressed<'a>(mut source: impl Read + 'a) -> io::Result<Box<dyn Read + 'a>> {
    let mut start = Vec::new();
    source.by_ref().take(GZIP.len() as u64).read_to_end(&mut start)?;
    let is_gzip = start == GZIP;
    let whole = io::Cursor::new(start).chain(source);
    Ok(if is_gzip { Box::new(MultiGzDecoder::new(whole)) } else { Box::new(whole) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fingerprint_is_the_published_one() {
        let mut source = Fingerprinted::new(&b"123456789"[..]);
        io::copy(&mut source, &mut io::sink()).unwrap();
        assert_eq!(source.fingerprint(), 0x995d_c9bb_df19_39fa);
    }
}

//! Bounds what a broken file can cost: counts the bytes of each record and fingerprints the whole stream.

use std::io::{self, Read};

use crc::{CRC_64_XZ, Crc, Digest, Table};

/// Longest record, in bytes, line break included.
pub const RECORD_LIMIT_BYTES: u64 = 1 << 20;

/// Text of the error that a record above [`RECORD_LIMIT_BYTES`] produces.
pub(super) const TOO_LONG: &str = "record too long";

static FINGERPRINT: Crc<u64, Table<16>> = Crc::<u64, Table<16>>::new(&CRC_64_XZ);

/// A reader that fails on an overlong record and computes the CRC-64/XZ of everything it passes on.
pub(super) struct BoundedRecords<R> {
    inner: R,
    digest: Digest<'static, u64, Table<16>>,
    record_bytes: u64,
    in_quotes: bool,
}

impl<R: Read> BoundedRecords<R> {
    pub(super) fn new(inner: R) -> Self {
        Self { inner, digest: FINGERPRINT.digest(), record_bytes: 0, in_quotes: false }
    }

    /// CRC-64/XZ of the bytes read so far.
    pub(super) fn fingerprint(&self) -> u64 {
        self.digest.clone().finalize()
    }

    /// A line break inside an open quotation does not end a record, so that an open quotation is bounded too.
    fn count(&mut self, bytes: &[u8]) -> io::Result<()> {
        for byte in bytes {
            self.record_bytes += 1;
            match byte {
                b'"' => self.in_quotes = !self.in_quotes,
                b'\n' | b'\r' if !self.in_quotes => self.record_bytes = 0,
                _ => {}
            }
            if self.record_bytes > RECORD_LIMIT_BYTES {
                return Err(io::Error::new(io::ErrorKind::InvalidData, TOO_LONG));
            }
        }
        Ok(())
    }
}

impl<R: Read> Read for BoundedRecords<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.inner.read(buffer)?;
        self.digest.update(&buffer[..length]);
        self.count(&buffer[..length])?;
        Ok(length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drain(source: impl Read) -> io::Result<u64> {
        let mut bounded = BoundedRecords::new(source);
        io::copy(&mut bounded, &mut io::sink())?;
        Ok(bounded.fingerprint())
    }

    #[test]
    fn an_endless_line_stops_at_the_limit() {
        let error = drain(io::repeat(b'7')).unwrap_err();
        assert_eq!(error.to_string(), TOO_LONG);
    }

    #[test]
    fn an_open_quotation_over_endless_lines_stops_too() {
        let lines = io::repeat(b'\n');
        assert!(drain(Read::chain(&b"\""[..], lines)).is_err());
    }

    #[test]
    fn many_short_lines_pass_and_the_fingerprint_is_the_published_one() {
        assert_eq!(drain(&b"123456789"[..]).unwrap(), 0x995d_c9bb_df19_39fa);
        assert!(drain(Read::take(io::repeat(b'\n'), 4 * RECORD_LIMIT_BYTES)).is_ok());
    }
}

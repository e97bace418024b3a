//! Records of a delimited text, as `csv` splits them, with what a broken file can cost bounded.

use std::io::BufRead;

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use crate::error::{Error, Result, codes};
use crate::recording::source::failed;

/// Longest record, in bytes of its fields; it has at most as many fields.
pub const RECORD_LIMIT_BYTES: usize = 1 << 20;

/// Room for a record at the start; it grows up to the limit.
const FIRST_ROOM: usize = 1 << 10;

/// The records of a text in turn; lines that begin with `#` are comments and blank lines are none.
pub(super) struct Records<R> {
    source: R,
    splitter: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
    fields: usize,
    line: u64,
}

impl<R: BufRead> Records<R> {
    pub(super) fn new(source: R, separator: u8) -> Self {
        let splitter = ReaderBuilder::new().delimiter(separator).comment(Some(b'#')).build();
        Self { source, splitter, text: vec![0; FIRST_ROOM], ends: vec![0; FIRST_ROOM], fields: 0, line: 1 }
    }

    /// Goes on to the next record; `false` behind the last one.
    ///
    /// # Errors
    /// `FRK-D003` with its row for a record above the limit, whatever its quotes; that of the source where it cannot be read.
    pub(super) fn advance(&mut self) -> Result<bool> {
        let (mut bytes, mut ends) = (0, 0);
        let mut ended_by_newline = false;
        loop {
            let input = self.source.fill_buf().map_err(|error| failed(&error).at_row(self.splitter.line()))?;
            let (outcome, read, written, closed) =
                self.splitter.read_record(input, &mut self.text[bytes..], &mut self.ends[ends..]);
            if read > 0 {
                ended_by_newline = input[read - 1] == b'\n';
            }
            self.source.consume(read);
            bytes += written;
            ends += closed;
            match outcome {
                ReadRecordResult::InputEmpty => {}
                ReadRecordResult::OutputFull => self.text.resize(self.grown(self.text.len())?, 0),
                ReadRecordResult::OutputEndsFull => self.ends.resize(self.grown(self.ends.len())?, 0),
                ReadRecordResult::Record => {
                    self.fields = ends;
                    self.line = self.splitter.line() - u64::from(ended_by_newline);
                    return Ok(true);
                }
                ReadRecordResult::End => return Ok(false),
            }
        }
    }

    fn grown(&self, room: usize) -> Result<usize> {
        if room < RECORD_LIMIT_BYTES {
            return Ok((2 * room).min(RECORD_LIMIT_BYTES));
        }
        let message = "a record is longer than one mebibyte; is this a text table, is a quotation left open?";
        Err(Error::new(&codes::LINE_TOO_LONG, message).at_row(self.splitter.line()))
    }

    /// Number of fields of the record.
    pub(super) fn len(&self) -> usize {
        self.fields
    }

    /// The fields of the record, white space around them left out.
    pub(super) fn fields(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.fields).map(|index| {
            let start = if index == 0 { 0 } else { self.ends[index - 1] };
            self.text[start..self.ends[index]].trim_ascii()
        })
    }

    /// The line on which the record ends, the first being 1.
    pub(super) fn line(&self) -> u64 {
        self.line
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{self, BufReader, Read};

    fn count(source: impl Read) -> Result<usize> {
        let mut records = Records::new(BufReader::new(source), b',');
        let mut count = 0;
        while records.advance()? {
            count += 1;
        }
        Ok(count)
    }

    #[test]
    fn an_endless_line_stops_at_the_limit() {
        assert_eq!(count(io::repeat(b'7')).unwrap_err().code(), &codes::LINE_TOO_LONG);
        assert_eq!(count(io::repeat(b',')).unwrap_err().code(), &codes::LINE_TOO_LONG);
    }

    #[test]
    fn an_open_quotation_over_endless_lines_stops_too() {
        assert_eq!(count(Read::chain(&b"\""[..], io::repeat(b'\n'))).unwrap_err().code(), &codes::LINE_TOO_LONG);
    }

    #[test]
    fn a_quotation_mark_that_opens_nothing_costs_nothing() {
        let rows = "0.1,ok\n".repeat(200_000);
        for head in ["# the 3\" wheel\n", "12\",inch\n", "5,a \"loose joint\n"] {
            assert!(count(format!("{head}{rows}").as_bytes()).unwrap() >= 200_000, "{head}");
        }
    }

    #[test]
    fn a_record_has_the_line_on_which_it_ends() {
        for text in ["a,b\n# c\n\n1,2\n3,4", "a,b\r\n# c\r\n\r\n1,2\r\n3,4"] {
            let mut records = Records::new(text.as_bytes(), b',');
            let mut lines = Vec::new();
            while records.advance().unwrap() {
                lines.push(records.line());
            }
            assert_eq!(lines, [1, 4, 5], "{text:?}");
        }
    }
}

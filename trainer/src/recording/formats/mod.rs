//! Files of all formats as one table of text: what a file is, is told by its first bytes, not by its name.

mod arrays;
mod cursor;
#[cfg(feature = "mcap")]
mod joint_state;
mod json;
mod matlab;
#[cfg(feature = "mcap")]
mod mcap;
mod names;
mod numpy;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(test)]
mod tests;

use std::cell::Cell;
use std::io::{Cursor, Read};
use std::panic::catch_unwind;

use super::keep::Keep;
use super::source::failed;
use super::table::RawTable;
use super::text;
use crate::error::{Error, Result, codes};

/// Largest file of a format that is read as a whole, bytes.
const WHOLE_LIMIT_BYTES: u64 = 1 << 30;

/// Most cells of a table whose columns grow with its rows.
const MOST_CELLS: usize = 1 << 28;

/// Bytes at the start that tell the format.
const START_BYTES: u64 = 128;

/// A way to read a whole file.
type Reader = fn(&[u8]) -> Result<RawTable>;

/// Reads a table of any format; of a text only what is to be kept, other formats are read as a whole.
///
/// # Errors
/// `FRK-D043` for a format that is not read, with what to do instead; those of the format's reader.
pub(super) fn read(mut source: impl Read, keep: Keep<'_>) -> Result<RawTable> {
    let mut start = Vec::new();
    source.by_ref().take(START_BYTES).read_to_end(&mut start).map_err(|error| failed(&error))?;
    let reader = reader_of(&start)?;
    let mut source = Cursor::new(start).chain(source);
    let Some(reader) = reader else { return text::read(source, keep) };
    let mut bytes = Vec::new();
    source.by_ref().take(WHOLE_LIMIT_BYTES + 1).read_to_end(&mut bytes).map_err(|error| failed(&error))?;
    if bytes.len() as u64 > WHOLE_LIMIT_BYTES {
        let message =
            format!("a file of this format may have {WHOLE_LIMIT_BYTES} bytes at most; cut it, or convert it to CSV");
        return Err(Error::new(&codes::FILE_TOO_LARGE, message));
    }
    // What a file says of itself its library may take for granted, and panic where a damaged one does not keep it.
    IS_READING.set(true);
    let table = catch_unwind(|| reader(&bytes));
    IS_READING.set(false);
    table.unwrap_or_else(|_| Err(damaged("its parts contradict each other")))
}

thread_local! {
    /// Whether a file of a format with structure is being read by this thread.
    static IS_READING: Cell<bool> = const { Cell::new(false) };
}

/// Keeps off standard error what a library says when it panics over a damaged file, which is reported as an error of the file; every
/// other panic is told as before. For programs: the hook is that of the whole process.
pub fn silence_readers_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !IS_READING.get() {
            usual(panic);
        }
    }));
}

/// The reader of a format, `None` for text.
fn reader_of(start: &[u8]) -> Result<Option<Reader>> {
    let refused = |what: &str| Err(Error::new(&codes::FORMAT_NOT_READ, what));
    let is = |magic: &[u8]| start.starts_with(magic);
    if is(b"\x93NUMPY") {
        Ok(Some(numpy::read_array))
    } else if is(b"PK\x03\x04") || is(b"PK\x05\x06") {
        Ok(Some(numpy::read_archive))
    } else if is(b"MATLAB 5.0 MAT-file") {
        Ok(Some(matlab::read))
    } else if is(b"MATLAB 7.3 MAT-file") || is(b"\x89HDF\r\n\x1a\n") {
        refused(
            "a MATLAB 7.3 or HDF5 file: save it again by save('recording.mat', '-v7') in MATLAB, or from Python by \
             scipy.io.savemat, numpy.savez or DataFrame.to_csv",
        )
    } else if is(b"PAR1") {
        parquet_reader()
    } else if is(b"\x89MCAP0\r\n") {
        mcap_reader()
    } else if is(b"SQLite format 3\0") {
        refused("a bag in SQLite: convert it by `ros2 bag convert` to storage_id mcap")
    } else if is(b"#ROSBAG V2.0") {
        refused("a ROS 1 bag: convert it to MCAP by `mcap convert recording.bag recording.mcap`")
    } else if is(b"\x28\xb5\x2f\xfd") {
        refused("data compressed by Zstandard: decompress them by `unzstd`")
    } else if matches!(start.trim_ascii_start().first(), Some(b'{' | b'[')) && json::is_json(start) {
        Ok(Some(json::read))
    } else {
        Ok(None)
    }
}

#[cfg(feature = "parquet")]
fn parquet_reader() -> Result<Option<Reader>> {
    Ok(Some(parquet::read))
}

#[cfg(not(feature = "parquet"))]
fn parquet_reader() -> Result<Option<Reader>> {
    Err(Error::new(&codes::FORMAT_NOT_READ, "Parquet: this program was built without its feature `parquet`"))
}

#[cfg(feature = "mcap")]
fn mcap_reader() -> Result<Option<Reader>> {
    Ok(Some(mcap::read))
}

#[cfg(not(feature = "mcap"))]
fn mcap_reader() -> Result<Option<Reader>> {
    Err(Error::new(&codes::FORMAT_NOT_READ, "MCAP: this program was built without its feature `mcap`"))
}

/// The error of a file that contradicts its own format.
fn damaged(what: impl std::fmt::Display) -> Error {
    Error::new(&codes::DAMAGED, format!("the file is damaged: {what}"))
}

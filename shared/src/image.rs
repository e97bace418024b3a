//! The model image: the only place that knows bytes. `IMAGE_FORMAT.md` beside this crate is its specification.
//!
//! Sixteen bytes of header (magic, version, cells, payload length, CRC-32), then a postcard payload. Decoding allocates
//! nothing, refuses every damaged image with an error of its own kind, and returns only models that may be evaluated. An image is either
//! decoded to a model in memory, or, where its law is a table alone, read where it lies: [`TableImage`], [`IntegerTableImage`].

mod around_law;
#[cfg(feature = "models")]
mod decoded;
mod fields;
mod header;
mod integer_table;
mod table;

pub use around_law::Cells;
#[cfg(feature = "models")]
pub use decoded::{Image, decode, encode, model_checksum};
pub use header::{
    Checksum, EARLIEST_VERSION, FORMAT_VERSION, HEADER_BYTES, ImageError, MAGIC, MAX_PAYLOAD_BYTES, checksum,
    image_bytes, image_crc32, image_version,
};
pub use integer_table::IntegerTableImage;
pub use table::TableImage;

#[cfg(all(test, feature = "models"))]
mod tests;

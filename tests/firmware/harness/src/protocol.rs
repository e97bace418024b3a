//! The two files that the host and the firmware exchange. All words are little-endian `u32`; the host's side is
//! `frikan_trainer::emulator::protocol`.
//!
//! `request.bin`: [`MAGIC`], mode, floating-point control bits, image length in bytes, number of rows, inputs a row,
//! then the rows as `f32` bits.
//!
//! `answer.bin`: [`MAGIC`], status (0, or the evaluator's error number), ticks of an empty call, ticks of
//! [`CALIBRATION_NOPS`] more instructions, ticks of decoding, stack bytes of decoding, stack bytes of evaluating, bytes
//! of the decoded model; then a row each: the outputs, as many as the evaluator has, and, in mode [`COUNT`], the ticks.

/// First word of both files.
pub(crate) const MAGIC: u32 = u32::from_le_bytes(*b"FRKQ");
/// Mode: outputs only.
pub(crate) const EVALUATE: u32 = 0;
/// Mode: outputs and the ticks of each.
pub(crate) const COUNT: u32 = 1;
/// Words before the rows of a request.
pub(crate) const REQUEST_WORDS: usize = 6;
/// Words before the rows of an answer.
pub(crate) const ANSWER_WORDS: usize = 8;
/// Instructions by which the host turns ticks into instructions.
pub(crate) const CALIBRATION_NOPS: usize = 1024;
/// Status of a request that the harness cannot serve.
pub(crate) const BAD_REQUEST: u32 = u32::MAX;
/// Most inputs a row.
pub(crate) const MAX_INPUTS: usize = 14;
/// Most outputs a row.
pub(crate) const MAX_OUTPUTS: usize = 3;

/// The inputs of one evaluation; those that the request does not have are zero.
pub type Row = [f32; MAX_INPUTS];

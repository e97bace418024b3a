//! The two files that host and firmware exchange; the firmware's side is `tests/firmware/harness/src/protocol.rs`.
//!
//! All words are little-endian `u32`. Request: magic, mode, floating-point control bits, image length, rows, inputs a
//! row, then the rows as `f32` bits. Answer: magic, status, ticks of an empty call, ticks of [`CALIBRATION_NOPS`] more
//! instructions, ticks of decoding, stack of decoding, stack of evaluating, bytes of the decoded model; then for each
//! row its outputs and, where they are counted, the ticks.

use crate::error::{Error, Result, codes};

const MAGIC: u32 = u32::from_le_bytes(*b"FRKQ");
const ANSWER_WORDS: usize = 8;
const CALIBRATION_NOPS: u32 = 1024;
const BAD_REQUEST: u32 = u32::MAX;

/// Most inputs a row.
pub const MAX_INPUTS: usize = 14;

/// What a run brings back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Outputs only; as fast as the emulator goes.
    Evaluate,
    /// Outputs and the instructions of each.
    Count,
}

/// What is to be run.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The image file, as it would be flashed.
    pub image: &'a [u8],
    /// Rows one after the other; a multiple of `inputs`.
    pub values: &'a [f32],
    /// Inputs a row, 1 to [`MAX_INPUTS`]; as many as the evaluator reads.
    pub inputs: usize,
    /// Outputs a row, at least 1; as many as the evaluator has.
    pub outputs: usize,
    /// Whether instructions are counted.
    pub mode: Mode,
    /// Bits set in the FPSCR of an Arm target with FPU: bit 24 flushes subnormals to zero, bit 25 makes every NaN the
    /// default one. 0 elsewhere.
    pub floating_point_control: u32,
}

impl Request<'_> {
    /// Rows of the request.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.len() / self.inputs.max(1)
    }

    /// The request file.
    pub(super) fn to_bytes(self) -> Result<Vec<u8>> {
        let word = |value: usize| u32::try_from(value).map_err(|_| failure("the request is too large"));
        if !(1..=MAX_INPUTS).contains(&self.inputs)
            || self.outputs == 0
            || !self.values.len().is_multiple_of(self.inputs)
        {
            return Err(failure("the rows do not have as many values as the evaluator reads"));
        }
        let mode = match self.mode {
            Mode::Evaluate => 0,
            Mode::Count => 1,
        };
        let header =
            [MAGIC, mode, self.floating_point_control, word(self.image.len())?, word(self.rows())?, word(self.inputs)?];
        let words = header.into_iter().chain(self.values.iter().map(|value| value.to_bits()));
        Ok(words.flat_map(u32::to_le_bytes).collect())
    }
}

/// What the target computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The outputs of each row, in the bits of the target.
    pub outputs: Vec<f32>,
    /// Instructions of each evaluation, from the first inside the call to its return; empty unless counted.
    pub instructions: Vec<u32>,
    /// Instructions of decoding the image; 0 unless counted.
    pub decode_instructions: u32,
    /// Bytes of stack that decoding takes.
    pub decode_stack_bytes: u32,
    /// Bytes of stack that evaluating takes.
    pub evaluate_stack_bytes: u32,
    /// Bytes of RAM of the decoded model.
    pub model_bytes: u32,
}

impl Answer {
    /// Fewest and most instructions of an evaluation, where they were counted.
    #[must_use]
    pub fn instruction_range(&self) -> Option<(u32, u32)> {
        let fewest = self.instructions.iter().copied().min()?;
        let most = self.instructions.iter().copied().max()?;
        Some((fewest, most))
    }

    /// Reads the answer to `request`.
    pub(super) fn from_bytes(bytes: &[u8], request: &Request<'_>) -> Result<Self> {
        let (words, rest) = bytes.as_chunks::<4>();
        let words: Vec<u32> = words.iter().copied().map(u32::from_le_bytes).collect();
        let short = || failure("the firmware's answer is cut short");
        let (&[magic, status, empty, calibration, decode, decode_stack, evaluate_stack, model], rows) =
            words.split_first_chunk::<ANSWER_WORDS>().ok_or_else(short)?;
        match (magic, status) {
            (MAGIC, 0) => {}
            (MAGIC, BAD_REQUEST) => return Err(failure("the firmware cannot serve this request")),
            (MAGIC, _) => {
                return Err(failure("the firmware refuses the image").with_value(status.to_string()));
            }
            _ => return Err(failure("the firmware's answer is not an answer")),
        }
        let row_words = request.outputs + usize::from(request.mode == Mode::Count);
        if !rest.is_empty() || rows.len() != row_words * request.rows() {
            return Err(short());
        }
        let rows = rows.chunks_exact(row_words);
        let outputs = rows.clone().flat_map(|row| &row[..request.outputs]).map(|bits| f32::from_bits(*bits)).collect();
        let (instructions, decode_instructions) = if request.mode == Mode::Count {
            let clock = Clock { empty, calibration };
            // The empty call is one instruction: its return.
            let ticks = rows.flat_map(|row| row.last());
            let counted = ticks.map(|ticks| clock.instructions(*ticks).map(|count| count + 1));
            (counted.collect::<Result<_>>()?, clock.instructions(decode)?)
        } else {
            (Vec::new(), 0)
        };
        Ok(Self {
            outputs,
            instructions,
            decode_instructions,
            decode_stack_bytes: decode_stack,
            evaluate_stack_bytes: evaluate_stack,
            model_bytes: model,
        })
    }
}

/// Turns ticks into instructions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// Ticks of an empty call.
    pub(super) empty: u32,
    /// Ticks of one with [`CALIBRATION_NOPS`] more instructions.
    pub(super) calibration: u32,
}

impl Clock {
    /// Instructions beyond an empty call.
    pub(super) fn instructions(self, ticks: u32) -> Result<u32> {
        let ticks_an_instruction = f64::from(self.calibration.saturating_sub(self.empty)) / f64::from(CALIBRATION_NOPS);
        let instructions = f64::from(ticks.saturating_sub(self.empty)) / ticks_an_instruction;
        let whole = instructions.round();
        // A clock that ticks at least once an instruction misses a whole number by a tick's rounding at each reading;
        // over thousands of instructions the ratio's own rounding is added.
        let slack = 2.0 / ticks_an_instruction.max(1.0) + 1e-3 * whole;
        if !instructions.is_finite() || (instructions - whole).abs() > slack.min(0.5) || ticks_an_instruction < 0.99 {
            return Err(failure("the emulator does not count instructions"));
        }
        Ok(whole as u32)
    }
}

/// A failure of the emulation.
pub(super) fn failure(message: &str) -> Error {
    Error::new(&codes::EMULATION_FAILED, message)
}

//! One run: the request in, the image decoded, every row evaluated, the answer out.

use crate::hardware::{calibration_call, clock, empty_call, flash, set_floating_point_control, stack_depth};
use crate::measure::{Call, ticks, ticks_and_stack};
use crate::protocol::{ANSWER_WORDS, BAD_REQUEST, COUNT, EVALUATE, MAGIC, MAX_INPUTS, MAX_OUTPUTS, REQUEST_WORDS, Row};
use crate::semihosting::{File, Mode, exit};

/// Rows that are read, evaluated and written at a time.
const CHUNK_ROWS: usize = 32;

/// Words that a row's answer takes at most: outputs and ticks.
const ANSWER_ROW: usize = MAX_OUTPUTS + 1;

/// What the harness runs.
pub trait Evaluator: Sized {
    /// Outputs a row.
    const OUTPUTS: usize = 1;

    /// The evaluator of the image that stands in flash, or the number of the reason why there is none (not 0).
    fn decode(image: &'static [u8]) -> Result<Self, u32>;

    /// Inputs a row.
    fn inputs(&self) -> usize;

    /// What is done with a row before the clock starts.
    fn prepare(&mut self, _row: &Row) {}

    /// The output of one row; the call that is counted.
    fn evaluate(&mut self, row: &Row) -> f32;

    /// The words of the answer to the row of which `output` came back; [`Evaluator::OUTPUTS`] of them are written.
    fn outputs(&self, output: f32) -> [u32; MAX_OUTPUTS] {
        [output.to_bits(), 0, 0]
    }
}

/// Serves the request beside the emulator and ends the emulation: exit status 0, or 1 where a file failed.
pub fn serve<E: Evaluator>() -> ! {
    clock::start();
    exit(if session::<E>().is_some() { 0 } else { 1 })
}

/// What a request asks for.
struct Request {
    mode: u32,
    floating_point_control: u32,
    image_bytes: usize,
    rows: usize,
    inputs: usize,
}

extern "C" fn evaluate<E: Evaluator>(evaluator: &mut E, row: &Row) -> f32 {
    evaluator.evaluate(row)
}

fn session<E: Evaluator>() -> Option<()> {
    let mut requests = File::open(c"request.bin", Mode::Read)?;
    let mut answers = File::open(c"answer.bin", Mode::Write)?;
    let request = read_request(&mut requests)?;
    let Some(image) = flash().get(..request.image_bytes) else { return refuse(&mut answers, BAD_REQUEST) };
    if !set_floating_point_control(request.floating_point_control) {
        return refuse(&mut answers, BAD_REQUEST);
    }
    let call: Call<E> = core::hint::black_box(evaluate::<E>);
    match measured::<E>(image, request.inputs, call) {
        Ok(header) => write_words(&mut answers, &header)?,
        Err(status) => return refuse(&mut answers, status),
    }
    evaluate_rows(&request, image, call, &mut requests, &mut answers)
}

/// The header of the answer to a request for rows of `inputs` inputs, or the status of a refusal.
///
/// Decodes for itself: a small target has room for one evaluator at a time, and an evaluation may leave state behind.
#[inline(never)]
fn measured<E: Evaluator>(image: &'static [u8], inputs: usize, call: Call<E>) -> Result<[u32; ANSWER_WORDS], u32> {
    let (decode_ticks, decode_stack) = ticks_and_stack(|| E::decode(image));
    let mut evaluator = E::decode(image)?;
    if evaluator.inputs() != inputs {
        return Err(BAD_REQUEST);
    }
    let (_, empty_ticks) = ticks(empty_call::<E>, &mut evaluator, &[0.0; MAX_INPUTS]);
    let (_, calibration_ticks) = ticks(calibration_call::<E>, &mut evaluator, &[0.0; MAX_INPUTS]);
    evaluator.prepare(&[0.5; MAX_INPUTS]);
    let (_, evaluate_stack) = stack_depth(|| call(&mut evaluator, &[0.5; MAX_INPUTS]));
    Ok([MAGIC, 0, empty_ticks, calibration_ticks, decode_ticks, decode_stack, evaluate_stack, size_of::<E>() as u32])
}

#[inline(never)]
fn evaluate_rows<E: Evaluator>(
    request: &Request,
    image: &'static [u8],
    call: Call<E>,
    requests: &mut File,
    answers: &mut File,
) -> Option<()> {
    let mut evaluator = E::decode(image).ok()?;
    // The compiler then knows that the chunks below are not empty.
    let inputs_a_row = request.inputs.max(1);
    let mut left = request.rows;
    while left > 0 {
        let rows = left.min(CHUNK_ROWS);
        let mut inputs = [[0_u8; 4]; CHUNK_ROWS * MAX_INPUTS];
        requests.read(inputs.as_flattened_mut().get_mut(..4 * rows * inputs_a_row)?)?;
        let mut outputs = [0_u32; ANSWER_ROW * CHUNK_ROWS];
        let mut written = 0;
        for bits in inputs.chunks_exact(inputs_a_row).take(rows) {
            let mut row = [0.0; MAX_INPUTS];
            for (value, bits) in row.iter_mut().zip(bits) {
                *value = f32::from_le_bytes(*bits);
            }
            evaluator.prepare(&row);
            let (output, ticks) = ticks(call, &mut evaluator, &row);
            let words = evaluator.outputs(output).into_iter().take(E::OUTPUTS);
            for word in words.chain((request.mode == COUNT).then_some(ticks)) {
                *outputs.get_mut(written)? = word;
                written += 1;
            }
        }
        write_words(answers, outputs.get(..written)?)?;
        left -= rows;
    }
    Some(())
}

fn read_request(file: &mut File) -> Option<Request> {
    let mut words = [[0_u8; 4]; REQUEST_WORDS];
    file.read(words.as_flattened_mut())?;
    let [magic, mode, floating_point_control, image_bytes, rows, inputs] = words.map(u32::from_le_bytes);
    let known = magic == MAGIC && (mode == EVALUATE || mode == COUNT);
    let inputs = inputs as usize;
    (known && (1..=MAX_INPUTS).contains(&inputs)).then_some(Request {
        mode,
        floating_point_control,
        image_bytes: image_bytes as usize,
        rows: rows as usize,
        inputs,
    })
}

/// Answers with a status and no rows.
fn refuse(answers: &mut File, status: u32) -> Option<()> {
    write_words(answers, &[MAGIC, status, 0, 0, 0, 0, 0, 0])
}

/// Writes at most `ANSWER_ROW * CHUNK_ROWS` words.
fn write_words(file: &mut File, words: &[u32]) -> Option<()> {
    let mut buffer = [[0_u8; 4]; ANSWER_ROW * CHUNK_ROWS];
    for (bytes, word) in buffer.iter_mut().zip(words) {
        *bytes = word.to_le_bytes();
    }
    file.write(buffer.as_flattened().get(..4 * words.len())?)
}

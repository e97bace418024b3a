//! Compiles C: for the host with `cc`, and for the emulated Cortex-M4F with the example firmware of the C library.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What says what is wrong. Nothing is said of contraction: the exported sources see to it.
const FLAGS: [&str; 4] = ["-O2", "-Wall", "-Wextra", "-Werror"];

/// The processor, its calling convention, and sections that the linker can leave out.
const CORTEX_M4F: [&str; 7] = [
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfloat-abi=hard",
    "-mfpu=fpv4-sp-d16",
    "-ffreestanding",
    "-ffunction-sections",
    "-fdata-sections",
];

/// The folder `runtime/c` of the workspace.
#[must_use]
pub fn library_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/c")
}

/// Runs a compiler.
///
/// # Panics
/// With what it says, where it fails.
fn run(command: &mut Command) {
    let output = command.output().expect("tests/setup.sh installs the C compilers");
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// Compiles sources to a program of the host.
///
/// # Panics
/// Where the compiler refuses them.
pub fn host_program(sources: &[PathBuf], program: &Path) {
    run(Command::new("cc").args(["-std=c99", "-pedantic"]).args(FLAGS).args(sources).arg("-o").arg(program));
}

/// Links the example firmware around `drive`, the C source of `drive.h`, and what it needs.
///
/// # Panics
/// Where compiler or linker refuse it.
pub fn firmware(drive: &[PathBuf], definitions: &[String], elf: &Path) {
    let folder = library_folder();
    let example = folder.join("example");
    let mut gcc = Command::new("arm-none-eabi-gcc");
    // The start-up code and semihosting are GNU C.
    gcc.arg("-std=gnu11").args(FLAGS).args(CORTEX_M4F);
    gcc.arg("-nostdlib").arg("-I").arg(folder.join("include")).arg("-I").arg(&example);
    gcc.args(definitions.iter().map(|definition| format!("-D{definition}")));
    gcc.args([example.join("startup.c"), example.join("main.c")]).args(drive);
    gcc.args(["-lgcc", "-Wl,--gc-sections", "-Wl,-z,noexecstack", "-T"]).arg(example.join("cortex-m4f.ld"));
    run(gcc.arg("-o").arg(elf));
}

/// The assembly of a source for the Cortex-M4F, compiled with nothing but `options`, or what the compiler says against it.
///
/// # Errors
/// What the compiler says.
///
/// # Panics
/// Where the compiler is not installed.
pub fn cortex_m4f_assembly(source: &Path, options: &[&str]) -> Result<String, String> {
    let mut gcc = Command::new("arm-none-eabi-gcc");
    gcc.args(CORTEX_M4F).args(options).arg(source).args(["-S", "-o", "-"]);
    let output = gcc.output().expect("tests/setup.sh installs the C compilers");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() { Ok(text(&output.stdout)) } else { Err(text(&output.stderr)) }
}

/// Feeds `values` to the standard input of a program and reads floats from its standard output.
///
/// # Panics
/// Where it cannot be run or fails.
#[must_use]
pub fn floats_through(program: &Path, values: &[f32]) -> Vec<f32> {
    let mut child =
        Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it was compiled");
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let mut input = child.stdin.take().expect("it is piped");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    assert!(writer.join().is_ok_and(|written| written.is_ok()) && output.status.success());
    output.stdout.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

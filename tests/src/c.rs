//! Compiles C: for the host with `cc`, and for the emulated Cortex-M4F with the example firmware of the C library.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use frikan_trainer::emulator::{Firmware, forbidden_symbols};

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

/// Inputs of a row of the example: velocity, position, load, temperature, velocity of the reference, torque of the loop.
pub const EXAMPLE_INPUTS: usize = 6;

/// Features of the library with which it takes every image; the default ones take tables.
pub const EVERY_FEATURE: &str = "supervised,slots,auth,expression,network,effects";

/// The library for a Cortex-M4F, by default or with these features alone, and what the example has to be told of them.
///
/// # Panics
/// Where it cannot be built.
#[must_use]
pub fn library(features: Option<&str>) -> (PathBuf, Vec<String>) {
    let sources = Firmware::find().expect("a checkout has the firmware");
    let sources = features.map_or(sources.clone(), |features| sources.with_features(features));
    let target = sources.target("cortex-m4f").expect("it is one of the targets");
    let library = sources.build_c_library(&target).expect("tests/setup.sh installs the target");
    (library, features.map(|_| "FRIKAN_MODELS".to_owned()).into_iter().collect())
}

/// The example firmware with the library, linked into `folder`.
///
/// # Panics
/// Where it cannot be built, or holds a panic or an allocator.
#[must_use]
pub fn example(folder: &Path, features: Option<&str>, definitions: &[String]) -> PathBuf {
    let (library, mut all) = library(features);
    all.extend_from_slice(definitions);
    let elf = folder.join("drive.elf");
    firmware(&[library_folder().join("example/drive.c"), library], &all, &elf);
    assert_eq!(forbidden_symbols(&elf).expect("it was linked"), [""; 0]);
    elf
}

/// The example firmware without the library, to take sizes against.
///
/// # Panics
/// Where it cannot be built.
#[must_use]
pub fn example_of_nothing(folder: &Path) -> PathBuf {
    let drive = folder.join("nothing.c");
    let source = "#include \"drive.h\"\n\
        FrikanStatus drive_start(void) { return FRIKAN_STATUS_ACTIVE; }\n\
        float drive_step(const FrikanSample *sample) { return sample->measurement.velocity; }\n";
    std::fs::write(&drive, source).expect("the folder can be written");
    let elf = folder.join("nothing.elf");
    firmware(&[drive], &[], &elf);
    elf
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

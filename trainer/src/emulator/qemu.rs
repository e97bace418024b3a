//! One run of QEMU: files into a folder of its own, the emulator over them, the answer out.

use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::error::{Error, Result, codes};

use super::elf::Window;
use super::protocol::{Answer, Mode, Request, failure};
use super::target::Target;

/// Longest run; a million evaluations take seconds.
const TIME_LIMIT: Duration = Duration::from_secs(300);

/// How often a running emulator is looked at.
const POLL: Duration = Duration::from_millis(2);

/// Fails where the target's emulator cannot be started.
pub(super) fn check_installed(target: &Target) -> Result<()> {
    let started = Command::new(&target.emulator).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if started.is_ok_and(|status| status.success()) {
        return Ok(());
    }
    let package = match target.emulator.as_str() {
        "qemu-system-arm" => "qemu-system-arm",
        _ => "qemu-system-misc",
    };
    let message = format!(
        "{} is not installed: `apt-get install --no-install-recommends {package}`, or everything with tests/setup.sh",
        target.emulator
    );
    Err(Error::new(&codes::EMULATOR_MISSING, message))
}

/// Name of the file with the image, in the folder of a run.
pub(super) const IMAGE_FILE: &str = "model.frk";

/// The emulator over `elf`, with the image of the folder in its flash and no device of the host but those that are added; `counts`
/// instructions where asked.
pub(super) fn command(target: &Target, folder: &Path, elf: &Path, window: Window, counts: bool) -> Result<Command> {
    let elf = std::path::absolute(elf).map_err(|error| Error::from_io(elf, &error))?;
    let mut qemu = Command::new(&target.emulator);
    qemu.current_dir(folder).args(&target.machine).arg("-kernel").arg(elf);
    qemu.arg("-device").arg(format!("loader,file={IMAGE_FILE},addr={:#x},force-raw=on", window.start));
    qemu.args(["-display", "none", "-monitor", "none"]);
    if counts {
        qemu.arg("-icount").arg(format!("shift={}", target.icount_shift));
    }
    qemu.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    Ok(qemu)
}

/// Runs `request` in the firmware `elf` on `target`.
pub(super) fn run(target: &Target, elf: &Path, window: Window, request: &Request<'_>) -> Result<Answer> {
    if request.image.len() as u64 > window.bytes {
        return Err(failure("the image is larger than the flash that the target keeps for it"));
    }
    let folder = tempfile::tempdir().map_err(|error| Error::from_io(&std::env::temp_dir(), &error))?;
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).map_err(|error| Error::from_io(&path, &error))
    };
    write(IMAGE_FILE, request.image)?;
    write("request.bin", &request.to_bytes()?)?;

    let mut qemu = command(target, folder.path(), elf, window, request.mode == Mode::Count)?;
    qemu.args(["-semihosting-config", "enable=on,target=native", "-serial", "none"]);
    let child = qemu.spawn().map_err(|error| Error::from_io(Path::new(&target.emulator), &error))?;
    let status = wait(child)?;
    if !status.success() {
        let message = match status.code() {
            Some(101) => "the processor faulted".to_owned(),
            _ => format!("the emulator ended with {status}"),
        };
        return Err(failure(&message).with_value(&target.name));
    }
    let path = folder.path().join("answer.bin");
    let answer = std::fs::read(&path).map_err(|error| Error::from_io(&path, &error))?;
    Answer::from_bytes(&answer, request)
}

/// Waits for the emulator, and stops it at [`TIME_LIMIT`].
fn wait(mut child: Child) -> Result<ExitStatus> {
    let start = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status),
            Ok(None) if start.elapsed() < TIME_LIMIT => std::thread::sleep(POLL),
            Ok(None) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(failure("the emulation does not end"));
            }
            Err(error) => return Err(failure(&error.to_string())),
        }
    }
}

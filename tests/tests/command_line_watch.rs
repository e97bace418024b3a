//! A recording that grows under `trainer watch`.

use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Write as _};
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use frikan_tests::command::trainer;

/// Rows of Coulomb and viscous friction, from one row on to before another.
fn rows(range: std::ops::Range<u32>) -> String {
    let mut text = String::new();
    for row in range {
        // Speeds that fill the range evenly whatever the number of rows (multiples of the golden ratio).
        let velocity = 2.0 * (f64::from(row) * 0.618_033_988_749_895).fract() - 1.0;
        let torque = 2.0 * velocity.signum() + 0.6 * velocity + 0.02 * (37.0 * velocity).sin();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{velocity:.5},{torque:.4}");
    }
    text
}

#[test]
fn a_recording_is_fitted_again_as_it_grows_and_an_interrupt_ends_it_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("growing.csv");
    let mut watch = Command::new(trainer());
    watch.current_dir(folder.path()).args(["watch", "growing.csv", "-o", "law.frk", "--every", "1"]);
    let mut watch = watch.stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(watch.stdout.take().unwrap()).lines().map(|line| line.unwrap());

    // The file comes later than who watches it, and with a row that is half written.
    std::fs::write(&path, format!("velocity_rad_s,friction_torque_Nm\n{}0.25,2.", rows(0..3))).unwrap();
    let few = lines.next().unwrap();
    assert!(few.contains("FRK-"), "{few}");
    let mut recording = OpenOptions::new().append(true).open(&path).unwrap();
    write!(recording, "15\n{}", rows(3..200)).unwrap();
    let first = lines.next().unwrap();
    assert!(first.contains(" 201 rows") && first.contains("friction = "), "{first}");
    let image = std::fs::read(folder.path().join("law.frk")).unwrap();
    recording.write_all(rows(200..300).as_bytes()).unwrap();
    let second = lines.next().unwrap();
    assert!(second.contains(" 301 rows"), "{second}");
    assert!(std::fs::read(folder.path().join("law.frk")).unwrap() != image, "the image is that of more rows");

    recording.write_all(rows(300..900).as_bytes()).unwrap();
    // Long enough that it sits in the next fit.
    std::thread::sleep(Duration::from_millis(1300));
    let interrupted = Instant::now();
    assert!(Command::new("kill").args(["-INT", &watch.id().to_string()]).status().unwrap().success());
    let ended = watch.wait().unwrap();
    assert!(interrupted.elapsed() < Duration::from_secs(1));
    assert_eq!(ended.signal(), Some(2));
}

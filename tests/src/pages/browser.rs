//! A browser for the tests of pages: Chromium, without a window.

use std::path::{Path, PathBuf};
use std::process::Command;

/// How long a page is given, ms of the browser's own clock, which does not run while the page works; it runs while a frame is being started,
/// and on a busy machine that may take all of it.
const BUDGET_MS: u32 = 300_000;

/// The browser; `None`, said aloud, where there is none.
#[must_use]
pub fn chromium() -> Option<PathBuf> {
    let path = std::env::split_paths(&std::env::var_os("PATH")?)
        .map(|folder| folder.join("chromium"))
        .find(|path| path.exists());
    if path.is_none() {
        eprintln!("skipped: there is no chromium (tests/setup.sh installs it)");
    }
    path
}

/// The folder of what the tests put around pages and into them.
#[must_use]
pub fn scripts() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("browser")
}

/// Shows a page of that text, named as `page` is, in a frame of width and height in pixels. Returns the document around it as HTML, or, where a
/// file for a picture is given, makes that.
///
/// # Panics
/// When the browser cannot be started, or files not written.
pub fn framed(browser: &Path, page: &Path, (width, height): (u32, u32), text: &str, picture: Option<&Path>) -> String {
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let inside = folder.path().join(page.file_name().expect("a page is a file"));
    std::fs::write(&inside, text).expect("the folder is new");
    let around = std::fs::read_to_string(scripts().join("around.html")).expect("it is part of the tests");
    let around = around.replace("PAGE", &inside.display().to_string()).replace("WIDTH", &width.to_string());
    let frame = folder.path().join("around.html");
    std::fs::write(&frame, around.replace("HEIGHT", &height.to_string())).expect("the folder is new");
    let show = picture.map_or("--dump-dom".to_string(), |picture| format!("--screenshot={}", picture.display()));
    browse(browser, &frame, &[format!("--window-size={width},{height}"), show])
}

/// What a browser prints of a page.
fn browse(browser: &Path, page: &Path, words: &[String]) -> String {
    let fixed = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"];
    let profile = tempfile::tempdir().expect("there is a place for temporary files");
    let done = Command::new(browser)
        .args(fixed)
        .arg(format!("--virtual-time-budget={BUDGET_MS}"))
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(words)
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("the browser starts");
    String::from_utf8_lossy(&done.stdout).into_owned()
}

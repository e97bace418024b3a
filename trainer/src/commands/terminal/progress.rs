//! Signs of life on standard error: a spinner on a terminal, a line every few seconds off it.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::output::say;
use indicatif::{ProgressBar, ProgressStyle};

/// Time between two lines off a terminal.
const LINE_EVERY: Duration = Duration::from_secs(3);

/// Shows what a command is doing until it is dropped.
#[derive(Debug)]
pub(crate) enum Reporter {
    Silent,
    Spinner(ProgressBar),
    Lines(Lines),
}

/// The background thread that prints lines.
#[derive(Debug)]
pub(crate) struct Lines {
    current: Arc<Mutex<String>>,
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Reporter {
    /// A reporter that suits standard error, silent where nothing is to be said.
    pub(crate) fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Silent;
        }
        if std::io::stderr().is_terminal() {
            let spinner = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]") {
                spinner.set_style(style);
            }
            spinner.enable_steady_tick(Duration::from_millis(120));
            return Self::Spinner(spinner);
        }
        Self::Lines(Lines::start())
    }

    /// Says what is being done now.
    pub(crate) fn say(&self, what: &str) {
        match self {
            Self::Silent => {}
            Self::Spinner(spinner) => spinner.set_message(what.to_owned()),
            Self::Lines(lines) => {
                if let Ok(mut current) = lines.current.lock() {
                    what.clone_into(&mut current);
                }
            }
        }
    }
}

impl Lines {
    fn start() -> Self {
        let current = Arc::new(Mutex::new(String::new()));
        let shown = Arc::clone(&current);
        let (stop, stopped) = channel();
        let start = Instant::now();
        let thread = std::thread::spawn(move || {
            while stopped.recv_timeout(LINE_EVERY) == Err(RecvTimeoutError::Timeout) {
                let text = shown.lock().map(|text| text.clone()).unwrap_or_default();
                if !text.is_empty() {
                    say(&format!("{:4.0} s  {text}", start.elapsed().as_secs_f64()));
                }
            }
        });
        Self { current, stop: Some(stop), thread: Some(thread) }
    }
}

impl Drop for Reporter {
    fn drop(&mut self) {
        match self {
            Self::Silent => {}
            Self::Spinner(spinner) => spinner.finish_and_clear(),
            Self::Lines(lines) => {
                drop(lines.stop.take());
                if let Some(thread) = lines.thread.take() {
                    // A thread that only prints has nothing to report at its end.
                    let _ = thread.join();
                }
            }
        }
    }
}

/// Largest memory that this process has held, in MB (10^6 bytes); known on Linux.
pub(crate) fn peak_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().strip_suffix(" kB")?;
    Some(kibibytes.parse::<f64>().ok()? * 1024e-6)
}

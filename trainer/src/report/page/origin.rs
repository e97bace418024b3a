//! Where a page comes from: how it was made, by which version, of which recordings.

use std::fmt::Write;

use crate::markup::escape;

/// Where a page comes from; its foot tells it.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// The command that made it, as typed.
    pub command: &'a str,
    /// Name and CRC-64/XZ of the content of each recording.
    pub recordings: &'a [(String, u64)],
    /// What else it depends on, such as filter and seed, in sentences.
    pub settings: &'a str,
}

impl Origin<'_> {
    pub(super) fn html(&self) -> String {
        let mut html = format!(
            "<h2>Made by</h2><pre>{}</pre><p>Frikan {}. {}</p>",
            escape(self.command),
            env!("CARGO_PKG_VERSION"),
            escape(self.settings)
        );
        if !self.recordings.is_empty() {
            html.push_str("<ul>");
            for (name, hash) in self.recordings {
                let _ = write!(html, "<li>{}, CRC-64/XZ {hash:016x}</li>", escape(name));
            }
            html.push_str("</ul>");
        }
        html
    }
}

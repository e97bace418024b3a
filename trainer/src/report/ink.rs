//! Colours of what is drawn, by their role.

use serde::Serialize;

/// Colour of a series, by its role on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Ink {
    /// What was measured.
    Data,
    /// The first thing compared with it.
    One,
    /// The second.
    Two,
    /// The third.
    Three,
}

impl Ink {
    pub(super) fn name(self) -> &'static str {
        match self {
            Ink::Data => "data",
            Ink::One => "one",
            Ink::Two => "two",
            Ink::Three => "three",
        }
    }
}

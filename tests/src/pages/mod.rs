//! What the tests of pages share: the commands that a page shows, a browser that opens it, and how it looks there.

pub mod brightness;
pub mod browser;
pub mod commands;

//! Numbers of MJCF.

/// A number with the digits of single precision, as an image has them.
pub(super) fn plain(value: f64) -> String {
    (value as f32).to_string()
}

//! Columns of numbers as text.

use std::fmt::Write;

/// Named columns of one length as CSV; numbers are the shortest that read back exactly.
pub(crate) fn csv_text(columns: &[(String, &[f64])]) -> String {
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..columns.first().map_or(0, |(_, values)| values.len()) {
        for (index, (_, values)) in columns.iter().enumerate() {
            let separator = if index == 0 { "" } else { "," };
            // Writing to a string cannot fail.
            let _ = write!(text, "{separator}{}", values[row]);
        }
        text.push('\n');
    }
    text
}

//! The date in the name of a file or folder, and the name without it.

use jiff::civil::{Date, DateTime, Time};
use jiff::tz::Offset;

/// Marks that may stand between a name and its date.
const SEPARATORS: [char; 5] = ['-', '_', '.', ' ', '/'];

/// Years that are taken for one.
const YEARS: std::ops::Range<i16> = 1970..2100;

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// Takes the last date (`2025-03-01`, `20250301`, `2025_03_01`, with or without a time such as `T1430` or `_14-30-05` behind it) out of a
/// path: the path without it, and the date as ISO 8601.
pub(super) fn without_date(path: &str) -> (String, Option<String>) {
    let starts = (0..path.len()).rev();
    let Some((start, end, stamp)) =
        starts.filter_map(|start| Some((start, stamp_at(path, start)?))).map(|(a, (b, s))| (a, b, s)).next()
    else {
        return (path.to_owned(), None);
    };
    let (left, right) = (path[..start].trim_end_matches(SEPARATORS), &path[end..]);
    let folder = if path[left.len()..start].contains('/') && !right.is_empty() { "/" } else { "" };
    let right = if folder.is_empty() && !left.is_empty() { right } else { right.trim_start_matches(SEPARATORS) };
    let text = if stamp.time() == Time::midnight() { stamp.date().to_string() } else { stamp.to_string() };
    (format!("{left}{folder}{right}"), Some(text))
}

/// Days since 1970 of a date that [`without_date`] has found.
pub(super) fn day(stamp: &str) -> Option<f64> {
    let time = stamp.parse::<DateTime>().ok()?;
    Some(Offset::UTC.to_timestamp(time).ok()?.as_second() as f64 / DAY_S)
}

/// The date that begins at a byte of a text, and the byte behind it.
fn stamp_at(text: &str, start: usize) -> Option<(usize, DateTime)> {
    let mut fields = Fields { text: text.as_bytes(), at: start };
    if start > 0 && fields.is_digit(start - 1) {
        return None;
    }
    let year = fields.take(4, b"").filter(|year| YEARS.contains(year))?;
    let (month, day) = (fields.take(2, b"-_")?, fields.take(2, b"-_")?);
    let date = Date::new(year, i8::try_from(month).ok()?, i8::try_from(day).ok()?).ok()?;
    let behind = fields.at;
    let time = fields.time();
    if time.is_none() {
        fields.at = behind;
    }
    let ends = !fields.is_digit(fields.at);
    ends.then(|| (fields.at, date.to_datetime(time.unwrap_or(Time::midnight()))))
}

/// Numbers of fixed width, one behind the other.
struct Fields<'a> {
    text: &'a [u8],
    at: usize,
}

impl Fields<'_> {
    fn is_digit(&self, at: usize) -> bool {
        self.text.get(at).is_some_and(u8::is_ascii_digit)
    }

    /// So many digits behind one of the marks or none.
    fn take(&mut self, digits: usize, marks: &[u8]) -> Option<i16> {
        let start = self.at + usize::from(self.text.get(self.at).is_some_and(|mark| marks.contains(mark)));
        let field = self.text.get(start..start + digits).filter(|field| field.iter().all(u8::is_ascii_digit))?;
        self.at = start + digits;
        std::str::from_utf8(field).ok()?.parse().ok()
    }

    /// Hours and minutes, with or without seconds.
    fn time(&mut self) -> Option<Time> {
        let (hour, minute) = (self.take(2, b"T_- ")?, self.take(2, b":-")?);
        let second = self.take(2, b":-").unwrap_or(0);
        Time::new(i8::try_from(hour).ok()?, i8::try_from(minute).ok()?, i8::try_from(second).ok()?, 0).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_taken_out_of_names_and_folders() {
        for (path, name, date) in [
            ("arm/elbow/2025-03-01", "arm/elbow", "2025-03-01"),
            ("elbow_20250301", "elbow", "2025-03-01"),
            ("elbow_20250301T1430", "elbow", "2025-03-01T14:30:00"),
            ("2025_03_01_14-30-05_elbow", "elbow", "2025-03-01T14:30:05"),
            ("2025-03-01/arm7/elbow", "arm7/elbow", "2025-03-01"),
            ("cell2/2025-03-01/elbow", "cell2/elbow", "2025-03-01"),
            ("cell2/20250301-elbow", "cell2/elbow", "2025-03-01"),
            ("sn00012025-2024-12-31", "sn00012025", "2024-12-31"),
        ] {
            assert_eq!(without_date(path), (name.to_owned(), Some(date.to_owned())), "{path}");
        }
        for path in ["elbow", "elbow-17", "sn120250301", "2025-13-01", "run-20259901", "größe 7"] {
            assert_eq!(without_date(path), (path.to_owned(), None));
        }
    }

    #[test]
    fn days_are_counted() {
        assert_eq!((day("1970-01-02"), day("1970-01-01T12:00:00"), day("soon")), (Some(1.0), Some(0.5), None));
    }
}

//! The time column: numbers in a unit, epochs, seconds with nanoseconds beside them, calendar times; kept to the last digit.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::Offset;

use super::quantity::{Quantity, Unit};
use super::table::{EXACT, RawTable};

/// How the cells of the time column are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reading {
    /// A number in the column's unit.
    Number,
    /// ISO 8601, as in `2024-05-01T12:00:00.25+02:00`; UTC where it names no zone.
    Calendar,
    /// Whole seconds, with the nanoseconds in the column of this index.
    WithNanoseconds(usize),
}

/// A time column that says its unit by what it holds.
pub(super) struct SelfTold {
    pub(super) index: usize,
    pub(super) unit: &'static Unit,
    pub(super) reading: Reading,
}

/// Names of time columns that say no unit, in small letters.
const NAMES: [&str; 12] = [
    "time",
    "t",
    "timestamp",
    "timestamps",
    "stamp",
    "datetime",
    "date_time",
    "date",
    "log_time",
    "publish_time",
    "__time",
    "header.stamp",
];

/// Units of time with the number of digits that a date between 2001 and 2286 has in them, counted from 1970.
const EPOCH_DIGITS: [(usize, &str); 4] = [(10, "s"), (13, "ms"), (16, "us"), (19, "ns")];

/// Stamps from here on are counted from the first one: a double no longer holds nanoseconds, s.
pub(super) const LONG_AGO_S: f64 = EXACT;

/// The time column among columns whose names say no unit: a pair of seconds and nanoseconds, a calendar, or an epoch.
pub(super) fn self_told(raw: &RawTable) -> Option<SelfTold> {
    let header = raw.table.header();
    if let Some(pair) = seconds_and_nanoseconds(header) {
        return Some(pair);
    }
    let first = |index: usize| raw.table.cell(0, index);
    let named = |index: &usize| is_named(&header[*index]);
    if let Some(index) = (0..header.len()).filter(named).find(|index| is_calendar_time(first(*index))) {
        return Some(SelfTold { index, unit: unit("s")?, reading: Reading::Calendar });
    }
    let epoch = |index: usize| epoch_unit(first(index)).map(|unit| SelfTold { index, unit, reading: Reading::Number });
    if let Some(found) = (0..header.len()).filter(named).find_map(epoch) {
        return Some(found);
    }
    // PlotJuggler's own time is in seconds, counted from anywhere.
    let index = header.iter().position(|name| name == "__time")?;
    Some(SelfTold { index, unit: unit("s")?, reading: Reading::Number })
}

/// Whether a column is a time by its name, unit or not.
pub(super) fn is_named(name: &str) -> bool {
    let name = name.to_ascii_lowercase().replace(' ', "_");
    let last = name.rsplit('/').next().unwrap_or(&name);
    NAMES.contains(&last) || last.ends_with("header.stamp")
}

/// Whether a cell is an ISO 8601 date and time.
pub(super) fn is_calendar_time(cell: &str) -> bool {
    calendar(cell).is_some()
}

/// How a column is read that is known to be the time.
pub(super) fn reading_of(raw: &RawTable, index: usize) -> Reading {
    if is_calendar_time(raw.table.cell(0, index)) { Reading::Calendar } else { Reading::Number }
}

/// The time of row `row` in billionths of the column's unit; `None` where it cannot be read.
pub(super) fn ticks(raw: &RawTable, row: usize, index: usize, reading: Reading) -> Option<i128> {
    let number = |index: usize| match raw.table.kept(row, index) {
        Some(cell) => decimal(cell, raw.decimal_comma),
        None => Some(raw.numbers[index].values[row]).filter(|number| number.is_finite()).and_then(billionths),
    };
    match reading {
        Reading::Number => number(index),
        Reading::Calendar => calendar(raw.table.cell(row, index)),
        Reading::WithNanoseconds(other) => Some(number(index)?.saturating_add(number(other)? / 1_000_000_000)),
    }
}

/// Seconds from ticks of `seconds_per_unit`; counted from the first row where a double would lose digits. The second is whether they were.
pub(super) fn seconds(ticks: &[i128], seconds_per_unit: f64, reading: Reading) -> (Vec<f64>, bool) {
    let scale = 1e-9 * seconds_per_unit;
    let first = ticks.first().copied().unwrap_or(0);
    let from_first = reading == Reading::Calendar || (first as f64 * scale).abs() >= LONG_AGO_S;
    let zero = if from_first { first } else { 0 };
    // Divided where that is exact: 4 ms of ns ticks are 0.004 s to the last bit.
    let per_second = scale.recip().round();
    let exact = (per_second * scale - 1.0).abs() < 1e-12;
    let value = |tick: &i128| {
        let count = tick.saturating_sub(zero) as f64;
        if exact { count / per_second } else { count * scale }
    };
    (ticks.iter().map(value).collect(), from_first)
}

fn unit(suffix: &str) -> Option<&'static Unit> {
    Quantity::Time.unit(suffix)
}

fn seconds_and_nanoseconds(header: &[String]) -> Option<SelfTold> {
    const PAIRS: [(&str, &str); 4] =
        [("nanosec", "sec"), ("nsecs", "secs"), ("nsec", "sec"), ("nanoseconds", "seconds")];
    for (index, name) in header.iter().enumerate() {
        for (short, long) in PAIRS {
            let Some(prefix) = name.strip_suffix(short) else { continue };
            let whole = format!("{prefix}{long}");
            if let Some(seconds) = header.iter().position(|other| *other == whole) {
                return Some(SelfTold { index: seconds, unit: unit("s")?, reading: Reading::WithNanoseconds(index) });
            }
        }
    }
    None
}

/// The unit in which a number is a date of our days, by its digits before the point.
fn epoch_unit(cell: &str) -> Option<&'static Unit> {
    let value = cell.parse::<f64>().ok().filter(|value| *value >= 1e9)?;
    let digits = value.log10() as usize + 1;
    let (_, suffix) = EPOCH_DIGITS.iter().find(|(count, _)| *count == digits)?;
    unit(suffix)
}

/// A decimal number in billionths, what is beyond them cut off.
fn decimal(cell: &str, decimal_comma: bool) -> Option<i128> {
    let (mantissa, exponent) = match cell.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (cell, 0),
    };
    let (negative, digits) = match mantissa.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, mantissa.strip_prefix('+').unwrap_or(mantissa)),
    };
    let point = if decimal_comma && !digits.contains('.') { ',' } else { '.' };
    let (whole, fraction) = digits.split_once(point).unwrap_or((digits, ""));
    if whole.len() + fraction.len() == 0 || !whole.bytes().chain(fraction.bytes()).all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let mut value: i128 = 0;
    for digit in whole.bytes().chain(fraction.bytes()) {
        value = value.checked_mul(10)?.checked_add(i128::from(digit - b'0'))?;
    }
    let power = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?.checked_add(9)?;
    let ten = 10_i128.checked_pow(power.unsigned_abs());
    let scaled = if power >= 0 { value.checked_mul(ten?)? } else { ten.map_or(0, |ten| value / ten) };
    Some(if negative { -scaled } else { scaled })
}

/// A finite number in billionths, as far as it holds them.
fn billionths(number: f64) -> Option<i128> {
    let whole = number.trunc();
    (whole as i128).checked_mul(1_000_000_000)?.checked_add(((number - whole) * 1e9).round() as i128)
}

/// A calendar time in nanoseconds since 1970.
fn calendar(cell: &str) -> Option<i128> {
    let bytes = cell.as_bytes();
    let separated = bytes.len() >= 16 && matches!(bytes[4], b'-' | b'/') && matches!(bytes[10], b'T' | b't' | b' ');
    if !separated || !bytes[..4].iter().all(u8::is_ascii_digit) {
        return None;
    }
    let text = cell.replace('/', "-");
    let zoned = text.parse::<Timestamp>().ok();
    let time = zoned.or_else(|| Offset::UTC.to_timestamp(text.parse::<DateTime>().ok()?).ok())?;
    Some(time.as_nanosecond())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_read_to_the_billionth() {
        for (text, expected) in [
            ("1700000000.123456789", 1_700_000_000_123_456_789),
            ("1.700000000123456789e+09", 1_700_000_000_123_456_789),
            ("-0.5", -500_000_000),
            ("+.25", 250_000_000),
            ("3e-10", 0),
            ("1714557600000000123", 1_714_557_600_000_000_123_000_000_000),
        ] {
            assert_eq!(decimal(text, false), Some(expected), "{text}");
        }
        assert_eq!(decimal("1,5", true), Some(1_500_000_000));
        for text in ["", "-", ".", "1e", "nan", "1,5", "1e400", "0x10"] {
            assert_eq!(decimal(text, false), None, "{text}");
        }
    }

    /// No clock counts so far, and what damaged files hold is no arithmetic to panic about.
    #[test]
    fn numbers_beyond_any_clock_are_read_or_refused() {
        assert_eq!((billionths(1.5), billionths(1e30)), (Some(1_500_000_000), None));
        let far = i128::MAX / 2 + 9;
        let (seconds, _) = seconds(&[-far, far], 1.0, Reading::Number);
        assert!(seconds.iter().all(|time| time.is_finite()), "{seconds:?}");
    }

    #[test]
    fn calendar_times_with_and_without_zone_are_read() {
        let noon = calendar("2024-05-01T12:00:00Z").unwrap();
        assert_eq!(calendar("2024-05-01 12:00:00.000000001"), Some(noon + 1));
        assert_eq!(calendar("2024/05/01 12:00:00.5"), Some(noon + 500_000_000));
        assert_eq!(calendar("2024-05-01T14:00:00+02:00"), Some(noon));
        for text in ["2024-05-01", "2024-13-01T12:00:00", "12:00:00", "hello, my friends", "ééééééééé"] {
            assert_eq!(calendar(text), None, "{text}");
        }
    }

    #[test]
    fn epochs_are_told_by_their_digits() {
        for (text, suffix) in
            [("1714557600.5", "s"), ("1714557600500", "ms"), ("1714557600500000", "us"), ("1714557600500000000", "ns")]
        {
            assert_eq!(epoch_unit(text).unwrap().suffix, suffix);
        }
        for text in ["0", "12.5", "123456789", "17145576005", "x"] {
            assert!(epoch_unit(text).is_none(), "{text}");
        }
    }
}

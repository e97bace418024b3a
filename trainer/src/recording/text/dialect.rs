//! How a delimited text is laid out, told from its beginning: separator, lines before the header, a row of units, a header in a comment.

use super::records::Records;
use crate::recording::clock::is_calendar_time;
use crate::recording::names::is_unit;
use crate::recording::vectors;

/// Records at the start of a text among which header and first row of data are looked for.
const RECORDS_LOOKED_AT: usize = 200;

/// Separators, the one that wins a tie first.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// How a text is laid out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dialect {
    pub(super) separator: u8,
    /// Records before the first row of data.
    pub(super) leading: usize,
    pub(super) header: Header,
}

/// Where the names of the columns stand.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Header {
    /// In the record of this index, with a row of units behind it or not.
    Record { index: usize, units: bool },
    /// In a comment.
    Comment(Vec<String>),
    /// Nowhere: the first record is data.
    Absent,
}

/// A separator's reading of the beginning, the better the larger: share of numbers in the first row of data, and their count.
type Score = (f64, usize);

/// Tells the layout of a text from its first bytes; `whole` where they are all of it.
pub(super) fn dialect_of(probe: &[u8], whole: bool) -> Dialect {
    let mut best: Option<(Score, Dialect)> = None;
    for separator in SEPARATORS {
        let records = leading_records(probe, whole, separator);
        if let Some((score, dialect)) = layout(&records, separator, probe)
            && best.as_ref().is_none_or(|(other, _)| score > *other)
        {
            best = Some((score, dialect));
        }
    }
    best.map_or_else(|| of_first_line(probe), |(_, dialect)| dialect)
}

/// Where there is no row of data behind a header: the first record is the header, its most frequent separator is that of the text.
fn of_first_line(probe: &[u8]) -> Dialect {
    let mut lines = probe.split(|byte| matches!(byte, b'\n' | b'\r'));
    let first = lines.find(|line| !line.is_empty() && line[0] != b'#').unwrap_or_default();
    let count = |separator: &u8| first.iter().filter(|byte| *byte == separator).count();
    let separator = SEPARATORS.into_iter().rev().max_by_key(count).unwrap_or(b',');
    let fields = leading_records(first, true, separator).into_iter().next().unwrap_or_default();
    let numbers = !fields.is_empty() && fields.iter().all(|field| field.parse::<f64>().is_ok());
    if numbers {
        return Dialect { separator, leading: 0, header: Header::Absent };
    }
    Dialect { separator, leading: 1, header: Header::Record { index: 0, units: false } }
}

/// The records of the beginning, as far as it holds them whole.
pub(super) fn leading_records(probe: &[u8], whole: bool, separator: u8) -> Vec<Vec<String>> {
    let mut records = Records::new(probe, separator);
    let mut found = Vec::new();
    while found.len() < RECORDS_LOOKED_AT && matches!(records.advance(), Ok(true)) {
        found.push(records.fields().map(|field| String::from_utf8_lossy(field).into_owned()).collect());
    }
    // The last record may have been cut.
    if !whole && found.len() < RECORDS_LOOKED_AT {
        found.pop();
    }
    found
}

/// The first row with the largest share of numbers behind a header of its width; without any header, the first row of numbers.
fn layout(records: &[Vec<String>], separator: u8, probe: &[u8]) -> Option<(Score, Dialect)> {
    let mut best: Option<(Score, Dialect)> = None;
    for (index, row) in records.iter().enumerate() {
        let numbers = row.iter().filter(|cell| is_value(cell, separator)).count();
        let score = (numbers as f64 / row.len() as f64, numbers);
        if row.len() < 2 || numbers == 0 || best.as_ref().is_some_and(|(other, _)| other.0 >= score.0) {
            continue;
        }
        let words = |at: Option<usize>| {
            let record = &records[at?];
            (record.len() == row.len() && record.iter().all(|cell| !is_value(cell, separator))).then_some(record)
        };
        let (before, above) = (words(index.checked_sub(1)), words(index.checked_sub(2)));
        let mut leading = index;
        let header = match (before, above) {
            (Some(units), Some(names)) if mostly_units(units) && !mostly_units(names) => {
                Header::Record { index: index - 2, units: true }
            }
            (Some(_), _) => Header::Record { index: index - 1, units: false },
            // A header that holds a number, as in a column named 0, is one all the same where it is the first record.
            (None, _) if index == 1 && is_header(&records[0], row) => Header::Record { index: 0, units: false },
            (None, _) if index == 0 => commented(probe, separator, row.len()).map_or(Header::Absent, Header::Comment),
            // Broken rows may stand between: they are told when they are read.
            (None, _) if words(Some(0)).is_some() => {
                leading = 1;
                Header::Record { index: 0, units: false }
            }
            (None, _) => continue,
        };
        best = Some((score, Dialect { separator, leading, header }));
    }
    best
}

/// Names of which some are no number, as many as the row has fields.
fn is_header(record: &[String], row: &[String]) -> bool {
    record.len() == row.len() && record.iter().any(|cell| !cell.is_empty() && cell.parse::<f64>().is_err())
}

/// A number, a calendar time, or a list of them.
fn is_value(cell: &str, separator: u8) -> bool {
    let number = |text: &str| text.parse::<f64>().is_ok();
    number(cell)
        || (separator != b',' && !cell.contains('.') && number(&cell.replacen(',', ".", 1)))
        || is_calendar_time(cell)
        || vectors::elements(cell).is_some_and(|mut elements| elements.next().is_some_and(number))
}

fn mostly_units(record: &[String]) -> bool {
    let filled = || record.iter().filter(|cell| !cell.is_empty());
    2 * filled().filter(|cell| is_unit(cell)).count() > filled().count()
}

/// The last comment before the first record that has as many words as the row has fields.
fn commented(probe: &[u8], separator: u8, width: usize) -> Option<Vec<String>> {
    let text = String::from_utf8_lossy(probe);
    let text = text.trim_start_matches('\u{feff}');
    let comments = text.lines().take_while(|line| line.trim().is_empty() || line.starts_with('#'));
    let names = |line: &str| {
        let line = line.trim_start_matches(['#', ' ', '\t']);
        let separated: Vec<String> = line.split(char::from(separator)).map(|name| name.trim().to_owned()).collect();
        let spaced = || line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        [separated, spaced()].into_iter().find(|names| names.len() == width)
    };
    comments.filter_map(names).last()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn told(text: &str, separator: char, leading: usize, header: Header) {
        let expected = Dialect { separator: separator as u8, leading, header };
        assert_eq!(dialect_of(text.as_bytes(), true), expected, "{text}");
    }

    #[test]
    fn preambles_units_and_separators_are_told_apart() {
        let record = |index, units| Header::Record { index, units };
        told("a,b\n1,2\n", ',', 1, record(0, false));
        told("a;b;c\n1,5;2,5;3\n", ';', 1, record(0, false));
        told("Zeit, s;Weg, mm\n0,1;0,2\n", ';', 1, record(0, false));
        told("Drive log\nRate,1000\n\ntime,torque,state\ns,Nm,\n0.1,2,run\n", ',', 4, record(2, true));
        told("Rate,1000\ntime,torque\n0.1,2\n", ',', 2, record(1, false));
        told("time\ttorque\n[s]\t[Nm]\n0\t1\n", '\t', 2, record(0, true));
        told("time,q\n2024-05-01T12:00:00Z,x\n", ',', 1, record(0, false));
        told("q,tau\n\"[1, 2]\",\"[3, 4]\"\n", ',', 1, record(0, false));
    }

    #[test]
    fn a_header_may_stand_in_a_comment_or_nowhere() {
        let names = |names: &[&str]| Header::Comment(names.iter().map(|name| (*name).to_owned()).collect());
        told("# saved by hand\n# time_s torque_Nm\n0,1\n1,2\n", ',', 0, names(&["time_s", "torque_Nm"]));
        told("0,1\n1,2\n", ',', 0, Header::Absent);
    }

    #[test]
    fn a_broken_row_does_not_move_the_header() {
        let record = Header::Record { index: 0, units: false };
        told("a,b,c\nx,1,2\n1,2,3\n", ',', 1, record.clone());
        told("a,b,c\n1,2\n1,2,3\na,b,c\n1,2,3\n", ',', 1, record.clone());
        told("a,b,c\n", ',', 1, record);
    }
}

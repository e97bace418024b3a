//! A recording that is longer than the memory allows is read in stretches spread over it: each time that the room is full, every other one is let go
//! of, and of what follows only as many are taken.

use std::ops::Range;

/// Rows of a stretch: half a minute at a thousand rows a second, long beside every filter and memory of a joint.
pub(crate) const STRETCH_ROWS: usize = 1 << 15;
/// Memory of the program beside what grows with the rows, B (docs/size.md).
const AT_LEAST_BYTES: f64 = 1e8;
/// Memory of a row beside its columns at most, B: copies that are filtered, sorted and scored one after the other (docs/size.md).
const BYTES_BESIDE_COLUMNS: f64 = 40.0;

/// Which rows of a file are kept.
#[derive(Clone, Debug)]
pub(in crate::recording) struct Thinning {
    stretch_rows: usize,
    /// Rows that there is room for: an even number of stretches.
    room: usize,
    /// One in so many stretches is kept.
    every: usize,
    /// Rows that were offered.
    offered: usize,
}

impl Thinning {
    /// Keeps all rows.
    pub(in crate::recording) fn none() -> Self {
        Self { stretch_rows: STRETCH_ROWS, room: usize::MAX, every: 1, offered: 0 }
    }

    /// Keeps within a memory, B, for a table of so many columns; two stretches at least.
    pub(in crate::recording) fn within(memory_bytes: f64, columns: usize) -> Self {
        let rows = (memory_bytes - AT_LEAST_BYTES) / (8.0 * columns as f64 + BYTES_BESIDE_COLUMNS);
        Self::of(STRETCH_ROWS, rows.max(0.0) as usize)
    }

    fn of(stretch_rows: usize, most_rows: usize) -> Self {
        let pairs = (most_rows / (2 * stretch_rows)).max(1);
        Self { stretch_rows, room: 2 * stretch_rows * pairs, ..Self::none() }
    }

    /// Whether the next row of the file is kept.
    pub(in crate::recording) fn takes_next(&mut self) -> bool {
        let stretch = self.offered / self.stretch_rows;
        self.offered += 1;
        stretch.is_multiple_of(self.every)
    }

    /// The stretches of so many rows that stay where another one has no room; `None` where it has.
    pub(in crate::recording) fn make_room(&mut self, rows: usize) -> Option<Vec<Range<usize>>> {
        if rows < self.room {
            return None;
        }
        self.every *= 2;
        Some((0..rows).step_by(2 * self.stretch_rows).map(|start| start..start + self.stretch_rows).collect())
    }

    /// What was left out, in a sentence.
    pub(in crate::recording) fn note(&self) -> Option<String> {
        (self.every > 1).then(|| {
            format!(
                "longer than the memory allows: one in {} stretches of {} rows is read; `--memory` allows for more",
                self.every, self.stretch_rows
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn however_long_a_file_is_stretches_over_all_of_it_are_kept() {
        for length in [50, 80, 81, 200, 1000, 12_345] {
            let mut thinning = Thinning::of(10, 95);
            let mut kept: Vec<usize> = Vec::new();
            for row in 0..length {
                // Where the stretch is not among those that stay, the row that asked for the room is not either.
                if !thinning.takes_next() {
                    continue;
                }
                if let Some(stay) = thinning.make_room(kept.len()) {
                    kept = stay.into_iter().flat_map(|stretch| kept[stretch].to_vec()).collect();
                }
                kept.push(row);
                assert!(kept.len() <= 80);
            }
            assert!(kept.len() >= 40 && (length > 80 || kept.len() == length), "{length}: {}", kept.len());
            let expected = |row: &usize| (row / 10).is_multiple_of(thinning.every);
            assert!(kept.iter().copied().eq((0..length).filter(expected)), "{length}");
            assert_eq!(thinning.note().is_some(), length > 80);
        }
    }

    #[test]
    fn a_gigabyte_holds_ten_million_rows_of_five_columns() {
        assert!(Thinning::within(1e9, 5).room >= 10_000_000);
        assert_eq!(Thinning::within(0.0, 5).room, 2 * STRETCH_ROWS);
    }
}

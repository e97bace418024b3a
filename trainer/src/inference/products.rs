//! Products of many columns with one another, in a fixed order: the same bits on every processor.

use nalgebra::DMatrix;
use rayon::prelude::*;

/// Columns side by side in a tile: two tiles of eight sums each stay in the registers of a processor without vectors of its own.
const TILE: usize = 8;
/// Rows of a panel: two panels of a tile stay in the first cache.
const PANEL_ROWS: usize = 512;

/// Products of every column with every other, `X'X`; columns of one length. Every sum runs over the rows in order, panel by panel, so
/// that neither the number of threads nor the width of the processor's vectors changes a bit.
pub(crate) fn products(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let width = columns.len();
    let rows = columns.first().map_or(0, Vec::len);
    let tiles = width.div_ceil(TILE);
    let packed: Vec<Vec<[f64; TILE]>> = (0..tiles).into_par_iter().map(|tile| packed(columns, tile, rows)).collect();
    let blocks: Vec<(usize, usize, [[f64; TILE]; TILE])> = (0..tiles)
        .into_par_iter()
        .flat_map_iter(|a| (a..tiles).map(move |b| (a, b)))
        .map(|(a, b)| (a, b, tile_product(&packed[a], &packed[b])))
        .collect();
    let mut gram = DMatrix::zeros(width, width);
    for (a, b, block) in blocks {
        for (i, row) in block.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                let (i, j) = (a * TILE + i, b * TILE + j);
                if i < width && j < width {
                    gram[(i, j)] = value;
                    gram[(j, i)] = value;
                }
            }
        }
    }
    gram
}

/// Columns of a tile, row by row; zero beyond the last column.
fn packed(columns: &[Vec<f64>], tile: usize, rows: usize) -> Vec<[f64; TILE]> {
    let mut packed = vec![[0.0; TILE]; rows];
    for (lane, column) in columns.iter().skip(tile * TILE).take(TILE).enumerate() {
        for (row, value) in packed.iter_mut().zip(column) {
            row[lane] = *value;
        }
    }
    packed
}

fn tile_product(a: &[[f64; TILE]], b: &[[f64; TILE]]) -> [[f64; TILE]; TILE] {
    let mut total = [[0.0; TILE]; TILE];
    for (a, b) in a.chunks(PANEL_ROWS).zip(b.chunks(PANEL_ROWS)) {
        let panel = pulp::Arch::new().dispatch(|| panel_product(a, b));
        for (total, panel) in total.iter_mut().flatten().zip(panel.iter().flatten()) {
            *total += panel;
        }
    }
    total
}

#[inline(always)]
fn panel_product(a: &[[f64; TILE]], b: &[[f64; TILE]]) -> [[f64; TILE]; TILE] {
    let mut sums = [[0.0; TILE]; TILE];
    for (a, b) in a.iter().zip(b) {
        for (sums, x) in sums.iter_mut().zip(a) {
            for (sum, y) in sums.iter_mut().zip(b) {
                *sum += x * y;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_product_is_the_sum_over_the_rows() {
        let value = |i: usize, j: usize| ((7 * i + 13 * j) % 23) as f64 - 11.0;
        let columns: Vec<Vec<f64>> = (0..19).map(|j| (0..1301).map(|i| value(i, j)).collect()).collect();
        let gram = products(&columns);
        for a in 0..19 {
            for b in 0..19 {
                let expected: f64 = (0..1301).map(|i| value(i, a) * value(i, b)).sum();
                assert_eq!(gram[(a, b)], expected, "whole numbers add without rounding");
            }
        }
        assert_eq!(products(&[]).len(), 0);
    }
}

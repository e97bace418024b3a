//! Pictures as coarse maps of brightness, which the version of a browser and the smoothing of its letters hardly change.

use std::path::Path;

use zune_png::zune_core::bit_depth::BitDepth;
use zune_png::zune_core::bytestream::ZCursor;
use zune_png::zune_core::colorspace::ColorSpace;
use zune_png::zune_core::options::EncoderOptions;
use zune_png::{PngDecoder, PngEncoder};

/// Width and height of a cell, pixels of the picture: as large as a letter.
const CELL: usize = 16;
/// Difference of a cell's mean brightness (0 to 255) from which it looks otherwise: a curve two pixels wide through a white cell makes twice as much.
const VISIBLE: u8 = 8;

/// Mean brightness of square cells, row by row; what is left at the right and at the bottom is not seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Brightness {
    columns: usize,
    cells: Vec<u8>,
}

impl Brightness {
    /// Of a picture.
    ///
    /// # Panics
    /// When the file is no PNG picture of eight bits a colour.
    #[must_use]
    pub fn of_picture(file: &Path) -> Self {
        let (width, pixels) = greys(file);
        let (columns, rows) = (width / CELL, pixels.len() / width / CELL);
        let mean = |row: usize, column: usize| {
            let line = |y: usize| &pixels[(row * CELL + y) * width + column * CELL..][..CELL];
            let sum: u32 = (0..CELL).flat_map(line).map(|&grey| u32::from(grey)).sum();
            u8::try_from(sum / (CELL * CELL) as u32).expect("a mean of bytes is one")
        };
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        Self { columns, cells: cells.map(|(row, column)| mean(row, column)).collect() }
    }

    /// As [`save`](Self::save) wrote it: a picture with a pixel for each cell.
    ///
    /// # Panics
    /// When the file is no PNG picture of eight bits a colour.
    #[must_use]
    pub fn load(file: &Path) -> Self {
        let (columns, cells) = greys(file);
        Self { columns, cells }
    }

    /// Writes it as a picture with a pixel for each cell.
    ///
    /// # Panics
    /// When the file cannot be written.
    pub fn save(&self, file: &Path) {
        let rows = self.cells.len() / self.columns;
        let options = EncoderOptions::new(self.columns, rows, ColorSpace::Luma, BitDepth::Eight);
        let mut png = Vec::new();
        PngEncoder::new(&self.cells, options).encode(&mut png).expect("memory can be written");
        std::fs::write(file, png).expect("it can be written");
    }

    /// Share of the cells that look otherwise in `other`; 1 where the two differ in size.
    #[must_use]
    pub fn share_changed(&self, other: &Self) -> f64 {
        if (self.columns, self.cells.len()) != (other.columns, other.cells.len()) {
            return 1.0;
        }
        let changed = self.cells.iter().zip(&other.cells).filter(|(a, b)| a.abs_diff(**b) > VISIBLE).count();
        changed as f64 / self.cells.len() as f64
    }
}

/// Width of a picture and the brightness of its pixels, row by row (luma of ITU-R BT.601).
fn greys(file: &Path) -> (usize, Vec<u8>) {
    let mut decoder = PngDecoder::new(ZCursor::new(std::fs::read(file).expect("there is a picture")));
    let bytes = decoder.decode_raw().expect("it is a PNG picture");
    let (width, height) = decoder.dimensions().expect("it is decoded");
    let luma = |pixel: &[u8]| match pixel {
        [red, green, blue, ..] => {
            let sum = 299 * u32::from(*red) + 587 * u32::from(*green) + 114 * u32::from(*blue);
            u8::try_from(sum / 1000).expect("a mean of bytes is one")
        }
        greys => greys[0],
    };
    (width, bytes.chunks_exact(bytes.len() / (width * height)).map(luma).collect())
}

//! An image in Python: the law as the drive computes it.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::image_crc32;
use frikan_shared::model::MAX_INPUTS;
use frikan_trainer::export::readable::readable;
use frikan_trainer::fit::{CELLS, HostModel, model};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::failure::raise;

/// A model image.
#[pyclass(frozen)]
pub struct Image {
    bytes: Vec<u8>,
    image: Box<frikan_shared::image::Image<CELLS>>,
}

impl Image {
    /// The model that it holds.
    pub fn model(&self) -> &HostModel {
        &self.image.model
    }
}

#[pymethods]
impl Image {
    #[new]
    fn new(py: Python<'_>, bytes: Vec<u8>) -> PyResult<Self> {
        let image = model::from_bytes(&bytes).map_err(|error| raise(py, &error))?;
        Ok(Self { bytes, image })
    }

    /// The bytes of the file.
    fn content<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.bytes)
    }

    /// Everything that it says, as JSON.
    fn json(&self) -> String {
        readable(&self.bytes, &self.image)
    }

    /// CRC-32 of the image.
    fn crc32(&self) -> Option<u32> {
        image_crc32(&self.bytes).ok()
    }

    /// Name, unit and trained range of each input, in the order in which values are given.
    fn inputs(&self) -> Vec<(String, String, f32, f32)> {
        let inputs = self.image.model.inputs.iter();
        inputs.map(|i| (i.quantity.name().to_owned(), i.unit.symbol().to_owned(), i.low, i.high)).collect()
    }

    /// The law at values of the inputs: one block of 32-bit floats in the machine's order for each input, all of one length, or empty for
    /// an input that is 0 throughout. So is the result.
    fn evaluate<'py>(&self, py: Python<'py>, columns: Vec<Vec<u8>>) -> PyResult<Bound<'py, PyBytes>> {
        let rows = columns.iter().map(Vec::len).max().unwrap_or(0) / size_of::<f32>();
        let is_whole = |column: &Vec<u8>| column.is_empty() || column.len() == rows * size_of::<f32>();
        if columns.len() > MAX_INPUTS || !columns.iter().all(is_whole) {
            return Err(PyValueError::new_err("inputs have to have one length"));
        }
        let out = py.detach(|| {
            let mut out = Vec::with_capacity(rows * size_of::<f32>());
            for row in 0..rows {
                let mut point = [0.0; MAX_INPUTS];
                for (value, column) in point.iter_mut().zip(&columns) {
                    *value = float_at(column, row);
                }
                out.extend(evaluate(self.model(), &point).to_ne_bytes());
            }
            out
        });
        Ok(PyBytes::new(py, &out))
    }
}

/// The float of a row; 0 in an empty column.
fn float_at(column: &[u8], row: usize) -> f32 {
    let bytes = column.as_chunks::<{ size_of::<f32>() }>().0.get(row);
    bytes.map_or(0.0, |bytes| f32::from_ne_bytes(*bytes))
}

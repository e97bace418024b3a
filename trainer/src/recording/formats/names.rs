//! Names of columns in the order in which a file first mentions them.

use std::collections::HashMap;

/// Names with their places.
#[derive(Default)]
pub(super) struct Names {
    pub in_order: Vec<String>,
    places: HashMap<String, usize>,
}

impl Names {
    /// Place of a name, which is the next one where it is new.
    pub fn place(&mut self, name: &str) -> usize {
        if let Some(place) = self.places.get(name) {
            return *place;
        }
        let place = self.in_order.len();
        self.in_order.push(name.to_owned());
        self.places.insert(name.to_owned(), place);
        place
    }
}

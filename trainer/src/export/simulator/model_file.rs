//! The user's own model file: its text, its joint, and what is wrong with it.

use roxmltree::{Document, Node};

use crate::error::{Error, Result, codes};

/// A model file of the user.
#[derive(Clone, Copy, Debug, Default)]
pub struct ModelFile<'a> {
    /// Its text; empty where the format only refers to it.
    pub text: &'a str,
    /// Its path, for formats that refer to it.
    pub path: &'a str,
    /// Name of the joint in it.
    pub joint: &'a str,
    /// Inertia of its bodies about the joint, kg m2 (kg along a linear axis), where it is given.
    pub inertia_of_model: Option<f64>,
    /// Gains of the controller that moves the joint, N m/rad and N m s/rad (N/m and N s/m), where they are given.
    pub gains: Option<[f64; 2]>,
}

impl<'a> ModelFile<'a> {
    /// The file as XML.
    pub(super) fn parsed(&self) -> Result<Document<'a>> {
        Document::parse(self.text)
            .map_err(|error| Error::new(&codes::BAD_MODEL_FILE, error.to_string()).at_row(u64::from(error.pos().row)))
    }

    /// The joint among `joints`.
    pub(super) fn find<'n, 'i: 'n>(&self, joints: impl Iterator<Item = Node<'n, 'i>> + Clone) -> Result<Node<'n, 'i>> {
        if self.joint.is_empty() {
            return Err(Error::new(
                &codes::BAD_MODEL_FILE,
                "`--joint-name` is empty: it has to be the name of a joint",
            ));
        }
        let found = joints.clone().find(|node| node.attribute("name") == Some(self.joint));
        found.ok_or_else(|| {
            let names: Vec<&str> = joints.filter_map(|node| node.attribute("name")).collect();
            let message = format!("`--joint-name` has to name one of the joints of this file: {}", names.join(", "));
            Error::new(&codes::BAD_MODEL_FILE, message).with_value(self.joint)
        })
    }
}

/// What is wrong with an element.
pub(super) fn bad_file(node: Node, message: &str) -> Error {
    let row = node.document().text_pos_at(node.range().start).row;
    Error::new(&codes::BAD_MODEL_FILE, message).at_row(u64::from(row))
}

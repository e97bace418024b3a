//! Robots from the files that describe them.

mod mjcf;
mod model;
mod urdf;

pub(crate) use model::{Beside, Body, Form, Joint, Kind, Link, Robot, Solid, z_along};
use roxmltree::Document;

use crate::error::{Error, Result, codes};

/// The robot that the text of a URDF or MJCF file describes.
///
/// # Errors
/// `FRK-D021` with its row when it is neither, or says what is not understood.
pub(crate) fn parse(text: &str) -> Result<Robot> {
    let document = Document::parse(text)
        .map_err(|error| Error::new(&codes::BAD_URDF, error.to_string()).at_row(u64::from(error.pos().row)))?;
    if is_mjcf_root(&document) { mjcf::parse(&document) } else { urdf::parse(&document) }
}

/// Whether a text is MJCF.
pub(crate) fn is_mjcf(text: &str) -> bool {
    Document::parse(text).is_ok_and(|document| is_mjcf_root(&document))
}

fn is_mjcf_root(document: &Document) -> bool {
    document.root_element().has_tag_name("mujoco")
}

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

/// Joints that cannot be the axis of an image: all of their directions are free, or none.
const NO_AXES: [&str; 3] = ["fixed", "free", "ball"];

/// The joint of a model file that has just one axis: MJCF, URDF or SDF.
///
/// # Errors
/// `FRK-D030` where the file is not XML, or has no axis with a name or several, which it lists.
pub fn only_joint(text: &str) -> Result<String> {
    let document = ModelFile { text, ..ModelFile::default() }.parsed()?;
    let is_axis = |node: &Node| {
        let of_model = node
            .parent()
            .is_some_and(|parent| ["body", "robot", "model"].iter().any(|holder| parent.has_tag_name(*holder)));
        of_model && node.has_tag_name("joint") && !node.attribute("type").is_some_and(|kind| NO_AXES.contains(&kind))
    };
    let axes: Vec<Node> = document.descendants().filter(is_axis).collect();
    let names: Vec<&str> = axes.iter().filter_map(|node| node.attribute("name")).collect();
    match (&axes[..], &names[..]) {
        ([_], [name]) => Ok((*name).to_owned()),
        (_, []) => Err(Error::new(&codes::BAD_MODEL_FILE, "this file has no joint with a name that turns or slides")),
        _ => {
            let message = format!("`--joint-name` has to say which joint of this file is meant: {}", names.join(", "));
            Err(Error::new(&codes::BAD_MODEL_FILE, message))
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_only_axis_of_a_file_is_taken_and_of_several_all_are_told() {
        let urdf = r#"<robot><joint name="base" type="fixed"/><joint name="elbow" type="revolute"/>
            <transmission><joint name="elbow"/></transmission></robot>"#;
        assert_eq!(only_joint(urdf).unwrap(), "elbow");
        let mjcf = r#"<mujoco><default><joint damping="1"/></default><worldbody><body><joint type="free"/><body>
            <joint name="wrist"/></body></body></worldbody></mujoco>"#;
        assert_eq!(only_joint(mjcf).unwrap(), "wrist");
        let several = urdf.replace("fixed", "prismatic");
        let error = only_joint(&several).unwrap_err();
        assert!(error.code() == &codes::BAD_MODEL_FILE && error.message().ends_with("base, elbow"), "{error}");
        assert!(only_joint("<robot><joint type=\"revolute\"/></robot>").is_err());
    }
}

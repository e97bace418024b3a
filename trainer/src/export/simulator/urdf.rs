//! URDF: `dynamics` with Coulomb and viscous friction. It knows neither rotor inertia nor any other friction.

use super::content::Content;
use super::edits::{Edits, comment_of};
use super::model_file::{ModelFile, bad_file};
use crate::error::Result;
use crate::figures::digits;

/// Types of joints that turn, and that slide.
const ROTARY: [&str; 2] = ["revolute", "continuous"];

/// The joint with nothing but its dynamics.
pub(super) fn joint(content: &Content) -> String {
    let kind = if content.is_linear { "prismatic" } else { ROTARY[0] };
    let name = content.name_in_xml();
    format!(
        "<joint name=\"{name}\" type=\"{kind}\">\n  {}\n  {}\n</joint>\n",
        comment_of(&format!("{} Copy the next line into the joint.", remark(content, None))),
        dynamics(content)
    )
}

/// The user's file with the dynamics of the joint; every other byte as it is.
pub(super) fn patched(content: &Content, file: &ModelFile) -> Result<String> {
    let document = file.parsed()?;
    let joint = file.find(document.root_element().children().filter(|node| node.has_tag_name("joint")))?;
    let kind = joint.attribute("type").unwrap_or_default();
    if ROTARY.contains(&kind) == content.is_linear || !(ROTARY.contains(&kind) || kind == "prismatic") {
        return Err(bad_file(joint, "the image is of an axis of another kind than this joint").with_value(kind));
    }
    let mut edits = Edits::of(file.text);
    match joint.children().find(|node| node.has_tag_name("dynamics")) {
        Some(existing) => {
            let [friction, damping] = values(content);
            edits.set_attribute(existing, "friction", &friction);
            edits.set_attribute(existing, "damping", &damping);
        }
        None => edits.append_child(joint, &dynamics(content)),
    }
    let armature = file.inertia_of_model.map(|bodies| content.armature(bodies)).transpose()?.flatten();
    edits.set_remark(joint, &remark(content, armature));
    Ok(edits.apply())
}

fn values(content: &Content) -> [String; 2] {
    let form = &content.coulomb_viscous;
    [form.coulomb, form.damping[0]].map(|value| (value as f32).to_string())
}

fn dynamics(content: &Content) -> String {
    let [friction, damping] = values(content);
    format!("<dynamics friction=\"{friction}\" damping=\"{damping}\"/>")
}

fn remark(content: &Content, lack: Option<f64>) -> String {
    let mut text = content.remark(&content.coulomb_viscous, |_| false);
    if let Some(inertia) = content.inertia() {
        let unit = content.inertia_unit();
        text += &format!(" Identified inertia {} {unit}, link and rotor", digits(inertia));
        text += &match lack {
            Some(lack) => format!(": the {} {unit} that the bodies lack have no place in this format.", digits(lack)),
            None => ": what of it the bodies lack has no place in this format.".to_owned(),
        };
    }
    if let Some(gravity) = content.gravity() {
        text = format!("{text} {gravity}");
    }
    text
}

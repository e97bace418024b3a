//! SDFormat: `axis/dynamics` with Coulomb and viscous friction and a spring. It knows no rotor inertia.

use std::fmt::Write;

use frikan_shared::effect::Effect;

use super::content::Content;
use super::edits::{Edits, comment_of};
use super::model_file::{ModelFile, bad_file};
use crate::error::Result;
use crate::figures::digits;

/// The joint with nothing but its dynamics.
pub(super) fn joint(content: &Content) -> String {
    let kind = if content.is_linear { "prismatic" } else { "revolute" };
    let name = content.name_in_xml();
    let values: String = values(content).iter().map(|(tag, value)| format!("      <{tag}>{value}</{tag}>\n")).collect();
    format!(
        "{}\n<joint name=\"{name}\" type=\"{kind}\">\n  <axis>\n    <dynamics>\n{values}    </dynamics>\n  </axis>\n</joint>\n",
        comment_of(&format!("{} Copy the dynamics into the axis of the joint.", remark(content)))
    )
}

/// The user's file with the dynamics of the joint; every other byte as it is.
pub(super) fn patched(content: &Content, file: &ModelFile) -> Result<String> {
    let document = file.parsed()?;
    let is_joint = |node: &roxmltree::Node| node.has_tag_name("joint") && node.has_attribute("type");
    let joint = file.find(document.descendants().filter(is_joint))?;
    if (joint.attribute("type") == Some("prismatic")) != content.is_linear {
        return Err(bad_file(joint, "the image is of an axis of another kind than this joint"));
    }
    let axis = joint.children().find(|node| node.has_tag_name("axis"));
    let axis = axis.ok_or_else(|| bad_file(joint, "this joint has no axis"))?;
    let mut edits = Edits::of(file.text);
    match axis.children().find(|node| node.has_tag_name("dynamics")) {
        Some(dynamics) => {
            for (tag, value) in values(content) {
                match dynamics.children().find(|inner| inner.has_tag_name(tag)) {
                    Some(existing) => edits.replace(existing.range(), format!("<{tag}>{value}</{tag}>")),
                    None => edits.append_child(dynamics, &format!("<{tag}>{value}</{tag}>")),
                }
            }
        }
        None => {
            let values: String = values(content).iter().map(|(tag, value)| format!("<{tag}>{value}</{tag}>")).collect();
            edits.append_child(axis, &format!("<dynamics>{values}</dynamics>"));
        }
    }
    edits.set_remark(joint, &remark(content));
    Ok(edits.apply())
}

fn values(content: &Content) -> Vec<(&'static str, f32)> {
    let form = &content.coulomb_viscous;
    let mut values = vec![("damping", form.damping[0] as f32), ("friction", form.coulomb as f32)];
    if let Some((stiffness, rest)) = content.spring() {
        values.extend([("spring_stiffness", stiffness as f32), ("spring_reference", rest as f32)]);
    }
    values
}

fn remark(content: &Content) -> String {
    let held = |effect: &Effect| matches!(effect, Effect::Spring { stiffness, .. } if *stiffness > 0.0);
    let mut text = content.remark(&content.coulomb_viscous, held) + " Gazebo was not run with this file.";
    if let Some(inertia) = content.inertia() {
        let _ = write!(
            text,
            " Identified inertia {} {}, link and rotor: what of it the bodies lack has no place in this format.",
            digits(inertia),
            content.inertia_unit()
        );
    }
    content.gravity().iter().for_each(|gravity| text = format!("{text} {gravity}"));
    text
}

//! Passive motors of MuJoCo: bristles and cogging.

use roxmltree::{Document, Node};

use super::super::content::Cogging;
use super::super::edits::Edits;
use super::super::model_file::ModelFile;
use super::super::trial::Bristles;
use super::number::plain;

/// A motor that nobody drives, with LuGre friction.
pub(super) fn friction(joint: &str, bristles: &Bristles) -> String {
    let Bristles { stiffness, damping, coulomb, at_rest, stribeck_velocity } = *bristles;
    let lugre = [stiffness, damping, coulomb, at_rest, stribeck_velocity].map(plain).join(" ");
    format!(
        "<dcmotor name=\"{joint}_friction\" joint=\"{joint}\" input=\"none\" motorconst=\"0\" resistance=\"1\" lugre=\"{lugre}\"/>"
    )
}

/// The same with one line of a ripple. A gear of the order turns whatever is periodic over it into one period a radian; MuJoCo adds this
/// torque, the image has what the actuator has to add.
pub(super) fn ripple(joint: &str, number: usize, line: &Cogging) -> String {
    format!(
        "<dcmotor name=\"{joint}_ripple_{number}\" joint=\"{joint}\" input=\"none\" motorconst=\"0\" resistance=\"1\" gear=\"{}\" cogging=\"{} 1 {}\"/>",
        plain(line.order),
        plain(line.amplitude / line.order),
        plain(line.phase + std::f64::consts::PI),
    )
}

/// Whether an element is a motor that an export has put in.
pub(super) fn is_ours(node: &Node, joint: &str) -> bool {
    let rest = node.attribute("name").and_then(|name| name.strip_prefix(joint));
    node.has_tag_name("dcmotor") && rest.is_some_and(|rest| rest == "_friction" || rest.starts_with("_ripple_"))
}

/// Puts the motors at the end of the actuators, in the place of those of an earlier export.
pub(super) fn set(edits: &mut Edits, document: &Document, (file, added): (&ModelFile, &[String])) {
    for earlier in document.descendants().filter(|node| is_ours(node, file.joint)) {
        let range = earlier.range();
        let line = file.text[..range.start].rfind('\n').filter(|line| file.text[*line..range.start].trim().is_empty());
        edits.replace(line.unwrap_or(range.start)..range.end, "");
    }
    if added.is_empty() {
        return;
    }
    let root = document.root_element();
    match root.children().rfind(|node| node.has_tag_name("actuator")) {
        Some(actuators) => {
            let indentation =
                actuators.first_element_child().map_or("  ", |first| edits.indentation(first.range().start));
            edits.append_child(actuators, &added.join(&format!("\n{indentation}")));
        }
        None => edits.append_child(root, &format!("<actuator>\n    {}\n  </actuator>", added.join("\n    "))),
    }
}

//! The actuator that drives a joint of MuJoCo.

use roxmltree::{Document, Node};

use super::super::actuator::{Law, SimulatedActuator};
use super::super::edits::Edits;
use super::motors;
use super::number::plain;

/// Attributes of the element for an actuator; `step` is the time step of a simulator that has delays, s.
fn attributes(actuator: &SimulatedActuator, step: Option<f64>) -> (&'static str, Vec<(&'static str, String)>) {
    let (tag, mut attributes) = match actuator.law {
        Law::Position { kp, kv } => ("position", vec![("kp", plain(kp)), ("kv", plain(kv))]),
        Law::Effort { gain, kv } => {
            let bias = format!("0 0 {}", plain(-kv));
            ("general", vec![("gainprm", plain(gain)), ("biastype", "affine".to_owned()), ("biasprm", bias)])
        }
    };
    if let Some(limit) = actuator.limit {
        attributes.push(("forcerange", format!("{} {}", plain(-limit), plain(limit))));
    }
    if let Some(step) = step.filter(|_| actuator.delay_s > 0.0) {
        attributes.push(("nsample", ((actuator.delay_s / step).ceil() as usize + 1).to_string()));
        attributes.push(("delay", plain(actuator.delay_s)));
    }
    (tag, attributes)
}

/// Writes the actuator into the file's own one of the same element, or gives the element to add; a file that drives the joint by another
/// element keeps that: then `None` and nothing is written.
pub(super) fn drive(
    edits: &mut Edits,
    document: &Document,
    joint: &str,
    (actuator, step): (&SimulatedActuator, Option<f64>),
) -> Option<Option<String>> {
    let (tag, attributes) = attributes(actuator, step);
    let is_ours = |node: &Node| motors::is_ours(node, joint);
    let mut own = document.descendants().filter(|node| node.attribute("joint") == Some(joint) && !is_ours(node));
    let own = own.find(|node| node.parent().is_some_and(|parent| parent.has_tag_name("actuator")));
    match own {
        Some(node) if node.has_tag_name(tag) => {
            attributes.iter().for_each(|(name, value)| edits.set_attribute(node, name, value));
            Some(None)
        }
        Some(_) => None,
        None => {
            let name = crate::markup::escape(joint);
            let attributes: String = attributes.iter().map(|(name, value)| format!(" {name}=\"{value}\"")).collect();
            Some(Some(format!("<{tag} name=\"{name}_actuator\" joint=\"{name}\"{attributes}/>")))
        }
    }
}

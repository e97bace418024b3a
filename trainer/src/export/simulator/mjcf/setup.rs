//! How an MJCF file steps and drives a joint, classes of defaults included.

use std::iter::successors;

use roxmltree::{Document, Node};

use super::super::body::numbers;
use super::super::model_file::bad_file;
use super::super::trial::{Controller, Integrator, Softness, Stepping};
use crate::error::Result;

/// Time step of MuJoCo where a file names none, s.
const TIME_STEP_S: f64 = 0.002;

/// An attribute of an element, its own or of its class of defaults.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let own = node.attribute(name);
    own.or_else(|| {
        let class =
            node.attribute("class").or_else(|| node.ancestors().skip(1).find_map(|body| body.attribute("childclass")));
        let defaults = node.document().descendants().filter(|node| node.has_tag_name("default"));
        let is_main = |node: &Node| node.parent().is_some_and(|parent| parent.has_tag_name("mujoco"));
        let named = defaults.clone().find(|node| class.is_some() && node.attribute("class") == class);
        let first = named.or_else(|| defaults.clone().find(is_main))?;
        successors(Some(first), |node| node.parent().filter(|parent| parent.has_tag_name("default"))).find_map(
            |class| class.children().find(|child| child.has_tag_name(node.tag_name().name()))?.attribute(name),
        )
    })
}

/// The numbers of such an attribute, as many as there are.
fn values(node: Node, name: &str) -> Vec<f64> {
    attribute(node, name)
        .map_or_else(Vec::new, |text| text.split_whitespace().filter_map(|word| word.parse().ok()).collect())
}

/// Time step and integrator of a file, with the integrator's name.
///
/// # Errors
/// `FRK-D030` for an integrator or a time step that MuJoCo has not.
pub(super) fn stepping<'a>(document: &'a Document) -> Result<(Stepping, &'a str)> {
    let options = document.descendants().filter(|node| node.has_tag_name("option"));
    let last = |name: &str| options.clone().rfind(|node| node.has_attribute(name));
    let step = match last("timestep") {
        Some(option) => match numbers::<1>(option, "timestep") {
            Ok(Some([step])) if step > 0.0 => step,
            _ => return Err(bad_file(option, "`timestep` has to be a number of seconds above 0")),
        },
        None => TIME_STEP_S,
    };
    let name = last("integrator").and_then(|option| option.attribute("integrator")).unwrap_or("Euler");
    let integrator = match name {
        "Euler" => Integrator::Euler,
        "implicit" | "implicitfast" => Integrator::Implicit,
        "RK4" => Integrator::RungeKutta,
        "discrete" => Integrator::Discrete,
        other => {
            let option = last("integrator").unwrap_or_else(|| document.root_element());
            return Err(bad_file(option, "MuJoCo has no integrator of this name").with_value(other));
        }
    };
    Ok((Stepping { integrator, step }, name))
}

/// The softness of the dry friction of a joint.
pub(super) fn softness(joint: Node) -> Softness {
    let mut softness = Softness::default();
    softness.reference.iter_mut().zip(values(joint, "solreffriction")).for_each(|(to, value)| *to = value);
    softness.impedance.iter_mut().zip(values(joint, "solimpfriction")).for_each(|(to, value)| *to = value);
    softness
}

/// The position controller that a file has for a joint on an inertia: a `position` or affine `general` actuator.
pub(super) fn controller(document: &Document, joint: &str, inertia: f64) -> Option<Controller> {
    let mut actuators = document.descendants().filter(|node| node.attribute("joint") == Some(joint));
    actuators.find_map(|node| {
        let gear = values(node, "gear").first().copied().unwrap_or(1.0);
        let [kp, kv] = match node.tag_name().name() {
            "position" => {
                let kp = values(node, "kp").first().copied().unwrap_or(1.0);
                let ratio =
                    values(node, "dampratio").first().map(|ratio| 2.0 * ratio * (kp * inertia).sqrt() / gear.abs());
                [kp, values(node, "kv").first().copied().or(ratio).unwrap_or(0.0)]
            }
            "general" if attribute(node, "biastype") == Some("affine") => {
                let bias = values(node, "biasprm");
                [-*bias.get(1)?, -bias.get(2).copied().unwrap_or(0.0)]
            }
            _ => return None,
        };
        (kp > 0.0).then_some(Controller { kp: kp * gear * gear, kv: kv * gear * gear, is_actuator: true })
    })
}

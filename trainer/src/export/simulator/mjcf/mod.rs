//! MuJoCo's MJCF: attributes of the joint and, where simulation shows that it is worth it, a passive motor with LuGre friction and cogging.

mod candidates;
mod drives;
mod motors;
mod number;
mod setup;
#[cfg(test)]
mod tests;

use std::fmt::Write;

use frikan_shared::effect::{Effect, Kind};
use roxmltree::{Document, Node};

pub(super) use self::candidates::Reads;
use self::candidates::{Candidate, Setup, best, untried};
use self::number::plain;
use super::body::inertia_about;
use super::content::Content;
use super::edits::{Edits, comment_of};
use super::model_file::{ModelFile, bad_file};
use super::trial::{Controller, Left, MOST_WORSE};
use crate::error::Result;
use crate::figures::digits;
use crate::markup::escape;

/// A file that MuJoCo includes: a default class of joints with `frictionloss` and `damping`.
pub(super) fn default_class(content: &Content) -> String {
    let name = content.name_in_xml();
    let kind = if content.is_linear { "slide" } else { "hinge" };
    let form = &content.coulomb_viscous;
    let mut remark = content.remark(form, |_| false);
    if let Some(inertia) = content.inertia() {
        let _ = write!(
            remark,
            " Identified inertia {}, link and rotor: what of it the bodies lack is the armature, which `--into` works out.",
            digits(inertia)
        );
    }
    format!(
        "<mujoco>\n  {}\n  <default>\n    <default class=\"{name}\">\n      <joint type=\"{kind}\" frictionloss=\"{}\" damping=\"{}\"/>\n    </default>\n  </default>\n</mujoco>\n",
        comment_of(&format!("{remark} Include this file and give the joint this class. It was not simulated.")),
        form.coulomb as f32,
        form.damping[0] as f32,
    )
}

/// The user's file with the joint as identified; every other byte as it is.
pub(super) fn patched(content: &Content, file: &ModelFile, reads: Reads, of: &str) -> Result<String> {
    let document = file.parsed()?;
    let in_a_body = |node: &Node| node.parent().is_some_and(|parent| parent.has_tag_name("body"));
    let joint = file.find(document.descendants().filter(|node| node.has_tag_name("joint")).filter(in_a_body))?;
    let kind = setup::attribute(joint, "type").unwrap_or("hinge");
    if kind != if content.is_linear { "slide" } else { "hinge" } {
        let message = "the image is of an axis that turns or slides about one direction: this joint is of another kind";
        return Err(bad_file(joint, message).with_value(kind));
    }
    let bodies = inertia_of_bodies(content, file, joint)?;
    let armature = bodies.map(|bodies| content.armature(bodies)).transpose()?.flatten();
    let inertia = bodies.and_then(|bodies| content.inertia_with(bodies));
    let (candidate, told) = chosen(content, (file, joint), reads, inertia)?;
    let cogging = if reads.passive_motors { content.cogging() } else { Vec::new() };
    let held = |effect: &Effect| match effect {
        Effect::Presliding { .. } => candidate.has_presliding(),
        Effect::Ripple { kind, .. } => *kind == Kind::Torque && !cogging.is_empty(),
        Effect::Spring { stiffness, .. } => *stiffness > 0.0,
        _ => false,
    };
    let mut remark = content.remark(&candidate.form, held) + &told + of;
    let mut edits = Edits::of(file.text);
    edits.set_attribute(joint, "frictionloss", &plain(candidate.friction_loss));
    let [a, b, c] = candidate.form.damping.map(plain);
    let is_plain = candidate.form.damping[1..] == [0.0; 2];
    edits.set_attribute(joint, "damping", &if is_plain { a } else { format!("{a} {b} {c}") });
    if let (Some(armature), Some(bodies)) = (armature, bodies) {
        let unit = content.inertia_unit();
        let _ = write!(
            remark,
            " Inertia {} {unit}, of which the bodies have {}.",
            digits(bodies + armature),
            digits(bodies)
        );
        edits.set_attribute(joint, "armature", &plain(armature));
    }
    if let Some((stiffness, rest)) = content.spring() {
        let in_degrees = !content.is_linear
            && !document
                .descendants()
                .any(|node| node.has_tag_name("compiler") && node.attribute("angle") == Some("radian"));
        edits.set_attribute(joint, "stiffness", &plain(stiffness));
        edits.set_attribute(joint, "springref", &plain(if in_degrees { rest.to_degrees() } else { rest }));
    }
    content.gravity().iter().for_each(|gravity| remark = format!("{remark} {gravity}"));
    let name = escape(file.joint);
    let mut added = Vec::new();
    if let Some(actuator) = &content.actuator {
        // Delays are MuJoCo 4.0's, as passive motors are.
        let step = if reads.powers { Some(setup::stepping(&document)?.0.step) } else { None };
        remark += &actuator.told(step.is_some());
        match drives::drive(&mut edits, &document, file.joint, (actuator, step)) {
            Some(element) => added.extend(element),
            None => remark += " The file drives this joint by an actuator of another kind, which stays as it is.",
        }
    }
    edits.set_remark(joint, &remark);
    let bristles = candidate.bristles.iter().map(|bristles| motors::friction(&name, bristles));
    let ripples = cogging.iter().enumerate().map(|(index, line)| motors::ripple(&name, index + 1, line));
    added.extend(bristles.chain(ripples));
    motors::set(&mut edits, &document, (file, &added));
    Ok(edits.apply())
}

/// The form for the joint of a file, and what of it was simulated, in words.
fn chosen(
    content: &Content,
    (file, joint): (&ModelFile, Node),
    reads: Reads,
    inertia: Option<f64>,
) -> Result<(Candidate, String)> {
    let document: &Document = joint.document();
    let (stepping, integrator) = setup::stepping(document)?;
    let Some(inertia) = inertia else {
        return Ok((untried(content, reads), " It was not simulated: the image says no inertia.".to_owned()));
    };
    let given = file.gains.map(|[kp, kv]| Controller { kp, kv, is_actuator: false });
    let of_joint = content.actuator.and_then(|actuator| actuator.gains());
    let of_joint = of_joint.map(|[kp, kv]| Controller { kp, kv, is_actuator: true });
    let controller = given.or(of_joint).or_else(|| setup::controller(document, file.joint, inertia));
    let setup = Setup { inertia, stepping, softness: setup::softness(joint), controller };
    let (candidate, left) = best(content, reads, &setup);
    let [torque, velocity] = content.units();
    let mut told = format!(
        " Simulated as MuJoCo steps it (`{integrator}`, {} ms, on {} {}) along sines up to {} {velocity}:",
        digits(1e3 * stepping.step),
        digits(inertia),
        content.inertia_unit(),
        digits(content.curve.top()),
    );
    let lines: Vec<String> = left.iter().map(|left| line(left, torque)).collect();
    let _ = write!(
        told,
        " {}. In no trial, at half and twice the time step neither, was it more than {:.0} % worse than Coulomb and viscous friction.",
        lines.join("; "),
        100.0 * (MOST_WORSE - 1.0),
    );
    Ok((candidate, told))
}

/// What a form leaves under a controller.
fn line(left: &Left, unit: &str) -> String {
    let Left { controller, torque, plain, chosen } = left;
    let of = if controller.is_actuator { "the actuator" } else { "a controller" };
    let gains = format!("{of} of kp {} and kv {}", digits(controller.kp), digits(controller.kv));
    if chosen.is_finite() {
        let [chosen, torque, plain] = [chosen, torque, plain].map(|value| digits(*value));
        format!(
            "{gains} gives {chosen} {unit} rms other than with the identified joint, of {torque} (Coulomb and viscous friction: {plain})"
        )
    } else {
        format!("{gains} diverges with any form")
    }
}

/// Inertia of the bodies about the joint, as given or as the file says it; `None` where the image has no inertia to compare it with.
fn inertia_of_bodies(content: &Content, file: &ModelFile, joint: Node) -> Result<Option<f64>> {
    if content.body.inertia == 0.0 && content.body.given_scale == 0.0 {
        return Ok(None);
    }
    let bodies = match file.inertia_of_model {
        Some(given) => given,
        None => inertia_about(joint).map_err(|why| {
            let message = format!(
                "the inertia of the bodies about this joint cannot be read from the file ({why}): give `--inertia-of-model`, which MuJoCo works out (docs/exports.md)"
            );
            bad_file(joint, &message)
        })?,
    };
    Ok(Some(bodies))
}

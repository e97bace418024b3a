//! MuJoCo's MJCF: attributes of the joint and, where law or effects ask for it, a passive motor with LuGre friction and cogging.

use std::fmt::Write;

use frikan_shared::effect::{Effect, Kind};
use roxmltree::{Document, Node};

use super::body::{inertia_about, numbers};
use super::content::Content;
use super::edits::{Edits, comment_of};
use super::form::Form;
use super::model_file::{ModelFile, bad_file};
use crate::error::Result;
use crate::figures::digits;
use crate::markup::escape;

/// Time step of MuJoCo where the file names none, s.
const TIME_STEP_S: f64 = 0.002;

/// Largest natural frequency of the bristles on the inertia of the joint, times the time step. Of 0.05, 0.1, 0.2, 0.3 and 0.5 rad on the
/// elbow of `tests/simulators`, 0.2 and 0.3 left the smallest torque error (0.085 and 0.078 N m); the smaller is further from instability.
const BRISTLE_STEP_RAD: f64 = 0.2;

/// Which elements of MuJoCo are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Elements {
    /// Attributes of the joint; three numbers of `damping` need 4.0.
    Joint,
    /// A `dcmotor` without input beside them (MuJoCo 4.0).
    PassiveMotor,
}

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
        comment_of(&format!("{remark} Include this file and give the joint this class.")),
        form.coulomb as f32,
        form.damping[0] as f32,
    )
}

/// The user's file with the joint as identified; every other byte as it is.
pub(super) fn patched(content: &Content, file: &ModelFile, elements: Elements) -> Result<String> {
    let document = file.parsed()?;
    let in_a_body = |node: &Node| node.parent().is_some_and(|parent| parent.has_tag_name("body"));
    let joint = file.find(document.descendants().filter(|node| node.has_tag_name("joint")).filter(in_a_body))?;
    if let Some(kind) = joint.attribute("type").filter(|kind| (*kind == "slide") != content.is_linear) {
        return Err(bad_file(joint, "the image is of an axis of the other kind").with_value(kind));
    }
    let mut edits = Edits::of(file.text);
    let motor = Some(elements).filter(|elements| *elements == Elements::PassiveMotor);
    let bodies = inertia_of_bodies(content, file, joint)?;
    let motor = motor.and_then(|_| passive_motor(content, &document, content.inertia_with(bodies?)?));
    let cogging = if elements == Elements::PassiveMotor { content.cogging() } else { Vec::new() };
    let form = motor.as_ref().map_or_else(|| content.damped(), |motor| motor.form);
    let held = |effect: &Effect| match effect {
        Effect::Presliding { .. } => motor.is_some(),
        Effect::Ripple { kind, .. } => *kind == Kind::Torque && !cogging.is_empty(),
        Effect::Spring { stiffness, .. } => *stiffness > 0.0,
        _ => false,
    };
    let mut remark = content.remark(&form, held);
    edits.set_attribute(joint, "frictionloss", &plain(if motor.is_some() { 0.0 } else { form.coulomb }));
    let [a, b, c] = form.damping.map(plain);
    edits.set_attribute(joint, "damping", &if form.damping[1..] == [0.0; 2] { a } else { format!("{a} {b} {c}") });
    if let Some(armature) = bodies.and_then(|bodies| armature(content, bodies, &mut remark)) {
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
    edits.set_remark(joint, &remark);
    let name = escape(file.joint);
    let mut added: Vec<String> = motor.iter().map(|motor| motor.element(&name)).collect();
    added.extend(cogging.iter().enumerate().map(|(index, line)| {
        // A gear of the order turns whatever is periodic over it into one period a radian; MuJoCo adds this torque, the image has
        // what the actuator has to add.
        format!(
            "<dcmotor name=\"{name}_ripple_{}\" joint=\"{name}\" input=\"none\" motorconst=\"0\" resistance=\"1\" gear=\"{}\" cogging=\"{} 1 {}\"/>",
            index + 1,
            plain(line.order),
            plain(line.amplitude / line.order),
            plain(line.phase + std::f64::consts::PI),
        )
    }));
    set_motors(&mut edits, &document, (file, &added));
    Ok(edits.apply())
}

/// LuGre friction of a motor that nobody drives.
struct PassiveMotor {
    form: Form,
    stiffness: f64,
    damping: f64,
}

impl PassiveMotor {
    fn element(&self, joint: &str) -> String {
        let Form { coulomb, stribeck_velocity, .. } = self.form;
        let velocity = if stribeck_velocity > 0.0 { stribeck_velocity } else { 1.0 };
        let lugre = [self.stiffness, self.damping, coulomb, self.form.at_rest(), velocity].map(plain).join(" ");
        format!(
            "<dcmotor name=\"{joint}_friction\" joint=\"{joint}\" input=\"none\" motorconst=\"0\" resistance=\"1\" lugre=\"{lugre}\"/>"
        )
    }
}

/// The motor where a Stribeck peak or presliding is worth one, its bristles as stiff as the inertia allows.
fn passive_motor(content: &Content, document: &Document, inertia: f64) -> Option<PassiveMotor> {
    let presliding = content.presliding_stiffness();
    let form = match (content.with_stribeck(), presliding) {
        (Some(form), _) => form,
        (None, Some(_)) => content.damped(),
        (None, None) => return None,
    };
    let option = document.descendants().find(|node| node.has_tag_name("option"));
    let step = option.and_then(|node| numbers::<1>(node, "timestep").ok()?).map_or(TIME_STEP_S, |[step]| step);
    let stiffest = inertia * (BRISTLE_STEP_RAD / step).powi(2);
    let stiffness = presliding.map_or(stiffest, |stiffness| stiffness.min(stiffest));
    // Half of critical damping on the inertia of the joint.
    Some(PassiveMotor { form, stiffness, damping: (stiffness * inertia).sqrt() })
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

/// What the bodies lack of the identified inertia, told in the remark.
fn armature(content: &Content, bodies: f64, remark: &mut String) -> Option<f64> {
    let lack = content.armature(bodies)?;
    let unit = content.inertia_unit();
    let _ = write!(remark, " Inertia {} {unit}, of which the bodies have {}.", digits(bodies + lack), digits(bodies));
    if lack < 0.0 {
        let _ = write!(remark, " The bodies have {} {unit} too much, which no armature takes away.", digits(-lack));
    }
    Some(lack.max(0.0))
}

/// Puts the motors at the end of the actuators, in the place of those of an earlier export.
fn set_motors(edits: &mut Edits, document: &Document, (file, added): (&ModelFile, &[String])) {
    let is_ours = |node: &Node| {
        let rest = node.attribute("name").and_then(|name| name.strip_prefix(file.joint));
        node.has_tag_name("dcmotor") && rest.is_some_and(|rest| rest == "_friction" || rest.starts_with("_ripple_"))
    };
    for earlier in document.descendants().filter(is_ours) {
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

/// A number with the digits of single precision, as an image has them.
fn plain(value: f64) -> String {
    (value as f32).to_string()
}

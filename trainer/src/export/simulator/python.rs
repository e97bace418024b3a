//! Python code for simulators that are set up in Python: an actuator of Isaac Lab, and a force element of Drake.

use super::content::Content;
use crate::error::{Error, Result, codes};
use crate::figures::digits;

/// Widest line of a comment.
const WIDTH: usize = 110;

/// Speeds of a table, each a share of the largest, thinner towards zero as friction needs it.
const TABLE_ROWS: usize = 64;

/// What the file of Isaac Lab says of how it was checked.
const NOT_RUN: &str = " Isaac Lab was not run with this file.";

/// An `ImplicitActuatorCfg` of Isaac Lab with the friction of PhysX, and the law as a table for an actuator of the user's own.
pub(super) fn isaac(content: &Content) -> Result<String> {
    named(content)?;
    let (form, static_friction) = (content.coulomb_viscous, content.static_friction());
    let name = name(content);
    let (velocity, torque) = table(content);
    let gains = content.actuator.and_then(|actuator| actuator.gains()).map(|gains| gains.map(|gain| gain as f32));
    let limit = content.actuator.and_then(|actuator| actuator.limit);
    let [stiffness, damping] =
        gains.map_or_else(|| [(); 2].map(|()| "None".to_owned()), |gains| gains.map(|gain| gain.to_string()));
    let limit = limit.map_or_else(String::new, |limit| format!("    effort_limit_sim={},\n", limit as f32));
    let armature = match content.inertia() {
        Some(inertia) => format!(
            "    armature=None,  # identified inertia {} with the link: what of it the bodies of the asset lack\n",
            digits(inertia)
        ),
        None => String::new(),
    };
    Ok(format!(
        "{}import torch\nfrom isaaclab.actuators import ImplicitActuatorCfg\n\n\
         {name}_actuator = ImplicitActuatorCfg(\n    joint_names_expr=[\"{}\"],\n    stiffness={stiffness},\n    damping={damping},\n{limit}{armature}    \
         friction={},\n    dynamic_friction={},\n    viscous_friction={},\n)\n\n\
         # The law itself, for an explicit actuator: subtract friction(joint_vel) from the computed effort and leave the three above at 0.\n\
         {name}_velocity = torch.tensor({velocity})\n{name}_torque = torch.tensor({torque})\n\n\n\
         def {name}_friction(joint_vel: torch.Tensor) -> torch.Tensor:\n    \
         \"\"\"Friction torque in the sign of the velocity, linear between the rows of the table.\"\"\"\n    \
         v = joint_vel.clamp({name}_velocity[0], {name}_velocity[-1])\n    \
         i = torch.searchsorted({name}_velocity, v).clamp(1, len({name}_velocity) - 1)\n    \
         v0, v1 = {name}_velocity[i - 1], {name}_velocity[i]\n    \
         t0, t1 = {name}_torque[i - 1], {name}_torque[i]\n    \
         return t0 + (t1 - t0) * (v - v0) / (v1 - v0)\n",
        comment(
            content,
            &(content.remark(&form, |_| false)
                + &content.actuator.map_or_else(String::new, |of| of.told(false))
                + NOT_RUN)
        ),
        quoted(content.joint),
        static_friction as f32,
        form.coulomb as f32,
        form.damping[0] as f32,
    ))
}

/// # Errors
/// `FRK-U001` for a joint without a name, which Python code has to have.
fn named(content: &Content) -> Result<()> {
    let message = "the image has no name of its joint: give `--joint-name`, as the simulator has it";
    if content.joint.is_empty() { Err(Error::new(&codes::USAGE, message)) } else { Ok(()) }
}

/// A function that puts the joint's rotor inertia and viscous damping into a plant of Drake, and a system with the rest of the law.
pub(super) fn drake(content: &Content) -> Result<String> {
    named(content)?;
    let (velocity, torque) = table(content);
    let inertia = content.inertia().map_or_else(|| "None".to_owned(), |inertia| (inertia as f32).to_string());
    Ok(format!(
        "{}import numpy as np\nfrom pydrake.systems.framework import LeafSystem\n\n\
         JOINT = \"{}\"\nIDENTIFIED_INERTIA = {inertia}  # kg m2 or kg, link and rotor\n\
         VELOCITY = np.array({velocity})\nTORQUE = np.array({torque})\n\n\n\
         def set_rotor_inertia(plant, actuator, inertia_of_bodies):\n    \
         \"\"\"Gives an actuator of the joint what the bodies lack of the identified inertia; before the plant is finalized.\"\"\"\n    \
         actuator.set_default_rotor_inertia(max(IDENTIFIED_INERTIA - inertia_of_bodies, 0.0))\n    \
         actuator.set_default_gear_ratio(1.0)\n\n\n\
         class JointFriction(LeafSystem):\n    \
         \"\"\"Friction of the joint from its velocity: connect `torque` to the plant's actuation, added to that of the controller.\n\n    \
         The table rises through zero over its first rows, as the law does: a joint at rest under load creeps.\n    \"\"\"\n\n    \
         def __init__(self):\n        super().__init__()\n        self.DeclareVectorInputPort(\"velocity\", 1)\n        \
         self.DeclareVectorOutputPort(\"torque\", 1, self._torque)\n\n    \
         def _torque(self, context, output):\n        v = self.get_input_port(0).Eval(context)[0]\n        \
         output[0] = -np.interp(v, VELOCITY, TORQUE)\n",
        comment(content, &held_by_table(content)),
        quoted(content.joint),
    ))
}

/// What a table of the law holds: everything over velocity.
fn held_by_table(content: &Content) -> String {
    let left_out = content.left_out(|_| false);
    let mut text = format!("{}. Friction over velocity as a table.", content.title);
    if !left_out.is_empty() {
        text += &format!(" Left out: {}.", left_out.join(", "));
    }
    text
}

/// The law at speeds of both directions, thinner towards zero, and at zero.
fn table(content: &Content) -> (String, String) {
    let curve = &content.curve;
    let mut rows: Vec<(f64, f64)> = curve.velocity.iter().copied().zip(curve.torque.iter().copied()).collect();
    rows.push((0.0, 0.0));
    rows.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let top = curve.top();
    let shares = (0..=TABLE_ROWS).map(|row| (row as f64 / TABLE_ROWS as f64).powi(3) * top);
    let wanted: Vec<f64> = shares.flat_map(|speed| [-speed, speed]).collect();
    let nearest = |speed: &f64| rows.partition_point(|(velocity, _)| velocity < speed).min(rows.len() - 1);
    let mut places: Vec<usize> = wanted.iter().map(nearest).collect();
    places.sort_unstable();
    places.dedup();
    let list = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let numbers: Vec<String> = places.iter().map(|place| (value(&rows[*place]) as f32).to_string()).collect();
        format!("[{}]", numbers.join(", "))
    };
    (list(&|(velocity, _)| *velocity), list(&|(_, torque)| *torque))
}

/// Text as comment lines.
fn comment(content: &Content, text: &str) -> String {
    let text = [Some(text.to_owned()), content.gravity()].into_iter().flatten().collect::<Vec<_>>().join(" ");
    let mut lines = vec![String::from("#")];
    for word in text.split_whitespace() {
        if lines[lines.len() - 1].len() + word.len() > WIDTH {
            lines.push(String::from("#"));
        }
        let last = lines.len() - 1;
        lines[last] += &format!(" {word}");
    }
    lines.join("\n") + "\n\n"
}

/// A name of Python.
fn name(content: &Content) -> String {
    let plain: String = content.joint.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("joint_{plain}") }
}

/// Text within the quotation marks of a Python string.
fn quoted(text: &str) -> String {
    text.escape_default().to_string()
}

//! The law as robot simulators know friction: a constant torque against the motion and one in proportion to the velocity.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::Image;
use frikan_shared::model::{Input, MAX_INPUTS};
use frikan_shared::units::{Quantity, Unit};

use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::fit::{CELLS, HostModel};
use crate::markup::escape;
use crate::numerics::statistics::root_mean_square;
use crate::samples::regression::least_squares;

/// Velocities of each direction at which the law is asked.
const VELOCITIES: usize = 200;

/// A file that MuJoCo includes: a default class of joints with `frictionloss` and `damping`.
///
/// # Errors
/// `FRK-U001` for a law that does not depend on the velocity, or that is not in N m or N.
pub fn mujoco(image: &Image<CELLS>, title: &str) -> Result<String> {
    let friction = nearest(&image.model)?;
    let name = joint_name(image);
    let kind = if friction.is_linear { "slide" } else { "hinge" };
    Ok(format!(
        "<mujoco>\n  <!-- {} -->\n  <default>\n    <default class=\"{name}\">\n      <joint type=\"{kind}\" frictionloss=\"{}\" damping=\"{}\"/>\n    </default>\n  </default>\n</mujoco>\n",
        comment(image, &friction, title, "Include this file and give the joint this class."),
        friction.coulomb,
        friction.viscous,
    ))
}

/// The `dynamics` of a URDF's joint, within the joint of that name.
///
/// # Errors
/// `FRK-U001` for a law that does not depend on the velocity, or that is not in N m or N.
pub fn urdf(image: &Image<CELLS>, title: &str) -> Result<String> {
    let friction = nearest(&image.model)?;
    let kind = if friction.is_linear { "prismatic" } else { "revolute" };
    Ok(format!(
        "<joint name=\"{}\" type=\"{kind}\">\n  <!-- {} -->\n  <dynamics friction=\"{}\" damping=\"{}\"/>\n</joint>\n",
        joint_name(image),
        comment(image, &friction, title, "Copy the next line into the joint."),
        friction.coulomb,
        friction.viscous,
    ))
}

/// Coulomb and viscous friction beside the law that they stand for.
#[derive(Clone, Copy, Debug)]
struct CoulombViscous {
    /// N m, or N of a linear axis; at least 0.
    coulomb: f32,
    /// N m s/rad, or N s/m; at least 0.
    viscous: f32,
    /// Root mean square of the law, and of what the two leave of it.
    law: f64,
    left: f64,
    /// Trained velocities.
    from: f32,
    to: f32,
    is_linear: bool,
}

/// Coulomb and viscous friction nearest to the law over the velocities that it was trained on, by least squares; other inputs
/// stand in the middle of their trained range.
///
/// # Errors
/// `FRK-U001` for a law that does not depend on the velocity, or that is not in N m or N.
fn nearest(model: &HostModel) -> Result<CoulombViscous> {
    let is_linear = match model.output_unit {
        Unit::NewtonMetre => false,
        Unit::Newton => true,
        other => {
            let message = format!(
                "a simulator takes N m or N, this law is in {}; fit with `[drive] torque_constant_Nm_A`",
                other.symbol()
            );
            return Err(Error::new(&codes::USAGE, message));
        }
    };
    let velocity = model.inputs.iter().position(|input| input.quantity == Quantity::Velocity);
    let velocity = velocity.ok_or_else(|| Error::new(&codes::USAGE, "this law does not depend on the velocity"))?;
    let Input { low: from, high: to, .. } = model.inputs[velocity];
    let mut at = [0.0; MAX_INPUTS];
    at.iter_mut().zip(&model.inputs).for_each(|(channel, input)| *channel = 0.5 * (input.low + input.high));
    let fastest = from.abs().max(to.abs());
    let shares = (1..=VELOCITIES).map(|i| i as f32 / VELOCITIES as f32);
    let velocities: Vec<f32> = shares
        .flat_map(|share| [-share * fastest, share * fastest])
        .filter(|velocity| (from..=to).contains(velocity))
        .collect();
    let torque_at = |velocity_now: &f32| {
        at[velocity] = *velocity_now;
        f64::from(evaluate(model, &at))
    };
    let law: Vec<f64> = velocities.iter().map(torque_at).collect();
    let direction: Vec<f64> = velocities.iter().map(|velocity| f64::from(velocity.signum())).collect();
    let speed: Vec<f64> = velocities.iter().map(|velocity| f64::from(*velocity)).collect();
    let all = [0..law.len()];
    let fitted = |columns: &[&Vec<f64>]| {
        let columns: Vec<Vec<f64>> = columns.iter().map(|column| (*column).clone()).collect();
        let fit = least_squares(&columns, &law, &all);
        (fit.coefficients, fit.rmse)
    };
    // Neither may drive the joint: where one would, the better of the two stands alone.
    let (coefficients, left) = match fitted(&[&direction, &speed]) {
        (both, left) if both.iter().all(|coefficient| *coefficient >= 0.0) => ([both[0], both[1]], left),
        _ => match (fitted(&[&direction]), fitted(&[&speed])) {
            ((coulomb, left), (_, beside)) if left <= beside => ([coulomb[0], 0.0], left),
            (_, (viscous, left)) => ([0.0, viscous[0]], left),
        },
    };
    let [coulomb, viscous] = coefficients.map(|coefficient| coefficient.max(0.0) as f32);
    Ok(CoulombViscous { coulomb, viscous, law: root_mean_square(&law), left, from, to, is_linear })
}

fn joint_name(image: &Image<CELLS>) -> String {
    let name = image.provenance.joint.as_str();
    if name.is_empty() { "frikan".to_owned() } else { escape(name) }
}

/// What the two numbers stand for and what they leave out, as it may stand in a comment of XML.
fn comment(image: &Image<CELLS>, friction: &CoulombViscous, title: &str, usage: &str) -> String {
    let (model, unit) = (&image.model, image.model.output_unit.symbol());
    let velocity_unit = if friction.is_linear { "m/s" } else { "rad/s" };
    let mut text = format!(
        "{title}. Coulomb and viscous friction nearest to its law from {} to {} {velocity_unit}: they leave {} of {} {unit} (root mean square).",
        digits(f64::from(friction.from)),
        digits(f64::from(friction.to)),
        digits(friction.left),
        digits(friction.law),
    );
    if model.inputs.len() > 1 {
        text += " Other inputs of the law stand in the middle of their trained range.";
    }
    if !model.effects.is_empty() {
        text += &format!(" Left out: {} effects that the image adds to the law.", model.effects.len());
    }
    if model.rigid_body.inertia > 0.0 {
        let inertia_unit = if friction.is_linear { "kg" } else { "kg m2" };
        text += &format!(
            " Identified inertia {} {inertia_unit}, link and rotor: what of it the bodies lack is the armature.",
            digits(f64::from(model.rigid_body.inertia))
        );
    }
    format!("{text} {usage}").replace("--", "- -")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::formula::{Formula, Function, Operator};
    use crate::compile::program::compile_program;
    use frikan_shared::model::{Law, Model, Provenance, RigidBody};
    use roxmltree::Document;

    /// `coulomb tanh(1000 v) + viscous v` from -2 to 2 rad/s or m/s.
    fn image_of(coulomb: f64, viscous: f64, output_unit: Unit) -> Image<CELLS> {
        let times = |factor: f64, of: Formula| Formula::Constant(factor).join(Operator::Multiply, of);
        let sign = times(1000.0, Formula::Input(0)).apply(Function::Tanh);
        let law = times(coulomb, sign).join(Operator::Add, times(viscous, Formula::Input(0)));
        let input = Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low: -2.0, high: 2.0 };
        let model = Model {
            law: Law::Expression(compile_program(&law, 1).unwrap()),
            cells: Default::default(),
            inputs: heapless::Vec::from_slice(&[input]).unwrap(),
            output_unit,
            output_limit: 100.0,
            rigid_body: RigidBody { inertia: 0.5, ..RigidBody::default() },
            effects: heapless::Vec::new(),
        };
        let joint = heapless::String::try_from("a--b <1>").unwrap();
        Image { provenance: Provenance { joint, ..Provenance::default() }, model }
    }

    /// The attributes of the only element of that name.
    fn attributes<const N: usize>(xml: &str, element: &str, names: [&str; N]) -> [String; N] {
        let document = Document::parse(xml).unwrap_or_else(|error| panic!("{error}: {xml}"));
        let mut found = document.descendants().filter(|node| node.has_tag_name(element));
        let node = found.next().unwrap();
        names.map(|name| node.attribute(name).unwrap().to_owned())
    }

    fn near(text: &str, value: f32) {
        assert!((text.parse::<f32>().unwrap() - value).abs() < 1e-3, "{text} is not {value}");
    }

    #[test]
    fn both_simulators_get_coulomb_and_viscous_friction() {
        let image = image_of(3.0, 0.7, Unit::NewtonMetre);
        let xml = mujoco(&image, "title of a--b").unwrap();
        let [kind, coulomb, viscous] = attributes(&xml, "joint", ["type", "frictionloss", "damping"]);
        assert_eq!(kind, "hinge");
        near(&coulomb, 3.0);
        near(&viscous, 0.7);
        let xml = urdf(&image, "title").unwrap();
        assert_eq!(attributes(&xml, "joint", ["name", "type"]), ["a--b <1>", "revolute"]);
        let [coulomb, viscous] = attributes(&xml, "dynamics", ["friction", "damping"]);
        near(&coulomb, 3.0);
        near(&viscous, 0.7);
        let linear = urdf(&image_of(3.0, 0.7, Unit::Newton), "title").unwrap();
        assert_eq!(attributes(&linear, "joint", ["type"]), ["prismatic"]);
    }

    #[test]
    fn what_a_simulator_cannot_hold_never_drives_the_joint() {
        let falling = nearest(&image_of(3.0, -0.7, Unit::NewtonMetre).model).unwrap();
        assert_eq!(falling.viscous, 0.0);
        assert!((falling.coulomb - 2.3).abs() < 0.05, "the mean over the speeds: {falling:?}");
        assert!((falling.left - 1.4 / 12f64.sqrt()).abs() < 0.02, "{falling:?}");
    }

    #[test]
    fn a_law_of_the_current_is_refused() {
        let error = mujoco(&image_of(3.0, 0.7, Unit::Ampere), "title").unwrap_err();
        assert!(error.to_string().contains("torque_constant_Nm_A"), "{error}");
    }
}

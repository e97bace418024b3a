//! What the formats of simulators hold.

use super::*;
use crate::compile::formula::{Formula, Function, Operator};
use crate::compile::program::compile_program;
use frikan_shared::effect::{Effect, Harmonic, Kind};
use frikan_shared::model::{Input, Law, Model, Provenance, RigidBody};
use frikan_shared::units::{Quantity, Unit};

/// `coulomb tanh(1000 v) + viscous v` from -2 to 2 rad/s or m/s.
pub(super) fn image_of(coulomb: f64, viscous: f64, output_unit: Unit) -> Image<CELLS> {
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
        rigid_body: RigidBody { inertia: 0.5, given_scale: 0.0, ..RigidBody::default() },
        effects: heapless::Vec::new(),
    };
    let joint = heapless::String::try_from("a--b <1>").unwrap();
    Image { provenance: Provenance { joint, ..Provenance::default() }, model }
}

/// Stribeck friction, and a ripple of 12 periods a turn.
pub(super) fn rich_image() -> Image<CELLS> {
    let mut image = image_of(2.0, 1.2, Unit::NewtonMetre);
    let stribeck = Effect::Stribeck { amplitude: 1.0, velocity: 0.1, exponent: 2.0, smoothing_velocity: 0.001 };
    let line = Harmonic { order: 12.0, cosine: 0.0, sine: 0.3 };
    let harmonics = heapless::Vec::from_slice(&[line]).unwrap();
    let ripple = Effect::Ripple { kind: Kind::Torque, smoothing_velocity: 0.001, harmonics };
    image.model.effects = heapless::Vec::from_slice(&[stribeck, ripple]).unwrap();
    image
}

pub(super) const REQUEST: Request = Request {
    title: "Frikan friction image of joint \"a--b\"",
    into: None,
    torque_per_ampere: None,
    joint: None,
    release: None,
    actuator: None,
};

pub(super) fn written(image: &Image<CELLS>, simulator: Simulator, into: Option<(&str, &str)>) -> Result<String> {
    let into =
        into.map(|(text, joint)| ModelFile { text, path: "robot.usda", joint, inertia_of_model: None, gains: None });
    write(image, simulator, &Request { into, ..REQUEST })
}

/// The attributes of the only element of that name.
pub(super) fn attributes<const N: usize>(xml: &str, element: &str, names: [&str; N]) -> [String; N] {
    let document = roxmltree::Document::parse(xml).unwrap_or_else(|error| panic!("{error}: {xml}"));
    let mut found = document.descendants().filter(|node| node.has_tag_name(element) && node.has_attribute(names[0]));
    let node = found.next().unwrap_or_else(|| panic!("no {element}: {xml}"));
    names.map(|name| node.attribute(name).unwrap_or_else(|| panic!("no {name}: {xml}")).to_owned())
}

pub(super) fn near(text: &str, value: f32) {
    assert!((text.parse::<f32>().unwrap() - value).abs() < 2e-3 * value.abs().max(1.0), "{text} is not {value}");
}

pub(super) const MJCF: &str = r#"<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <!-- the arm -->
    <body name="arm">
      <inertial pos="0 0 -0.2" mass="1.5" diaginertia="0.24 0.24 0.01"/>
      <joint  name='elbow' axis="0 1 0"   damping="0.5" frictionloss='1'/>
      <body name="tool" pos="0 0 -0.4" quat="0.7071067811865476 0.7071067811865476 0 0">
        <inertial pos="0 0.1 0" mass="0.1" diaginertia="0 0 0.004"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="m" joint="elbow"/> <!-- kept -->
  </actuator>
</mujoco>
"#;

#[test]
fn without_a_file_every_format_gets_coulomb_and_viscous_friction() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    for simulator in [Simulator::Mujoco, Simulator::MjcfPatch] {
        let xml = written(&image, simulator, None).unwrap();
        let [coulomb, viscous, kind] = attributes(&xml, "joint", ["frictionloss", "damping", "type"]);
        assert_eq!(kind, "hinge");
        near(&coulomb, 3.0);
        near(&viscous, 0.7);
    }
    let xml = written(&image, Simulator::Urdf, None).unwrap();
    assert_eq!(attributes(&xml, "joint", ["name", "type"]), ["a--b <1>", "revolute"]);
    let [coulomb, viscous] = attributes(&xml, "dynamics", ["friction", "damping"]);
    near(&coulomb, 3.0);
    near(&viscous, 0.7);
    let linear = written(&image_of(3.0, 0.7, Unit::Newton), Simulator::Urdf, None).unwrap();
    assert_eq!(attributes(&linear, "joint", ["type"]), ["prismatic"]);
    for simulator in [Simulator::Sdf, Simulator::Usd, Simulator::Isaac, Simulator::Drake] {
        let text = written(&image, simulator, None).unwrap();
        assert!(text.contains('3') && text.contains("Frikan friction image"), "{text}");
    }
}

#[test]
fn what_a_simulator_cannot_hold_never_drives_the_joint() {
    let image = image_of(3.0, -0.7, Unit::NewtonMetre);
    let content = Content::of(&image, &REQUEST).unwrap();
    let falling = content.coulomb_viscous;
    assert_eq!(falling.damping, [0.0; 3]);
    assert!((falling.coulomb - 2.3).abs() < 0.05, "the mean over the speeds: {falling:?}");
    let left = falling.deviation(&content.curve);
    assert!((left.rms - 1.4 / 12f64.sqrt()).abs() < 0.02 && (left.max - 0.7).abs() < 0.05, "{left:?}");
}

#[test]
fn a_law_of_the_current_needs_the_constants_of_the_drive() {
    let image = image_of(3.0, 0.7, Unit::Ampere);
    let error = written(&image, Simulator::Mujoco, None).unwrap_err();
    assert!(error.to_string().contains("torque_constant_Nm_A"), "{error}");
    let request = Request { torque_per_ampere: Some(2.0), ..REQUEST };
    let xml = write(&image, Simulator::Mujoco, &request).unwrap();
    let [coulomb, viscous] = attributes(&xml, "joint", ["frictionloss", "damping"]);
    near(&coulomb, 6.0);
    near(&viscous, 1.4);
}

#[test]
fn a_patch_changes_the_joint_and_nothing_else() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let patched = written(&image, Simulator::MjcfPatch, Some((MJCF, "elbow"))).unwrap();
    let [coulomb, viscous, armature] = attributes(&patched, "joint", ["frictionloss", "damping", "armature"]);
    near(&coulomb, 3.0);
    near(&viscous, 0.7);
    // The arm: 0.24 + 1.5 * 0.04; the tool, turned by 90 degrees about x: 0.004 + 0.1 * (0.16 + 0.01 - 2 * 0.04) at z = -0.4 + 0.1.
    let tool = 0.004 + 0.1 * 0.3 * 0.3;
    near(&armature, 0.5 - 0.3 - tool);
    let lines = |text: &str| -> Vec<String> {
        text.lines()
            .filter(|line| !line.contains("elbow' axis") && !line.contains("Frikan"))
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(lines(&patched), lines(MJCF));
    assert_eq!(
        written(&image, Simulator::MjcfPatch, Some((&patched, "elbow"))).unwrap(),
        patched,
        "once more is the same"
    );
}

/// A constant torque that the law has of both directions alike and the rigid body takes back is none, and a load that drives and is
/// driven differently is inertia.
#[test]
fn what_law_and_rigid_body_share_is_taken_together() {
    let mut image = image_of(3.0, 0.7, Unit::NewtonMetre);
    image.model.rigid_body.offset = -0.35;
    let lifted = Effect::Asymmetry { coulomb: 0.35, viscous: 0.0, smoothing_velocity: 1e-4 };
    let load = Effect::Load {
        mean: 0.0,
        difference: 0.2,
        quadratic: 0.0,
        stribeck: 0.0,
        velocity: 1.0,
        smoothing_velocity: 0.01,
    };
    image.model.effects = heapless::Vec::from_slice(&[lifted, load]).unwrap();
    let content = Content::of(&image, &REQUEST).unwrap();
    assert!(content.body.offset.abs() < 1e-3, "{}", content.body.offset);
    assert!((content.coulomb_viscous.coulomb - 3.0).abs() < 2e-3, "{:?}", content.coulomb_viscous);
    assert!((content.inertia().unwrap() - 0.6).abs() < 1e-6);
    let patched = written(&image, Simulator::MjcfPatch, Some((MJCF, "elbow"))).unwrap();
    assert!(!patched.contains("Load-dependent friction"), "{patched}");
}

#[test]
fn what_a_file_lacks_is_told_with_its_row() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let error = written(&image, Simulator::Mujoco, Some((MJCF, "wrist"))).unwrap_err();
    assert!(error.code().id == "FRK-D030" && error.message().contains("elbow"), "{error}");
    let geometry =
        MJCF.replace("<inertial pos=\"0 0.1 0\" mass=\"0.1\" diaginertia=\"0 0 0.004\"/>", "<geom size=\".1\"/>");
    let error = written(&image, Simulator::Mujoco, Some((&geometry, "elbow"))).unwrap_err();
    assert_eq!(error.row(), Some(7), "{error}");
    assert!(error.message().contains("--inertia-of-model"), "{error}");
    assert!(written(&image, Simulator::Mujoco, Some(("<mujoco>", "elbow"))).is_err());
    assert!(
        written(
            &image_of(3.0, 0.7, Unit::Newton),
            Simulator::Mujoco,
            Some((&MJCF.replace("axis=", "type=\"hinge\" axis="), "elbow"))
        )
        .is_err()
    );
    assert_eq!(written(&image, Simulator::Drake, Some(("", "elbow"))).unwrap_err().code().id, "FRK-U001");
}

#[test]
fn urdf_sdf_and_usd_keep_the_file() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let urdf = "<robot name=\"r\">\n  <link name=\"a\"/>\n  <joint name=\"elbow\" type=\"revolute\">\n    <parent link=\"a\"/>\n    <dynamics damping='1'/>\n  </joint>\n</robot>\n";
    let patched = written(&image, Simulator::Urdf, Some((urdf, "elbow"))).unwrap();
    let [damping, friction] = attributes(&patched, "dynamics", ["damping", "friction"]);
    near(&damping, 0.7);
    near(&friction, 3.0);
    assert!(patched.starts_with("<robot name=\"r\">\n  <link name=\"a\"/>\n  <!-- "), "{patched}");
    assert_eq!(written(&image, Simulator::Urdf, Some((&patched, "elbow"))).unwrap(), patched);

    let sdf = "<sdf version=\"1.9\"><model name=\"m\">\n  <joint name=\"elbow\" type=\"revolute\">\n    <axis>\n      <xyz>0 1 0</xyz>\n      <dynamics>\n        <damping>9</damping>\n      </dynamics>\n    </axis>\n  </joint>\n</model></sdf>\n";
    let patched = written(&image, Simulator::Sdf, Some((sdf, "elbow"))).unwrap();
    let values = |text: &str| {
        ["damping", "friction"].map(|tag| {
            let document = roxmltree::Document::parse(text).unwrap();
            let node = document.descendants().find(|node| node.has_tag_name(tag)).unwrap();
            assert!(node.parent().unwrap().has_tag_name("dynamics"), "{text}");
            node.text().unwrap().to_owned()
        })
    };
    let [damping, friction] = values(&patched);
    near(&damping, 0.7);
    near(&friction, 3.0);
    assert!(patched.contains("      <xyz>0 1 0</xyz>\n      <dynamics>\n        <damping>"), "{patched}");
    let bare = sdf.replace("      <dynamics>\n        <damping>9</damping>\n      </dynamics>\n", "");
    let patched = written(&image, Simulator::Sdf, Some((&bare, "elbow"))).unwrap();
    near(&values(&patched)[0], 0.7);

    let usd = written(&image, Simulator::Usd, Some(("", "/robot/elbow"))).unwrap();
    assert!(
        usd.contains("@robot.usda@") && usd.contains("over \"robot\"\n{") && usd.contains("    over \"elbow\" ("),
        "{usd}"
    );
    let place = usd.find("viscousFrictionCoefficient = ").unwrap();
    let value = usd[place..].lines().next().unwrap().rsplit(' ').next().unwrap();
    near(value, 0.7f32.to_radians());
}

/// An image may hold what it adds to a rigid body that was given: then the bodies of the simulator are that rigid body.
#[test]
fn a_correction_of_a_given_rigid_body_is_the_armature() {
    let mut image = image_of(3.0, 0.7, Unit::NewtonMetre);
    image.model.rigid_body = RigidBody { inertia: 0.12, given_scale: 1.0, ..RigidBody::default() };
    let content = Content::of(&image, &REQUEST).unwrap();
    assert_eq!(content.inertia(), None, "of link and rotor it says nothing");
    assert!((content.armature(0.3).unwrap().unwrap() - 0.12).abs() < 1e-6);
    let patched = written(&image, Simulator::MjcfPatch, Some((MJCF, "elbow"))).unwrap();
    let [armature] = attributes(&patched, "joint", ["armature"]);
    near(&armature, 0.12);
}

/// Load-dependent friction of a tenth, over a load from -4 to 4 N m: 2 N m on average.
#[test]
fn load_friction_stands_at_its_mean() {
    let mut image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let load = Input { quantity: Quantity::Load, unit: Unit::NewtonMetre, low: -4.0, high: 4.0 };
    image.model.inputs.push(load).unwrap();
    let effect = Effect::Load {
        mean: 0.1,
        difference: 0.0,
        quadratic: 0.0,
        stribeck: 0.0,
        velocity: 1.0,
        smoothing_velocity: 0.001,
    };
    image.model.effects.push(effect).unwrap();
    let patched = written(&image, Simulator::MjcfPatch, Some((MJCF, "elbow"))).unwrap();
    let [loss] = attributes(&patched, "joint", ["frictionloss"]);
    near(&loss, 3.2);
    assert!(patched.contains("Load-dependent friction stands at its mean"), "{patched}");
}

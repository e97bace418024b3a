//! What goes into a file of MuJoCo, and what is refused.

use frikan_shared::units::Unit;

use super::super::tests::{MJCF, REQUEST, attributes, image_of, near, rich_image, written};
use super::super::{ModelFile, Release, Request, SimulatedActuator, Simulator, write};

#[test]
fn stribeck_friction_and_ripple_become_passive_motors() {
    let image = rich_image();
    let patched = written(&image, Simulator::Mujoco, Some((MJCF, "elbow"))).unwrap();
    let [level, viscous] = attributes(&patched, "joint", ["frictionloss", "damping"]);
    near(&viscous, 1.2);
    let [lugre, input] = attributes(&patched, "dcmotor", ["lugre", "input"]);
    assert_eq!(input, "none");
    let numbers: Vec<f32> = lugre.split(' ').map(|word| word.parse().unwrap()).collect();
    let level = level.parse::<f32>().unwrap();
    assert!(
        (level + numbers[2] - 2.0).abs() < 0.02
            && (level + numbers[3] - 3.0).abs() < 0.1
            && (numbers[4] - 0.1).abs() < 0.01,
        "{level} and {lugre}"
    );
    let [cogging, gear] = attributes(&patched, "dcmotor", ["cogging", "gear"]);
    near(&gear, 12.0);
    near(cogging.split(' ').next().unwrap(), 0.3 / 12.0);
    assert!(!patched.contains("Left out"), "{patched}");
    let again = written(&image, Simulator::Mujoco, Some((&patched, "elbow"))).unwrap();
    assert_eq!(again, patched, "once more is the same");
    // Without them, the motors of before go.
    let plain = written(&image_of(2.0, 1.2, Unit::NewtonMetre), Simulator::Mujoco, Some((&patched, "elbow"))).unwrap();
    assert!(!plain.contains("dcmotor"), "{plain}");
    let classic = written(&image, Simulator::MjcfPatch, Some((MJCF, "elbow"))).unwrap();
    assert!(classic.contains("Left out: position ripple"), "{classic}");
}

#[test]
fn a_file_for_one_simulator_has_what_that_one_reads() {
    let image = rich_image();
    let written_for = |release| {
        let file = ModelFile { text: MJCF, path: "", joint: "elbow", inertia_of_model: None, gains: None };
        write(&image, Simulator::Mujoco, &Request { into: Some(file), release: Some(release), ..REQUEST }).unwrap()
    };
    for release in [Release::Mujoco3, Release::Mjx, Release::Newton] {
        let text = written_for(release);
        assert!(!text.contains("dcmotor"), "{text}");
        let [damping] = attributes(&text, "joint", ["damping"]);
        assert!(damping.parse::<f32>().is_ok(), "{damping}");
        assert!(text.contains("Written for"), "{text}");
    }
    assert!(written_for(Release::Mujoco4).contains("dcmotor"));
    let request = Request { release: Some(Release::Mjx), ..REQUEST };
    assert_eq!(write(&image, Simulator::Urdf, &request).unwrap_err().code().id, "FRK-U001");
}

#[test]
fn what_cannot_be_right_is_refused_and_not_remarked() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let refused = |text: &str, joint: &str, what: &str| {
        let error = written(&image, Simulator::Mujoco, Some((text, joint))).unwrap_err();
        assert!(error.code().id == "FRK-D030" && error.message().contains(what), "{what}: {error}");
    };
    refused(&MJCF.replace("mass=\"1.5\"", "mass=\"15\""), "elbow", "no armature takes inertia away");
    refused(MJCF, "", "empty");
    let ball = MJCF.replace("axis=", "type=\"ball\" axis=");
    refused(&ball, "elbow", "another kind");
    let of_class = MJCF.replace("<worldbody>", "<default><joint type=\"ball\"/></default><worldbody>");
    refused(&of_class, "elbow", "another kind");
    refused(&MJCF.replace("0.001", "0"), "elbow", "timestep");
    let nameless = Request { joint: Some(""), ..REQUEST };
    let named = Request { joint: Some("knee"), ..REQUEST };
    for simulator in [Simulator::Isaac, Simulator::Drake] {
        assert_eq!(write(&image, simulator, &nameless).unwrap_err().code().id, "FRK-U001");
        assert!(write(&image, simulator, &named).unwrap().contains("\"knee\""));
    }
}

/// The gains come from the option, else from the file's actuator, else there are two.
#[test]
fn a_form_is_tried_under_the_controller_of_the_file() {
    let image = rich_image();
    let remark = |text: &str, gains| {
        let file = ModelFile { text, path: "", joint: "elbow", inertia_of_model: None, gains };
        write(&image, Simulator::Mujoco, &Request { into: Some(file), ..REQUEST }).unwrap()
    };
    let servo = MJCF.replace("<motor name=\"m\"", "<position kp=\"300\" kv=\"20\" name=\"m\"");
    assert!(remark(&servo, None).contains("the actuator of kp 300 and kv 20"));
    assert!(remark(&servo, Some([99.0, 9.0])).contains("a controller of kp 99 and kv 9"));
    let two = remark(MJCF, None);
    assert!(two.contains("`Euler`, 1 ms") && two.matches("a controller of kp").count() == 2, "{two}");
}

/// A PD controller becomes the file's own `position` actuator or one more, with gains, limit and delay; a motor of the file stays.
#[test]
fn the_actuator_goes_with_the_joint() {
    let image = image_of(3.0, 0.7, Unit::NewtonMetre);
    let pd = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\nkd_Nms_rad = 1.5\ntorque_limit_Nm = 12\ndelay_s = 0.003\n";
    let actuator = SimulatedActuator::of(&crate::joint::Joint::parse(pd).unwrap()).unwrap();
    let of = |text: &str, release| {
        let file = ModelFile { text, path: "", joint: "elbow", inertia_of_model: None, gains: None };
        let request = Request { into: Some(file), release: Some(release), actuator, ..REQUEST };
        write(&image, Simulator::Mujoco, &request).unwrap()
    };
    let bare = MJCF.replace("<motor name=\"m\" joint=\"elbow\"/>", "");
    let written = of(&bare, Release::Mujoco4);
    let names = ["kp", "kv", "forcerange", "delay", "nsample"];
    assert_eq!(attributes(&written, "position", names), ["40", "1.5", "-12 12", "0.003", "4"]);
    assert!(written.contains("the actuator of kp 40 and kv 1.5"), "{written}");
    assert_eq!(of(&written, Release::Mujoco4), written, "once more is the same");
    let own = MJCF.replace("<motor name=\"m\"", "<position name=\"m\" kp=\"1\"");
    let written = of(&own, Release::Mujoco3);
    assert_eq!(attributes(&written, "position", ["name", "kp"]), ["m", "40"]);
    assert!(!written.contains("nsample") && written.contains("its delay of 3 ms"), "{written}");
    assert!(of(MJCF, Release::Mujoco4).contains("stays as it is"));
    let isaac = write(&image, Simulator::Isaac, &Request { actuator, ..REQUEST }).unwrap();
    assert!(isaac.contains("stiffness=40,") && isaac.contains("effort_limit_sim=12,"), "{isaac}");
    let open = crate::joint::Joint::parse("[actuator]\nkind = \"pd\"\n").unwrap();
    assert_eq!(SimulatedActuator::of(&open).unwrap_err().column(), Some("actuator.kp_Nm_rad"));
}

//! The dynamics of an arm are Pinocchio's, and its distances Coal's.

use frikan_tests::arm::{BOXES, LIMITS, NEIGHBOURS, SIX_AXES, obstacles, solid_robot};
use frikan_tests::command::run;
use frikan_trainer::arm::chain::{Chain, INERTIAL};
use frikan_trainer::arm::dynamics::{NUMBERS, State, regressor, torques};
use serde_json::json;

use crate::programs::{json as parsed, python, script};

/// A slide between two turning joints, frames turned every way.
const MIXED: &str = r#"<robot name="r"><link name="base"/>
    <link name="table"><inertial><origin xyz="0.1 0 0.05" rpy="0.1 0.2 0.3"/><mass value="4"/><inertia ixx="0.2" iyy="0.25" izz="0.3" ixy="0.01" ixz="0.02" iyz="0"/></inertial></link>
    <link name="slide"><inertial><origin xyz="0 -0.1 0.2"/><mass value="2.5"/><inertia ixx="0.05" iyy="0.06" izz="0.04" ixy="0" ixz="0" iyz="0.01"/></inertial></link>
    <link name="wrist"><inertial><origin xyz="0.05 0.02 0.1"/><mass value="1.2"/><inertia ixx="0.01" iyy="0.012" izz="0.006" ixy="-0.001" ixz="0" iyz="0"/></inertial></link>
    <link name="tool"><inertial><origin xyz="0 0 0.03"/><mass value="0.3"/><inertia ixx="0.001" iyy="0.001" izz="0.0005" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="a" type="revolute"><origin xyz="0 0 0.3" rpy="0.2 0 0.1"/><parent link="base"/><child link="table"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
    <joint name="b" type="prismatic"><origin xyz="0.2 0 0.4" rpy="0.3 0.7 0"/><parent link="table"/><child link="slide"/><axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="c" type="revolute"><origin xyz="0 0.1 0.3" rpy="1 0.2 -0.4"/><parent link="slide"/><child link="wrist"/><axis xyz="0.8 0 0.6"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
    <joint name="flange" type="fixed"><origin xyz="0.1 0 0.1" rpy="0 1 0"/><parent link="wrist"/><child link="tool"/></joint></robot>"#;

#[test]
fn torques_and_their_regressor_are_pinocchios() {
    let Some(python) = python("pinocchio") else { return };
    for urdf in [MIXED, SIX_AXES] {
        let chain = Chain::parse(urdf, &[]).unwrap();
        let joints = chain.len();
        let value =
            |index: usize, joint: usize, scale: f64| scale * (1.3 * index as f64 + 2.1 * joint as f64 + scale).sin();
        let state =
            |index: usize| [1.5, 2.0, 6.0].map(|scale| (0..joints).map(|joint| value(index, joint, scale)).collect());
        let states: Vec<[Vec<f64>; 3]> = (0..8).map(state).collect();
        let folder = tempfile::tempdir().unwrap();
        let [file, list] = ["arm.urdf", "states.json"].map(|name| folder.path().join(name));
        std::fs::write(&file, urdf).unwrap();
        std::fs::write(&list, json!(states).to_string()).unwrap();
        let words = ["arm_dynamics.py", file.to_str().unwrap(), list.to_str().unwrap()];
        let theirs = parsed(&script(&python, &words));
        let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(theirs["joints"], json!(names));
        let bodies: Vec<_> = chain.joints.iter().map(|joint| joint.nominal).collect();
        for ([q, v, a], answer) in states.iter().zip(theirs["answers"].as_array().unwrap()) {
            let state = State { position: q, velocity: v, acceleration: a };
            let mut rows = vec![0.0; joints * joints * NUMBERS];
            regressor(&chain, &state, &mut rows);
            for (joint, torque) in torques(&chain, &bodies, &state).into_iter().enumerate() {
                let wanted = answer["torques"][joint].as_f64().unwrap();
                assert!(
                    (torque - wanted).abs() < 1e-9 * wanted.abs().max(1.0),
                    "{joint}: {torque}, Pinocchio {wanted}"
                );
                for number in 0..joints * INERTIAL {
                    let place = joint * joints * NUMBERS + number / INERTIAL * NUMBERS + number % INERTIAL;
                    let wanted = answer["regressor"][joint][number].as_f64().unwrap();
                    assert!((rows[place] - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{joint} {number}");
                }
            }
        }
    }
}

#[test]
fn a_robot_that_mujoco_wrote_out_is_the_same() {
    let Some(python) = python("mujoco") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [urdf, mjcf] = ["arm.urdf", "arm.xml"].map(|name| folder.path().join(name));
    std::fs::write(&urdf, SIX_AXES).unwrap();
    script(&python, &["arm_mjcf.py", urdf.to_str().unwrap(), mjcf.to_str().unwrap()]);
    let ours = Chain::parse(SIX_AXES, &[]).unwrap();
    let theirs = Chain { gravity: ours.gravity, ..Chain::parse(&std::fs::read_to_string(mjcf).unwrap(), &[]).unwrap() };
    let state = State { position: &[0.3, -1.0, 0.7, 1.2, -0.4, 2.0], velocity: &[1.0; 6], acceleration: &[-2.0; 6] };
    let [ours, theirs] = [ours, theirs].map(|chain| {
        let bodies: Vec<_> = chain.joints.iter().map(|joint| joint.nominal).collect();
        torques(&chain, &bodies, &state)
    });
    for (ours, theirs) in ours.iter().zip(&theirs) {
        // It writes six digits.
        assert!((ours - theirs).abs() < 1e-3 * ours.abs().max(1.0), "{ours} {theirs}");
    }
}

#[test]
fn a_planned_motion_keeps_clear_of_all_by_coals_distances() {
    let Some(python) = python("coal") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let write = |name: &str, text: &str| std::fs::write(at.join(name), text).unwrap();
    write("arm.urdf", &solid_robot());
    write("free.toml", LIMITS);
    write("boxes.toml", &format!("{LIMITS}{}", obstacles()));
    let boxes = BOXES.map(|(name, centre, size, yaw)| {
        json!({"name": name, "centre_m": centre, "size_m": size, "rpy_rad": [0.0, 0.0, yaw]})
    });
    write("boxes.json", &json!(boxes).to_string());
    write("touching.json", &json!(NEIGHBOURS).to_string());
    // The least of Coal's distances from a box, and of links from each other.
    let distances = |surroundings: &str| {
        let told = run(at, &["arm", "--urdf", "arm.urdf", "--joint", surroundings, "--advise", "motion.csv"]);
        assert_eq!(told.status, 0, "{}", told.messages);
        let files = ["arm.urdf", "boxes.json", "motion.csv", "touching.json"].map(|name| at.join(name));
        let words: Vec<&str> =
            ["arm_distances.py"].into_iter().chain(files.iter().map(|path| path.to_str().unwrap())).collect();
        let found = parsed(&script(&python, &words));
        let least = |of_boxes: bool| {
            let of = |pair: &&serde_json::Value| of_boxes == boxes.iter().any(|known| known["name"] == pair[1]);
            let pairs = found.as_array().unwrap().iter().filter(of);
            pairs.map(|pair| pair[2].as_f64().unwrap()).fold(f64::INFINITY, f64::min)
        };
        ([least(true), least(false)], told.output)
    };
    let ([to_boxes, to_links], _) = distances("free.toml");
    assert!(to_boxes < -0.05, "the motion without boxes would miss them: {to_boxes} m");
    assert!(to_links >= 0.02, "{to_links}");
    let (least, text) = distances("boxes.toml");
    for least in least {
        assert!(least >= 0.02, "{least} m: {text}");
        // Told within half a millimetre, of a motion that Coal looks at every 2.5 ms.
        let told = text.split(' ').zip(text.split(' ').skip(1)).filter(|(_, unit)| *unit == "m");
        let closest = told.filter_map(|(number, _)| number.parse::<f64>().ok()).map(|told| (told - least).abs());
        assert!(closest.fold(f64::INFINITY, f64::min) < 7e-4, "{least} m: {text}");
    }
}

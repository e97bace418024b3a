//! The body that moves with one joint of a URDF or MJCF file: inertia about the joint's axis and gravity over its angle, all other
//! joints standing at zero and gravity as the file has it, along -z of the root in a URDF.

use std::collections::BTreeSet;

use nalgebra::Isometry3;

use crate::error::{Error, Result, codes};
use crate::robot::{Body, Joint, Kind, Robot, parse};

/// What moves with a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MovedBody {
    /// kg m2 about the axis of a revolute joint, kg along that of a prismatic one.
    pub(super) inertia: f64,
    /// Gravity torque as amplitude (N m) and phase (rad) of amplitude * sin(angle + phase); a prismatic joint has none,
    /// its gravity being a constant force.
    pub(super) gravity: Option<(f64, f64)>,
}

/// The body moved by the joint of this name, or by the only moving joint.
///
/// # Errors
/// `FRK-D021` with its row when the file describes no robot, lacks the joint, or nothing that moves has a mass.
pub(super) fn moved_body(text: &str, name: Option<&str>) -> Result<MovedBody> {
    let robot = parse(text)?;
    let joint = find_joint(&robot, name)?;
    let axis = joint.axis;
    let down = pose_in_root(&robot, joint)?.rotation.inverse() * robot.gravity;

    let (mut mass, mut inertia, mut sine, mut cosine) = (0.0, 0.0, 0.0, 0.0);
    for body in moved_bodies(&robot, joint)? {
        mass += body.mass;
        let lever = axis.cross(&body.centre);
        inertia += axis.dot(&(body.inertia * axis)) + body.mass * lever.norm_squared();
        // The centre moves along axis x R(q) p = cos q (axis x p) + sin q (axis x (axis x p)); the joint holds its weight.
        cosine -= body.mass * down.dot(&lever);
        sine -= body.mass * down.dot(&axis.cross(&lever));
    }
    if joint.kind == Kind::Prismatic && mass > 0.0 {
        return Ok(MovedBody { inertia: mass, gravity: None });
    }
    if inertia <= 0.0 {
        return Err(joint.error("nothing that moves with this joint has a mass"));
    }
    Ok(MovedBody { inertia, gravity: Some((sine.hypot(cosine), cosine.atan2(sine))) })
}

fn find_joint<'a>(robot: &'a Robot, name: Option<&str>) -> Result<&'a Joint> {
    let candidates: Vec<&Joint> = robot.joints.iter().filter(|joint| joint.kind != Kind::Fixed).collect();
    let named = candidates.iter().find(|joint| name == Some(&joint.name));
    match (named, name, candidates.as_slice()) {
        (Some(joint), _, _) => Ok(joint),
        (None, None, [joint]) => Ok(joint),
        _ => {
            let names: Vec<&str> = candidates.iter().map(|joint| joint.name.as_str()).collect();
            let message = format!("`[rigid_body] joint` has to name one of the moving joints: {}", names.join(", "));
            Err(Error::new(&codes::BAD_URDF, message).with_value(name.unwrap_or("")))
        }
    }
}

/// Every body beyond the joint, down the tree, in the frame of the joint.
fn moved_bodies(robot: &Robot, joint: &Joint) -> Result<Vec<Body>> {
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    let mut open = vec![(joint.child.as_str(), Isometry3::identity())];
    while let Some((name, pose)) = open.pop() {
        if !seen.insert(name) {
            return Err(joint.error("the links beyond this joint form a loop"));
        }
        found.push(robot.body(name).seen_from(&pose));
        let beyond = robot.joints.iter().filter(|next| next.parent == name);
        open.extend(beyond.map(|next| (next.child.as_str(), pose * next.pose)));
    }
    Ok(found)
}

/// Pose of the joint's frame in the root, through the joints between them.
fn pose_in_root(robot: &Robot, joint: &Joint) -> Result<Isometry3<f64>> {
    let mut pose = joint.pose;
    let mut link = &joint.parent;
    for _ in &robot.joints {
        let Some(above) = robot.joints.iter().find(|candidate| candidate.child == *link) else { return Ok(pose) };
        pose = above.pose * pose;
        link = &above.parent;
    }
    Err(joint.error("the links before this joint form a loop"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = r#"<robot name="arm">
        <link name="base"/>
        <link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/><inertia ixx="0.03" iyy="0.03" izz="0.01"/></inertial></link>
        <link name="lower"><inertial><origin xyz="0 0 -0.1"/><mass value="1"/><inertia ixx="0.01" iyy="0.02" izz="0.003"/></inertial></link>
        <link name="tool"><inertial><mass value="0.5"/></inertial></link>
        <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
        <joint name="elbow" type="continuous"><origin xyz="0 0 -0.4"/><parent link="upper"/><child link="lower"/><axis xyz="0 2 0"/></joint>
        <joint name="flange" type="fixed"><origin xyz="0.1 0 -0.2"/><parent link="lower"/><child link="tool"/></joint>
    </robot>"#;

    #[test]
    fn inertia_and_gravity_of_a_hanging_arm_are_those_of_its_parts() {
        let body = moved_body(ARM, Some("shoulder")).unwrap();
        let inertia = 0.03 + 2.0 * 0.04 + 0.02 + 0.25 + 0.5 * (0.36 + 0.01);
        assert!((body.inertia - inertia).abs() < 1e-12, "{body:?}");
        let (amplitude, phase) = body.gravity.unwrap();
        // Potential of each part at angle q about y: m g z.
        let potential = |q: f64| {
            let part = |m: f64, x: f64, z: f64| m * 9.806_65 * (z * q.cos() - x * q.sin());
            part(2.0, 0.0, -0.2) + part(1.0, 0.0, -0.5) + part(0.5, 0.1, -0.6)
        };
        for q in [-2.0, -0.3, 0.0, 0.9, 3.0] {
            let slope = (potential(q + 1e-5) - potential(q - 1e-5)) / 2e-5;
            assert!((amplitude * (q + phase).sin() - slope).abs() < 1e-6, "{q}");
        }
    }

    #[test]
    fn an_axis_of_any_length_and_a_turned_base_are_understood() {
        let elbow = moved_body(ARM, Some("elbow")).unwrap();
        assert!((elbow.inertia - (0.02 + 0.01 + 0.5 * 0.05)).abs() < 1e-12);
        let lying =
            ARM.replace(r#"<parent link="base"/>"#, r#"<origin rpy="1.5707963267948966 0 0"/><parent link="base"/>"#);
        let (amplitude, _) = moved_body(&lying, Some("shoulder")).unwrap().gravity.unwrap();
        assert!(amplitude < 1e-9, "an upright axis feels no gravity: {amplitude}");
    }

    #[test]
    fn what_is_missing_is_told_with_its_row() {
        assert!(moved_body(ARM, None).unwrap_err().message().contains("shoulder, elbow"));
        assert!(moved_body(ARM, Some("wrist")).is_err());
        let error = moved_body(&ARM.replace("0 0 -0.4", "0 0 x"), Some("shoulder")).unwrap_err();
        assert_eq!((error.code().id, error.row(), error.column()), ("FRK-D021", Some(7), Some("xyz")));
        assert_eq!(moved_body("<robot>", None).unwrap_err().code().id, "FRK-D021");
        let looped = ARM.replace(r#"<child link="tool"/>"#, r#"<child link="upper"/>"#);
        assert!(moved_body(&looped, Some("shoulder")).is_err());
    }
}

//! The body that moves with one joint of a URDF: inertia about the joint's axis and gravity over its angle, all other
//! joints standing at zero and gravity along -z of the root.

use std::collections::BTreeSet;

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use crate::error::{Error, Result, codes};

/// Standard acceleration of gravity, m/s2.
const GRAVITY_M_S2: f64 = 9.806_65;

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
/// `FRK-D021` with its row when the file is no URDF, lacks the joint, or nothing that moves has a mass.
pub(super) fn moved_body(text: &str, name: Option<&str>) -> Result<MovedBody> {
    let document = Document::parse(text)
        .map_err(|error| Error::new(&codes::BAD_URDF, error.to_string()).at_row(u64::from(error.pos().row)))?;
    let robot = document.root_element();
    let joint = find_joint(robot, name)?;
    let prismatic = joint.attribute("type") == Some("prismatic");
    let axis = match child(joint, "axis") {
        Some(axis) => vector(axis, "xyz", [1.0, 0.0, 0.0])?,
        None => Vector3::x(),
    };
    let Some(axis) = axis.try_normalize(1e-9) else { return Err(at(joint, "the axis of this joint has no direction")) };
    let down = pose_in_root(robot, joint)?.rotation.inverse() * Vector3::new(0.0, 0.0, -GRAVITY_M_S2);

    let (mut mass, mut inertia, mut sine, mut cosine) = (0.0, 0.0, 0.0, 0.0);
    for link in moved_links(robot, joint)? {
        mass += link.mass;
        let lever = axis.cross(&link.centre);
        inertia += axis.dot(&(link.inertia * axis)) + link.mass * lever.norm_squared();
        // The centre moves along axis x R(q) p = cos q (axis x p) + sin q (axis x (axis x p)); the joint holds its weight.
        cosine -= link.mass * down.dot(&lever);
        sine -= link.mass * down.dot(&axis.cross(&lever));
    }
    if prismatic && mass > 0.0 {
        return Ok(MovedBody { inertia: mass, gravity: None });
    }
    if inertia <= 0.0 {
        return Err(at(joint, "nothing that moves with this joint has a mass"));
    }
    Ok(MovedBody { inertia, gravity: Some((sine.hypot(cosine), cosine.atan2(sine))) })
}

/// Mass, centre and inertia of a link in the frame of the joint.
struct Link {
    mass: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

fn joints<'a, 'i>(robot: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    robot.children().filter(|node| node.has_tag_name("joint"))
}

fn find_joint<'a, 'i>(robot: Node<'a, 'i>, name: Option<&str>) -> Result<Node<'a, 'i>> {
    let moving = |joint: &Node| matches!(joint.attribute("type"), Some("revolute" | "continuous" | "prismatic"));
    let candidates: Vec<Node> = joints(robot).filter(moving).collect();
    let named = candidates.iter().find(|joint| name.is_some() && joint.attribute("name") == name);
    match (named, name, candidates.as_slice()) {
        (Some(joint), _, _) => Ok(*joint),
        (None, None, [joint]) => Ok(*joint),
        _ => {
            let names: Vec<&str> = candidates.iter().filter_map(|joint| joint.attribute("name")).collect();
            let message = format!("`[rigid_body] joint` has to name one of the moving joints: {}", names.join(", "));
            Err(Error::new(&codes::BAD_URDF, message).with_value(name.unwrap_or("")))
        }
    }
}

/// Every link beyond the joint, down the tree.
fn moved_links(robot: Node, joint: Node) -> Result<Vec<Link>> {
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    let mut open = vec![(link_name(joint, "child")?, Isometry3::identity())];
    while let Some((name, pose)) = open.pop() {
        if !seen.insert(name) {
            return Err(at(joint, "the links beyond this joint form a loop"));
        }
        let link = robot.children().find(|node| node.has_tag_name("link") && node.attribute("name") == Some(name));
        if let Some(inertial) = link.and_then(|link| child(link, "inertial")) {
            found.push(read_inertial(inertial, &pose)?);
        }
        for next in joints(robot) {
            if link_name(next, "parent")? == name {
                open.push((link_name(next, "child")?, pose * origin(next)?));
            }
        }
    }
    Ok(found)
}

fn read_inertial(inertial: Node, pose: &Isometry3<f64>) -> Result<Link> {
    let pose = pose * origin(inertial)?;
    let mass = child(inertial, "mass").map_or(Ok(0.0), |node| number(node, "value", 0.0))?;
    let inertia = match child(inertial, "inertia") {
        None => Matrix3::zeros(),
        Some(node) => {
            let [xx, yy, zz] = [number(node, "ixx", 0.0)?, number(node, "iyy", 0.0)?, number(node, "izz", 0.0)?];
            let [xy, xz, yz] = [number(node, "ixy", 0.0)?, number(node, "ixz", 0.0)?, number(node, "iyz", 0.0)?];
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        }
    };
    let rotation = pose.rotation.to_rotation_matrix();
    Ok(Link { mass, centre: pose.translation.vector, inertia: rotation * inertia * rotation.transpose() })
}

/// Pose of the joint's frame in the root, through the joints between them.
fn pose_in_root(robot: Node, joint: Node) -> Result<Isometry3<f64>> {
    let mut pose = origin(joint)?;
    let mut link = link_name(joint, "parent")?;
    for _ in joints(robot) {
        let mut above = None;
        for candidate in joints(robot) {
            if link_name(candidate, "child")? == link {
                above = Some(candidate);
            }
        }
        let Some(above) = above else { return Ok(pose) };
        pose = origin(above)? * pose;
        link = link_name(above, "parent")?;
    }
    Err(at(joint, "the links before this joint form a loop"))
}

fn link_name<'a>(joint: Node<'a, '_>, side: &str) -> Result<&'a str> {
    let link = child(joint, side).and_then(|node| node.attribute("link"));
    link.ok_or_else(|| at(joint, &format!("this joint names no {side} link")))
}

fn origin(node: Node) -> Result<Isometry3<f64>> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let xyz = vector(origin, "xyz", [0.0; 3])?;
    let rpy = vector(origin, "rpy", [0.0; 3])?;
    Ok(Isometry3::from_parts(Translation3::from(xyz), UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z)))
}

fn child<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|inner| inner.has_tag_name(tag))
}

fn number(node: Node, attribute: &str, absent: f64) -> Result<f64> {
    let Some(text) = node.attribute(attribute) else { return Ok(absent) };
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(at(node, "this is not a finite number").in_column(attribute).with_value(text)),
    }
}

fn vector(node: Node, attribute: &str, absent: [f64; 3]) -> Result<Vector3<f64>> {
    let Some(text) = node.attribute(attribute) else { return Ok(Vector3::from(absent)) };
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|part| part.parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|value: &f64| value.is_finite()) => Ok(Vector3::new(x, y, z)),
        _ => Err(at(node, "three finite numbers are needed here").in_column(attribute).with_value(text)),
    }
}

fn at(node: Node, message: &str) -> Error {
    let row = node.document().text_pos_at(node.range().start).row;
    Error::new(&codes::BAD_URDF, message).at_row(u64::from(row))
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
            let part = |m: f64, x: f64, z: f64| m * GRAVITY_M_S2 * (z * q.cos() - x * q.sin());
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

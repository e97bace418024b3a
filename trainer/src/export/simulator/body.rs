//! The inertia that the bodies of an MJCF file have about a joint, as far as the file says it in numbers.

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// Attributes that turn a frame in other ways than by a quaternion.
const OTHER_TURNS: [&str; 4] = ["euler", "axisangle", "xyaxes", "zaxis"];

/// Elements whose bodies stand elsewhere.
const ELSEWHERE: [&str; 5] = ["include", "frame", "replicate", "attach", "composite"];

/// Inertia about the axis of a joint (kg m2, or kg along that of a slide) of the body that holds it and of all beneath, every other
/// joint standing at its reference.
///
/// # Errors
/// In words, why the file does not say it: what has to be worked out from geometries, defaults or other files is left to MuJoCo.
pub(super) fn inertia_about(joint: Node) -> Result<f64, String> {
    let body = joint.parent().filter(|parent| parent.has_tag_name("body")).ok_or("the joint stands in no body")?;
    if joint.document().descendants().any(|node| node.attribute("inertiafromgeom") == Some("true")) {
        return Err("the file takes inertia from geometries".to_owned());
    }
    let axis = vector(joint, "axis", Vector3::z())?.try_normalize(1e-9).ok_or("the axis has no direction")?;
    let anchor = vector(joint, "pos", Vector3::zeros())?;
    let is_slide = joint.attribute("type") == Some("slide");
    let mut sum = 0.0;
    let mut open = vec![(body, Isometry3::identity())];
    while let Some((body, pose)) = open.pop() {
        let name = body.attribute("name").unwrap_or("without name");
        if let Some(other) = body.children().find(|node| ELSEWHERE.iter().any(|tag| node.has_tag_name(*tag))) {
            return Err(format!("body {name} holds `{}`", other.tag_name().name()));
        }
        match body.children().find(|node| node.has_tag_name("inertial")) {
            Some(inertial) => {
                let (mass, centre, inertia) = read_inertial(inertial, &pose)?;
                let lever = axis.cross(&(centre - anchor));
                sum += if is_slide { mass } else { axis.dot(&(inertia * axis)) + mass * lever.norm_squared() };
            }
            None if body.children().any(|node| node.has_tag_name("geom")) => {
                return Err(format!("body {name} has its inertia from geometries"));
            }
            None => {}
        }
        for inner in body.children().filter(|node| node.has_tag_name("body")) {
            open.push((inner, pose * frame(inner)?));
        }
    }
    Ok(sum)
}

fn read_inertial(inertial: Node, pose: &Isometry3<f64>) -> Result<(f64, Vector3<f64>, Matrix3<f64>), String> {
    let pose = pose * frame(inertial)?;
    let mass = numbers::<1>(inertial, "mass")?.map_or(0.0, |[mass]| mass);
    let inertia = match (numbers::<3>(inertial, "diaginertia")?, numbers::<6>(inertial, "fullinertia")?) {
        (Some(diagonal), _) => Matrix3::from_diagonal(&Vector3::from(diagonal)),
        (None, Some([xx, yy, zz, xy, xz, yz])) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
        (None, None) => Matrix3::zeros(),
    };
    let rotation = pose.rotation.to_rotation_matrix();
    Ok((mass, pose.translation.vector, rotation * inertia * rotation.transpose()))
}

fn frame(node: Node) -> Result<Isometry3<f64>, String> {
    if let Some(turn) = OTHER_TURNS.iter().find(|turn| node.has_attribute(**turn)) {
        return Err(format!("a frame is turned by `{turn}`"));
    }
    let translation = Translation3::from(vector(node, "pos", Vector3::zeros())?);
    let [w, x, y, z] = numbers::<4>(node, "quat")?.unwrap_or([1.0, 0.0, 0.0, 0.0]);
    Ok(Isometry3::from_parts(translation, UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))))
}

fn vector(node: Node, name: &str, absent: Vector3<f64>) -> Result<Vector3<f64>, String> {
    Ok(numbers::<3>(node, name)?.map_or(absent, Vector3::from))
}

/// The numbers of an attribute; `None` where it is absent.
pub(super) fn numbers<const N: usize>(node: Node, name: &str) -> Result<Option<[f64; N]>, String> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let values: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let values = values.try_into().map_err(|_| format!("`{name}=\"{text}\"` is not {N} numbers"))?;
    Ok(Some(values))
}

//! URDF: links beside each other, and joints that name the two that they join.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::model::{Body, GRAVITY_M_S2, Joint, Kind, Link, Robot, at, row};
use crate::error::Result;

/// # Errors
/// `FRK-D021` with its row when a number is none, or a joint names no links.
pub(super) fn parse(document: &Document) -> Result<Robot> {
    let robot = document.root_element();
    let of = |tag: &'static str| robot.children().filter(move |node| node.has_tag_name(tag));
    Ok(Robot {
        links: of("link").map(link).collect::<Result<_>>()?,
        joints: of("joint").map(joint).collect::<Result<_>>()?,
        gravity: Vector3::new(0.0, 0.0, -GRAVITY_M_S2),
    })
}

fn link(node: Node) -> Result<Link> {
    let name = node.attribute("name").unwrap_or_default().to_owned();
    let Some(inertial) = child(node, "inertial") else { return Ok(Link { name, body: Body::default() }) };
    let mass = child(inertial, "mass").map_or(Ok(0.0), |node| number(node, "value", 0.0))?;
    let inertia = match child(inertial, "inertia") {
        None => Matrix3::zeros(),
        Some(node) => {
            let [xx, yy, zz] = [number(node, "ixx", 0.0)?, number(node, "iyy", 0.0)?, number(node, "izz", 0.0)?];
            let [xy, xz, yz] = [number(node, "ixy", 0.0)?, number(node, "ixz", 0.0)?, number(node, "iyz", 0.0)?];
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        }
    };
    let in_own_frame = Body { mass, centre: Vector3::zeros(), inertia };
    Ok(Link { name, body: in_own_frame.seen_from(&origin(inertial)?) })
}

fn joint(node: Node) -> Result<Joint> {
    let kind = match node.attribute("type") {
        Some("revolute" | "continuous") => Kind::Revolute,
        Some("prismatic") => Kind::Prismatic,
        _ => Kind::Fixed,
    };
    let axis = child(node, "axis").map_or(Ok(Vector3::x()), |axis| vector(axis, "xyz", [1.0, 0.0, 0.0]))?;
    let axis = match axis.try_normalize(1e-9) {
        Some(axis) => axis,
        None if kind == Kind::Fixed => Vector3::x(),
        None => return Err(at(node, "the axis of this joint has no direction")),
    };
    let limit = child(node, "limit").filter(|_| node.attribute("type") != Some("continuous"));
    let ends = |limit| -> Result<[f64; 2]> { Ok([number(limit, "lower", 0.0)?, number(limit, "upper", 0.0)?]) };
    let limits = limit.map(ends).transpose()?;
    Ok(Joint {
        name: node.attribute("name").unwrap_or_default().to_owned(),
        kind,
        parent: link_name(node, "parent")?,
        child: link_name(node, "child")?,
        pose: origin(node)?,
        axis,
        limits: limits.filter(|[lower, upper]| lower < upper),
        is_mimic: child(node, "mimic").is_some(),
        row: row(node),
    })
}

fn link_name(joint: Node, side: &str) -> Result<String> {
    let link = child(joint, side).and_then(|node| node.attribute("link"));
    link.map(str::to_owned).ok_or_else(|| at(joint, &format!("this joint names no {side} link")))
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

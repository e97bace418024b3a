//! URDF: links beside each other, and joints that name the two that they join.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::model::{Beside, Body, Form, GRAVITY_M_S2, Joint, Kind, Link, Robot, Solid, at, row};
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
    let body = child(node, "inertial").map_or(Ok(Body::default()), body)?;
    let collisions = || node.children().filter(|inner| inner.has_tag_name("collision"));
    let solids: Vec<Option<Solid>> = collisions().map(solid).collect::<Result<_>>()?;
    let beside = if solids.iter().any(Option::is_none) || (solids.is_empty() && child(node, "visual").is_some()) {
        Beside::Unread
    } else if solids.is_empty() {
        Beside::Unsaid
    } else {
        Beside::Nothing
    };
    Ok(Link { name, body, solids: solids.into_iter().flatten().collect(), beside })
}

/// What may not be run into of a link; `None` where that is no solid, such as a mesh or what has no extent.
fn solid(collision: Node) -> Result<Option<Solid>> {
    let of = |tag: &str| child(collision, "geometry").and_then(|geometry| child(geometry, tag));
    let form = if let Some(node) = of("box") {
        Form::Box { half: 0.5 * vector(node, "size", [0.0; 3])? }
    } else if let Some(node) = of("sphere") {
        Form::Sphere { radius: number(node, "radius", 0.0)? }
    } else if let Some(node) = of("cylinder") {
        Form::Cylinder { radius: number(node, "radius", 0.0)?, half_length: 0.5 * number(node, "length", 0.0)? }
    } else if let Some(node) = of("capsule") {
        Form::Capsule { radius: number(node, "radius", 0.0)?, half_length: 0.5 * number(node, "length", 0.0)? }
    } else {
        return Ok(None);
    };
    Ok(form.has_extent().then_some(Solid { pose: origin(collision)?, form }))
}

fn body(inertial: Node) -> Result<Body> {
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
    Ok(in_own_frame.seen_from(&origin(inertial)?))
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

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::{Beside, Form};

    const LINKS: &str = r#"<robot name="r"><link name="a"><collision><origin xyz="0 0 1" rpy="0 1.5 0"/><geometry><box size="0.2 0.4 0.6"/></geometry></collision>
        <collision><geometry><cylinder radius="0.1" length="0.5"/></geometry></collision></link>
        <link name="b"><collision><geometry><mesh filename="b.stl"/></geometry></collision><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
        <link name="c"><visual><geometry><box size="1 1 1"/></geometry></visual></link><link name="d"/></robot>"#;

    #[test]
    fn solids_of_links_are_read() {
        let links = parse(LINKS).unwrap().links;
        let [first, second] = links[0].solids[..] else { panic!("{:?}", links[0]) };
        assert_eq!(first.form, Form::Box { half: [0.1, 0.2, 0.3].into() });
        assert!(first.pose.translation.z == 1.0 && (first.pose.rotation.angle() - 1.5).abs() < 1e-12);
        assert_eq!(second.form, Form::Cylinder { radius: 0.1, half_length: 0.25 });
        let beside: Vec<Beside> = links.iter().map(|link| link.beside).collect();
        assert_eq!(beside, [Beside::Nothing, Beside::Unread, Beside::Unread, Beside::Unsaid]);
        assert_eq!(links[1].solids[0].form, Form::Sphere { radius: 0.1 });
    }

    #[test]
    fn shapes_without_extent_are_none_and_without_numbers_refused() {
        let flat = parse(&LINKS.replace("0.2 0.4 0.6", "0.2 0 0.6")).unwrap();
        assert_eq!((flat.links[0].beside, flat.links[0].solids.len()), (Beside::Unread, 1));
        let error = parse(&LINKS.replace("0.2 0.4 0.6", "0.2 0.6")).unwrap_err();
        assert!(error.code().id == "FRK-D021" && error.row().is_some() && error.column() == Some("size"));
    }
}

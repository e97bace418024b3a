//! A robot as its URDF file describes it: links with their bodies, and the joints between them.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use crate::error::{Error, Result, codes};

/// Standard acceleration of gravity, m/s2.
pub(crate) const GRAVITY_M_S2: f64 = 9.806_65;

/// What a file describes, in its order.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
}

/// A link. Without `<inertial>` it has no mass.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) body: Body,
}

/// Mass and its distribution, in the frame of the link or of whatever the body was moved to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Body {
    /// kg.
    pub(crate) mass: f64,
    /// m.
    pub(crate) centre: Vector3<f64>,
    /// About the centre, kg m2.
    pub(crate) inertia: Matrix3<f64>,
}

impl Body {
    /// The same body seen from a frame in which its own has this pose.
    pub(crate) fn seen_from(&self, pose: &Isometry3<f64>) -> Self {
        let rotation = pose.rotation.to_rotation_matrix();
        let centre = (pose * nalgebra::Point3::from(self.centre)).coords;
        Self { mass: self.mass, centre, inertia: rotation * self.inertia * rotation.transpose() }
    }
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Turns about its axis.
    Revolute,
    /// Slides along it.
    Prismatic,
    /// Neither: fixed, or of a type that has more than one degree of freedom.
    Fixed,
}

/// A joint.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) parent: String,
    pub(crate) child: String,
    /// Of the child's frame in the parent's where the joint stands at zero.
    pub(crate) pose: Isometry3<f64>,
    /// Of length one, in the child's frame.
    pub(crate) axis: Vector3<f64>,
    /// Lowest and highest position, rad or m; `None` where the file gives none.
    pub(crate) limits: Option<[f64; 2]>,
    /// Whether it follows another joint.
    pub(crate) is_mimic: bool,
    /// Row of the file.
    pub(crate) row: u64,
}

impl Robot {
    /// # Errors
    /// `FRK-D021` with its row when the text is no URDF, or a number in it is none.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let document = Document::parse(text)
            .map_err(|error| Error::new(&codes::BAD_URDF, error.to_string()).at_row(u64::from(error.pos().row)))?;
        let robot = document.root_element();
        let of = |tag: &'static str| robot.children().filter(move |node| node.has_tag_name(tag));
        Ok(Self {
            links: of("link").map(link).collect::<Result<_>>()?,
            joints: of("joint").map(joint).collect::<Result<_>>()?,
        })
    }

    /// The body of a link; none where there is no such link.
    pub(crate) fn body(&self, link: &str) -> Body {
        self.links.iter().find(|own| own.name == link).map_or_else(Body::default, |own| own.body)
    }
}

impl Joint {
    /// An error in this joint.
    pub(crate) fn error(&self, message: &str) -> Error {
        Error::new(&codes::BAD_URDF, message).at_row(self.row)
    }
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

fn at(node: Node, message: &str) -> Error {
    Error::new(&codes::BAD_URDF, message).at_row(row(node))
}

fn row(node: Node) -> u64 {
    u64::from(node.document().text_pos_at(node.range().start).row)
}

//! MJCF, the format of MuJoCo: bodies within bodies, each with the joints that move it. Frames, default classes and inertias that the file gives in
//! numbers are understood; what has to be worked out from geometries or other files is not, and such bodies have no known mass.

mod geoms;

use nalgebra::{Isometry3, Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::model::{Beside, Body, Joint, Kind, Link, OF_FRAME, Robot, at, row, z_along};
use crate::error::Result;

/// Elements whose bodies stand elsewhere.
const ELSEWHERE: [&str; 5] = ["include", "frame", "replicate", "attach", "composite"];

/// Gravity of MuJoCo where the file gives none, m/s2.
const GRAVITY_M_S2: f64 = 9.81;

/// What holds for the whole file.
struct File<'a, 'i> {
    document: &'a Document<'i>,
    in_degrees: bool,
    /// Axes about which `euler` turns, one after the other.
    order: String,
}

/// # Errors
/// `FRK-D021` with its row where the file says what is not understood.
pub(super) fn parse(document: &Document) -> Result<Robot> {
    let compiler = |name: &str| {
        let nodes = document.root_element().children().filter(|node| node.has_tag_name("compiler"));
        nodes.filter_map(|node| node.attribute(name)).next_back().map(str::to_owned)
    };
    let file = File {
        document,
        in_degrees: compiler("angle").as_deref() != Some("radian"),
        order: compiler("eulerseq").unwrap_or_else(|| "xyz".to_owned()),
    };
    let world = "world".to_owned();
    let option = document.root_element().children().find(|node| node.has_tag_name("option"));
    let gravity = option.map(|option| file.vector(option, None, "gravity")).transpose()?.flatten();
    let gravity = gravity.unwrap_or(Vector3::new(0.0, 0.0, -GRAVITY_M_S2));
    let mut robot = Robot { links: vec![Link::frame(&world)], joints: Vec::new(), gravity };
    let worlds = document.root_element().children().filter(|node| node.has_tag_name("worldbody"));
    // Bodies that are still to be read, the next one last: in which link, and the default class of joints there.
    let mut open: Vec<(Node, String, Option<String>)> = Vec::new();
    for node in worlds {
        let (solids, is_all) = file.solids(node, None)?;
        let fixed = &mut robot.links[0];
        fixed.solids.extend(solids);
        if !is_all {
            fixed.beside = Beside::Unread;
        }
        push_inner(&mut open, node, &world, None)?;
    }
    while let Some((body, parent, class)) = open.pop() {
        let class = body.attribute("childclass").map(str::to_owned).or(class);
        let name = body.attribute("name").map_or_else(|| format!("body in row {}", row(body)), str::to_owned);
        let own = file.read_body(body, &name, parent, class.as_deref(), &mut robot)?;
        push_inner(&mut open, body, &own, class)?;
    }
    Ok(robot)
}

fn push_inner<'a, 'i>(
    open: &mut Vec<(Node<'a, 'i>, String, Option<String>)>,
    node: Node<'a, 'i>,
    link: &str,
    class: Option<String>,
) -> Result<()> {
    if let Some(other) = node.children().find(|inner| ELSEWHERE.contains(&inner.tag_name().name())) {
        return Err(at(other, "this element is not understood: let MuJoCo write the model out, by `mj_saveLastXML`"));
    }
    let bodies: Vec<Node> = node.children().filter(|inner| inner.has_tag_name("body")).collect();
    open.extend(bodies.into_iter().rev().map(|body| (body, link.to_owned(), class.clone())));
    Ok(())
}

impl File<'_, '_> {
    /// Adds the joints and links of a body; the name of the link that its inner bodies stand in.
    fn read_body(
        &self,
        body: Node,
        name: &str,
        parent: String,
        class: Option<&str>,
        robot: &mut Robot,
    ) -> Result<String> {
        let moving = body.children().filter(|node| node.has_tag_name("joint") || node.has_tag_name("freejoint"));
        let moving: Vec<Node> = moving.collect();
        let (mut parent, mut pose) = (parent, self.frame(body, None)?);
        for (index, &node) in moving.iter().enumerate() {
            let kind = match self.attribute(node, class, "type").unwrap_or("hinge") {
                "hinge" if !node.has_tag_name("freejoint") => Kind::Revolute,
                "slide" => Kind::Prismatic,
                _ => return Err(at(node, "only hinges and slides on a fixed base are understood")),
            };
            let anchor = self.vector(node, class, "pos")?.unwrap_or_default();
            let axis = self.vector(node, class, "axis")?.unwrap_or_else(Vector3::z);
            let axis = axis.try_normalize(1e-9).ok_or_else(|| at(node, "the axis of this joint has no direction"))?;
            let range = self.numbers::<2>(node, class, "range")?.filter(|[low, high]| low < high);
            let turn = if self.in_degrees && kind == Kind::Revolute { 1.0_f64.to_radians() } else { 1.0 };
            // A joint turns about its anchor: its link has its origin there. The last one moves what the body is called by.
            let is_last = index + 1 == moving.len();
            let link = if is_last { name.to_owned() } else { format!("{name}, joint {}", index + 1) };
            let joint_name = node.attribute("name").map_or_else(|| link.clone(), str::to_owned);
            pose *= Translation3::from(anchor);
            robot.joints.push(Joint {
                name: joint_name,
                kind,
                parent,
                child: link.clone(),
                pose,
                axis,
                limits: range.map(|range| range.map(|end| end * turn)),
                is_mimic: false,
                row: row(node),
            });
            robot.links.push(Link::frame(&link));
            (parent, pose) = (link, Isometry3::from(Translation3::from(-anchor)));
        }
        let frame = if moving.is_empty() { name.to_owned() } else { format!("{name}{OF_FRAME}") };
        robot.joints.push(Joint {
            name: String::new(),
            kind: Kind::Fixed,
            parent,
            child: frame.clone(),
            pose,
            axis: Vector3::x(),
            limits: None,
            is_mimic: false,
            row: row(body),
        });
        let inertial = body.children().find(|node| node.has_tag_name("inertial"));
        let own = inertial.map(|inertial| self.inertial(inertial)).transpose()?;
        let (solids, is_all) = self.solids(body, class)?;
        let beside = match (is_all, solids.is_empty()) {
            (false, _) => Beside::Unread,
            (true, true) => Beside::Unsaid,
            (true, false) => Beside::Nothing,
        };
        robot.links.push(Link { name: frame.clone(), body: own.unwrap_or_default(), solids, beside });
        Ok(frame)
    }

    fn inertial(&self, node: Node) -> Result<Body> {
        let mass = self.numbers::<1>(node, None, "mass")?.map_or(0.0, |[mass]| mass);
        let inertia =
            match (self.numbers::<3>(node, None, "diaginertia")?, self.numbers::<6>(node, None, "fullinertia")?) {
                (Some(diagonal), _) => Matrix3::from_diagonal(&Vector3::from(diagonal)),
                (None, Some([xx, yy, zz, xy, xz, yz])) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
                (None, None) => Matrix3::zeros(),
            };
        Ok(Body { mass, centre: Vector3::zeros(), inertia }.seen_from(&self.frame(node, None)?))
    }

    /// Position and turn of a frame, in any of the ways that MJCF knows.
    fn frame(&self, node: Node, class: Option<&str>) -> Result<Isometry3<f64>> {
        let place = self.vector(node, class, "pos")?.unwrap_or_default();
        let angle = |value: f64| if self.in_degrees { value.to_radians() } else { value };
        let unit = |direction: Vector3<f64>| {
            direction.try_normalize(1e-9).ok_or_else(|| at(node, "this direction has no length"))
        };
        let turn = if let Some([w, x, y, z]) = self.numbers::<4>(node, class, "quat")? {
            UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
        } else if let Some([x, y, z, by]) = self.numbers::<4>(node, class, "axisangle")? {
            UnitQuaternion::new(unit(Vector3::new(x, y, z))? * angle(by))
        } else if let Some(angles) = self.numbers::<3>(node, class, "euler")? {
            let mut turn = UnitQuaternion::identity();
            for (letter, by) in self.order.chars().zip(angles) {
                let about = match letter.to_ascii_lowercase() {
                    'x' => Vector3::x(),
                    'y' => Vector3::y(),
                    _ => Vector3::z(),
                };
                let step = UnitQuaternion::new(about * angle(by));
                // Small letters turn about axes that turn along.
                turn = if letter.is_ascii_lowercase() { turn * step } else { step * turn };
            }
            turn
        } else if let Some([ax, ay, az, bx, by, bz]) = self.numbers::<6>(node, class, "xyaxes")? {
            let x = unit(Vector3::new(ax, ay, az))?;
            let y = unit(Vector3::new(bx, by, bz) - x * x.dot(&Vector3::new(bx, by, bz)))?;
            let columns = Matrix3::from_columns(&[x, y, x.cross(&y)]);
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(columns))
        } else if let Some(z) = self.vector(node, class, "zaxis")? {
            z_along(&unit(z)?)
        } else {
            UnitQuaternion::identity()
        };
        Ok(Isometry3::from_parts(Translation3::from(place), turn))
    }

    /// An attribute of an element: its own, else that of its default class or of those that this one lies in.
    fn attribute<'n>(&'n self, node: Node<'n, '_>, class: Option<&str>, name: &str) -> Option<&'n str> {
        if let Some(own) = node.attribute(name) {
            return Some(own);
        }
        let wanted = node.attribute("class").or(class);
        let defaults = || self.document.descendants().filter(|node| node.has_tag_name("default"));
        let of_class = defaults().find(|default| match wanted {
            Some(wanted) => default.attribute("class") == Some(wanted),
            None => default.parent().is_some_and(|parent| parent.has_tag_name("mujoco")),
        })?;
        let tag = node.tag_name();
        of_class
            .ancestors()
            .filter(|above| above.has_tag_name("default"))
            .find_map(|default| default.children().find(|inner| inner.tag_name() == tag)?.attribute(name))
    }

    fn vector(&self, node: Node, class: Option<&str>, name: &str) -> Result<Option<Vector3<f64>>> {
        Ok(self.numbers::<3>(node, class, name)?.map(Vector3::from))
    }

    fn numbers<const N: usize>(&self, node: Node, class: Option<&str>, name: &str) -> Result<Option<[f64; N]>> {
        let Some(text) = self.attribute(node, class, name) else { return Ok(None) };
        let values: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let finite = values.iter().all(|value: &f64| value.is_finite());
        let values: std::result::Result<[f64; N], _> = values.try_into();
        match values {
            Ok(values) if finite => Ok(Some(values)),
            _ => Err(at(node, &format!("{N} finite numbers are needed here")).in_column(name).with_value(text)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::{Kind, Vector3};

    const ARM: &str = r#"<mujoco><compiler angle="degree" eulerseq="XYZ"/>
        <default><joint axis="0 1 0"/><default class="wide"><joint range="-90 90" pos="0 0 0.1"/></default></default>
        <worldbody><body name="upper" pos="0 0 1" childclass="wide">
          <inertial pos="0 0 -0.2" mass="2" diaginertia="0.03 0.04 0.01"/><joint name="shoulder"/>
          <body name="lower" pos="0 0 -0.5" euler="90 0 0"><inertial pos="0 0 0" mass="1" fullinertia="1 2 3 0.1 0.2 0.3"/>
            <joint name="slide" type="slide" axis="2 0 0" pos="0 0 0" range="-1 1"/></body></body></worldbody></mujoco>"#;

    #[test]
    fn bodies_joints_and_default_classes_are_read() {
        let robot = parse(ARM).unwrap();
        let shoulder = &robot.joints[0];
        assert_eq!((shoulder.name.as_str(), shoulder.kind, shoulder.axis), ("shoulder", Kind::Revolute, Vector3::y()));
        // The anchor of the class, in the frame of the body.
        assert!((shoulder.pose.translation.vector - Vector3::new(0.0, 0.0, 1.1)).norm() < 1e-12);
        let [low, high] = shoulder.limits.unwrap();
        assert!((high - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && low == -high);
        let slide = robot.joints.iter().find(|joint| joint.name == "slide").unwrap();
        assert_eq!((slide.kind, slide.axis, slide.limits), (Kind::Prismatic, Vector3::x(), Some([-1.0, 1.0])));
        assert!((slide.pose * Vector3::y() - Vector3::z()).norm() < 1e-12, "turned by 90 degrees about x");
        let body = robot.body("lower, frame");
        assert_eq!((body.mass, body.inertia[(0, 1)], body.inertia[(1, 2)]), (1.0, 0.1, 0.3));
    }

    #[test]
    fn what_is_not_understood_is_told_with_its_row() {
        for (from, to) in [
            (r#"type="slide""#, r#"type="ball""#),
            (r#"<joint name="shoulder"/>"#, "<freejoint/>"),
            (r#"euler="90 0 0""#, r#"euler="90 0""#),
            (r#"<body name="lower""#, r#"<include file="x.xml"/><body name="lower""#),
        ] {
            let error = parse(&ARM.replace(from, to)).unwrap_err();
            assert!(error.code().id == "FRK-D021" && error.row().is_some(), "{to}");
        }
    }
}

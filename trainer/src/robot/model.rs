//! A robot: links with their bodies, and the joints between them.

use nalgebra::{Isometry3, Matrix3, UnitQuaternion, Vector3};
use roxmltree::Node;

use crate::error::{Error, codes};

/// Standard acceleration of gravity, m/s2.
pub(super) const GRAVITY_M_S2: f64 = 9.806_65;

/// What a file describes, in its order.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    /// Acceleration of gravity in the frame of the root, m/s2.
    pub(crate) gravity: Vector3<f64>,
}

/// A turn that brings z along a direction of any length; half a turn about x where that is against z.
pub(crate) fn z_along(direction: &Vector3<f64>) -> UnitQuaternion<f64> {
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), direction);
    turn.unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI))
}

/// A link. Without `<inertial>` it has no mass.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) body: Body,
    /// What may not be run into.
    pub(crate) solids: Vec<Solid>,
    pub(crate) beside: Beside,
}

/// What there is of a link beside its solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beside {
    /// Nothing: the solids are all of it, and without any it is a frame.
    Nothing,
    /// Shapes of the file that are no solids here, such as meshes.
    Unread,
    /// The file shows no shape of this link.
    Unsaid,
}

/// A solid in the frame of its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Solid {
    pub(crate) pose: Isometry3<f64>,
    pub(crate) form: Form,
}

/// Shapes of solids about their middle, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form {
    /// Half of its edges.
    Box {
        half: Vector3<f64>,
    },
    Sphere {
        radius: f64,
    },
    /// Along z.
    Cylinder {
        radius: f64,
        half_length: f64,
    },
    /// Along z, with half spheres beyond its length.
    Capsule {
        radius: f64,
        half_length: f64,
    },
    /// All below the plane through its origin, z its normal.
    HalfSpace,
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

impl Form {
    /// Whether no side of it is zero or less.
    pub(super) fn has_extent(&self) -> bool {
        match *self {
            Self::Box { half } => half.min() > 0.0,
            Self::Sphere { radius } => radius > 0.0,
            Self::Cylinder { radius, half_length } | Self::Capsule { radius, half_length } => {
                radius > 0.0 && half_length > 0.0
            }
            Self::HalfSpace => true,
        }
    }
}

/// What the name of the frame of a body that joints move ends with in MJCF.
pub(super) const OF_FRAME: &str = ", frame";

impl Link {
    /// A frame without body and shape.
    pub(super) fn frame(name: &str) -> Self {
        Self { name: name.to_owned(), body: Body::default(), solids: Vec::new(), beside: Beside::Nothing }
    }

    /// Its name as its file has it.
    pub(crate) fn name_in_file(&self) -> &str {
        self.name.strip_suffix(OF_FRAME).unwrap_or(&self.name)
    }
}

impl Robot {
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

/// What is wrong with an element.
pub(super) fn at(node: Node, message: &str) -> Error {
    Error::new(&codes::BAD_URDF, message).at_row(row(node))
}

/// Row of the file in which an element begins.
pub(super) fn row(node: Node) -> u64 {
    u64::from(node.document().text_pos_at(node.range().start).row)
}

//! The moving joints of a robot on a fixed base, each with all that moves with it as far as the next.

use std::collections::BTreeSet;

use nalgebra::{Isometry3, Matrix3, Vector3};

use crate::error::{Error, Result, codes};
use crate::robot::{self, Body, Joint, Kind, Link, Robot};

/// A tree of joints on a fixed base; every joint stands behind the one that carries it.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The joints, from the base outwards.
    pub joints: Vec<ChainJoint>,
    /// All links of the robot, each behind the one that it hangs on.
    pub links: Vec<ChainLink>,
    /// Acceleration of gravity in the frame of the base, m/s2.
    pub gravity: Vector3<f64>,
}

/// Where a link of the robot is.
#[derive(Clone, Debug)]
pub struct ChainLink {
    /// Its name.
    pub name: String,
    /// The link that it hangs on; `None` for a root.
    pub parent: Option<usize>,
    /// The joint that it moves with; `None` on the base.
    pub carrier: Option<usize>,
    /// Pose of its frame in that of the link of its carrier, or of the base.
    pub pose: Isometry3<f64>,
}

/// A joint with the link that it moves.
#[derive(Clone, Debug)]
pub struct ChainJoint {
    /// Name of the joint.
    pub name: String,
    /// Name of the link that it moves.
    pub link: String,
    /// Whether it slides along its axis instead of turning about it.
    pub is_prismatic: bool,
    /// The joint that carries it; `None` on the base.
    pub parent: Option<usize>,
    /// Pose of its link's frame in that of the link that carries it, where it stands at zero.
    pub pose: Isometry3<f64>,
    /// Axis in the frame of its link, of length one.
    pub axis: Vector3<f64>,
    /// Lowest and highest position, rad or m, where they are known.
    pub limits: Option<[f64; 2]>,
    /// The bodies of the file that move with the link.
    pub nominal: LinkInertia,
}

/// Numbers that describe the body of a link.
pub const INERTIAL: usize = 10;

/// Mass (kg), first moments (kg m) and moments of inertia about the origin of the link's frame (kg m2), in the order of [`NAMES`]: the torques of
/// a chain are linear in these (Atkeson, An & Hollerbach 1986).
pub type LinkInertia = [f64; INERTIAL];

/// Names of the numbers of a [`LinkInertia`], in Pinocchio's order, with their units.
pub const NAMES: [(&str, &str); INERTIAL] = [
    ("m", "kg"),
    ("mx", "kg m"),
    ("my", "kg m"),
    ("mz", "kg m"),
    ("Ixx", "kg m²"),
    ("Ixy", "kg m²"),
    ("Iyy", "kg m²"),
    ("Ixz", "kg m²"),
    ("Iyz", "kg m²"),
    ("Izz", "kg m²"),
];

impl Chain {
    /// The chain of a URDF or MJCF file. Fixed joints, joints that follow another, and those that are `held` stand at
    /// zero, and what they carry belongs to the link before them.
    ///
    /// # Errors
    /// `FRK-D021` when the text describes no robot, has no moving joint, lacks one of those held, or is no tree.
    pub fn parse(text: &str, held: &[String]) -> Result<Self> {
        Self::of(&robot::parse(text)?, held)
    }

    /// As [`parse`](Self::parse), of what a file describes.
    pub(crate) fn of(robot: &Robot, held: &[String]) -> Result<Self> {
        let can_move = |joint: &&Joint| joint.kind != Kind::Fixed && !joint.is_mimic;
        let movable: Vec<&str> = robot.joints.iter().filter(can_move).map(|joint| joint.name.as_str()).collect();
        if movable.is_empty() {
            return Err(Error::new(&codes::BAD_URDF, "no joint of this robot moves"));
        }
        if let Some(unknown) = held.iter().find(|name| !movable.contains(&name.as_str())) {
            let message = format!("no moving joint of the robot has this name; they are {}", movable.join(", "));
            return Err(Error::new(&codes::BAD_URDF, message).with_value(unknown));
        }
        let moves = |joint: &Joint| movable.contains(&joint.name.as_str()) && !held.contains(&joint.name);
        let mut chain = Self { joints: Vec::new(), links: Vec::new(), gravity: robot.gravity };
        let mut seen = BTreeSet::new();
        let is_root = |link: &&Link| robot.joints.iter().all(|joint| joint.child != link.name);
        for root in robot.links.iter().filter(is_root) {
            // Joints that are still to be passed, the next one last, each with the place of its parent link.
            let beyond = |link: &str, place: usize| {
                let next: Vec<&Joint> = robot.joints.iter().filter(|joint| joint.parent == link).collect();
                next.into_iter().rev().map(move |joint| (joint, place))
            };
            let name = root.name.clone();
            chain.links.push(ChainLink { name, parent: None, carrier: None, pose: Isometry3::identity() });
            let mut open: Vec<_> = beyond(&root.name, chain.links.len() - 1).collect();
            while let Some((joint, parent)) = open.pop() {
                let ChainLink { carrier, pose, .. } = chain.links[parent];
                if !seen.insert(joint.child.as_str()) {
                    return Err(joint.error("two joints carry the link of this one"));
                }
                let mut at = (carrier, pose * joint.pose);
                if moves(joint) {
                    chain.joints.push(ChainJoint {
                        name: joint.name.clone(),
                        link: joint.child.clone(),
                        is_prismatic: joint.kind == Kind::Prismatic,
                        parent: carrier,
                        pose: at.1,
                        axis: joint.axis,
                        limits: joint.limits,
                        nominal: [0.0; INERTIAL],
                    });
                    at = (Some(chain.joints.len() - 1), Isometry3::identity());
                }
                if let Some(carrier) = at.0 {
                    let body = numbers_of(&robot.body(&joint.child).seen_from(&at.1));
                    chain.joints[carrier].nominal.iter_mut().zip(body).for_each(|(sum, own)| *sum += own);
                }
                let name = joint.child.clone();
                chain.links.push(ChainLink { name, parent: Some(parent), carrier: at.0, pose: at.1 });
                open.extend(beyond(&joint.child, chain.links.len() - 1));
            }
        }
        if chain.joints.is_empty() {
            return Err(Error::new(&codes::BAD_URDF, "every joint is held, or the links of this robot form a loop"));
        }
        Ok(chain)
    }

    /// Number of joints.
    #[must_use]
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is no joint; [`parse`](Self::parse) gives no such chain.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }
}

impl ChainJoint {
    /// Pose of its link's frame in that of the link that carries it, where it stands at `position`, rad or m.
    #[must_use]
    pub fn pose_at(&self, position: f64) -> Isometry3<f64> {
        let by = self.axis * position;
        self.pose * if self.is_prismatic { Isometry3::translation(by.x, by.y, by.z) } else { Isometry3::rotation(by) }
    }
}

/// A body about the origin of its frame instead of its centre (parallel axes).
fn numbers_of(body: &Body) -> LinkInertia {
    let Body { mass, centre, inertia } = *body;
    let about = inertia + mass * (Matrix3::from_diagonal_element(centre.norm_squared()) - centre * centre.transpose());
    let first = mass * centre;
    let of = |row: usize, column: usize| about[(row, column)];
    [mass, first.x, first.y, first.z, of(0, 0), of(0, 1), of(1, 1), of(0, 2), of(1, 2), of(2, 2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const BRANCHED: &str = r#"<robot name="r"><link name="base"/><link name="a"><inertial><origin xyz="0 0 1"/><mass value="2"/></inertial></link>
        <link name="b"><inertial><mass value="3"/></inertial></link><link name="tool"><inertial><mass value="1"/></inertial></link>
        <link name="finger"><inertial><mass value="0.5"/></inertial></link>
        <joint name="j2" type="prismatic"><origin xyz="0 0 2"/><parent link="a"/><child link="b"/><axis xyz="0 0 2"/><limit lower="-1" upper="1"/></joint>
        <joint name="j1" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/></joint>
        <joint name="flange" type="fixed"><origin xyz="0.5 0 0"/><parent link="b"/><child link="tool"/></joint>
        <joint name="grip" type="prismatic"><origin xyz="0 0.1 0"/><parent link="tool"/><child link="finger"/></joint></robot>"#;

    #[test]
    fn joints_come_from_the_base_outwards_and_carry_what_is_fixed_to_them() {
        let chain = Chain::parse(BRANCHED, &["grip".to_owned()]).unwrap();
        let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!((names, chain.joints[1].parent), (vec!["j1", "j2"], Some(0)));
        assert_eq!((chain.joints[1].limits, chain.joints[0].limits), (Some([-1.0, 1.0]), None));
        let body = chain.joints[1].nominal;
        assert!((body[0] - 4.5).abs() < 1e-12 && (body[1] - 0.75).abs() < 1e-12 && (body[2] - 0.05).abs() < 1e-12);
        assert!((body[9] - (0.25 + 0.5 * (0.25 + 0.01))).abs() < 1e-12, "{body:?}");
        assert_eq!(Chain::parse(BRANCHED, &[]).unwrap().len(), 3);
    }

    #[test]
    fn what_is_no_chain_is_refused() {
        let refused = |text: &str, names: &[String]| Chain::parse(text, names).unwrap_err();
        assert!(refused(BRANCHED, &["j3".to_owned()]).message().contains("j2, j1, grip"));
        let looped = BRANCHED.replace(r#"<child link="tool"/>"#, r#"<child link="a"/>"#);
        assert_eq!(refused(&looped, &[]).code().id, "FRK-D021");
        let still = BRANCHED.replace("prismatic", "fixed").replace("continuous", "fixed");
        assert!(refused(&still, &[]).message().contains("no joint"));
    }
}

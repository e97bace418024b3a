//! The solids of an arm: those of its file, and capsules in place of links whose shape is not known.

use nalgebra::{Isometry3, Point3, Translation3, Vector3};

use super::solid::{Owner, Placed};
use crate::arm::chain::Chain;
use crate::joint::Surroundings;
use crate::robot::{Beside, Body, Form, Link, Robot, Solid, z_along};

/// Name of a root that is a frame without body, by convention of MJCF and of ROS (REP 105).
const WORLD: &str = "world";
/// Length from which a link without mass and shape is more than a frame, m.
const FRAME_M: f64 = 1e-6;

/// What was looked at of an arm, by the names of its links.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Looked {
    /// Links that a capsule of `link_radius_m` stands in for.
    pub stood_in: Vec<String>,
    /// Links of unknown shape that nothing stands in for.
    pub unseen: Vec<String>,
    /// Links whose solids are too close to each other in every posture, so that a motion cannot keep them apart.
    pub never_apart: Vec<[String; 2]>,
}

/// Links and their solids.
pub(super) struct Links {
    pub(super) solids: Vec<Placed>,
    pub(super) looked: Looked,
    /// Names in the file, in the order of the links of the chain.
    pub(super) names: Vec<String>,
    /// Whether there is more of a link than a frame.
    is_body: Vec<bool>,
    parents: Vec<Option<usize>>,
}

impl Links {
    pub(super) fn of(robot: &Robot, chain: &Chain, around: &Surroundings) -> Self {
        let parents = chain.links.iter().map(|link| link.parent).collect();
        let mut links =
            Self { solids: Vec::new(), looked: Looked::default(), names: Vec::new(), is_body: Vec::new(), parents };
        for (index, placed) in chain.links.iter().enumerate() {
            let known = robot.links.iter().find(|link| link.name == placed.name);
            let name = known.map_or(placed.name.as_str(), Link::name_in_file).to_owned();
            let beside = known.map_or(Beside::Unsaid, |link| link.beside);
            let body = known.map_or_else(Body::default, |link| link.body);
            let own = known.map_or(&[][..], |link| link.solids.as_slice());
            let ends = ends(chain, index, &body);
            let is_frame = body.mass == 0.0 && (ends.is_empty() || placed.name == WORLD);
            let is_open = match beside {
                Beside::Nothing => false,
                Beside::Unread => true,
                Beside::Unsaid => !is_frame,
            };
            let add =
                |solid: &Solid, frame: &Isometry3<f64>| Placed::new(Owner::Link(index), placed.carrier, frame, solid);
            links.solids.extend(own.iter().map(|solid| add(solid, &placed.pose)));
            links.is_body.push(is_open || !own.is_empty());
            if is_open {
                let joint = placed.carrier.map(|joint| chain.joints[joint].name.as_str());
                // What stands around in a world has no joint to reach to.
                let radius = around.link_radius(joint).filter(|_| placed.name != WORLD);
                if let Some(radius) = radius {
                    let start = placed.pose.translation.vector;
                    let capsules = stand_ins(start, &ends, radius);
                    links.solids.extend(capsules.iter().map(|solid| add(solid, &Isometry3::identity())));
                    links.looked.stood_in.push(name.clone());
                } else {
                    links.looked.unseen.push(name.clone());
                }
            }
            links.names.push(name);
        }
        links
    }

    /// Whether one of two links hangs on the other, with nothing but frames between them; none hangs on the world.
    pub(super) fn are_neighbours(&self, one: usize, other: usize) -> bool {
        let hangs_on = |mut link: usize, wanted: usize| {
            while let Some(parent) = self.parents[link] {
                if self.is_body[parent] {
                    return parent == wanted && self.names[parent] != WORLD;
                }
                link = parent;
            }
            false
        };
        hangs_on(one, other) || hangs_on(other, one)
    }
}

/// Where a link reaches to from its origin, in the frame of its carrier: the joints of the links that hang on it, else its centre of mass.
fn ends(chain: &Chain, index: usize, body: &Body) -> Vec<Vector3<f64>> {
    let link = &chain.links[index];
    let start = link.pose.translation.vector;
    let next = chain.links.iter().filter(|next| next.parent == Some(index));
    let mut ends: Vec<Vector3<f64>> = next
        .map(|next| match next.carrier {
            Some(joint) if next.carrier != link.carrier => chain.joints[joint].pose.translation.vector,
            _ => next.pose.translation.vector,
        })
        .collect();
    if ends.is_empty() && body.mass > 0.0 {
        ends.push((link.pose * Point3::from(body.centre)).coords);
    }
    ends.retain(|end| (end - start).norm() > FRAME_M);
    ends
}

/// A capsule to each end, or a ball where there is none.
fn stand_ins(start: Vector3<f64>, ends: &[Vector3<f64>], radius: f64) -> Vec<Solid> {
    if ends.is_empty() {
        let pose = Isometry3::from(Translation3::from(start));
        return vec![Solid { pose, form: Form::Sphere { radius } }];
    }
    let capsule = |end: &Vector3<f64>| {
        let way = end - start;
        let pose = Isometry3::from_parts(Translation3::from(start + 0.5 * way), z_along(&way));
        Solid { pose, form: Form::Capsule { radius, half_length: 0.5 * way.norm() } }
    };
    ends.iter().map(capsule).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::parse;

    /// A floor and a stand as a mesh, an arm of two bodies that hangs above them.
    const HUNG: &str = r#"<mujoco><compiler angle="radian"/><worldbody><geom type="plane" size="0 0 1"/><geom type="mesh" mesh="stand"/>
        <body name="upper" pos="0 0 2"><joint name="a" range="-1 1"/><geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.5"/>
          <body name="lower" pos="0 0 -0.5"><joint name="b" axis="0 1 0" range="-1 1"/><inertial pos="0 0 -0.3" mass="1" diaginertia="1 1 1"/>
          </body></body></worldbody></mujoco>"#;

    #[test]
    fn bodies_stand_beside_the_world_and_hang_on_each_other() {
        let robot = parse(HUNG).unwrap();
        let chain = Chain::of(&robot, &[]).unwrap();
        let around = Surroundings { link_radius_m: Some(0.04), ..Surroundings::default() };
        let links = Links::of(&robot, &chain, &around);
        assert_eq!((links.looked.stood_in.join(" "), links.looked.unseen.join(" ")), ("lower".into(), "world".into()));
        let owners: Vec<usize> = links
            .solids
            .iter()
            .map(|solid| match solid.owner {
                Owner::Link(link) => link,
                Owner::Obstacle(_) => panic!("no obstacle is given"),
            })
            .collect();
        let [floor, upper, lower] = owners[..] else { panic!("{owners:?}") };
        assert_eq!([floor, upper, lower].map(|link| links.names[link].as_str()), ["world", "upper", "lower"]);
        assert!(links.are_neighbours(upper, lower) && links.are_neighbours(lower, upper));
        assert!(!links.are_neighbours(floor, upper) && !links.are_neighbours(floor, lower));
        // Down to its centre of mass.
        let [floor, _, lower] = &links.solids[..] else { panic!() };
        assert!(
            (lower.distance(floor, &[Isometry3::identity(), Isometry3::translation(0.0, 0.0, 1.0)]) - 0.66).abs()
                < 1e-9
        );
    }
}

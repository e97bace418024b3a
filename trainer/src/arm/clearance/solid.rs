//! A solid and where it is.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Ball, Capsule, Cuboid, Cylinder, HalfSpace, Shape};

use crate::robot::{Form, Solid};

/// Whose solid it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// The link at this place of the chain.
    Link(usize),
    /// Something of the surroundings, by its name.
    Obstacle(String),
}

/// A solid that moves with a joint, or stands on the base.
pub(super) struct Placed {
    pub(super) owner: Owner,
    /// The joint that it moves with; `None` on the base.
    pub(super) carrier: Option<usize>,
    /// A ball around it: its middle in the frame of the link of its carrier, or of the base, and its radius, m.
    pub(super) ball: (Vector3<f64>, f64),
    /// Pose in the frame of the link of its carrier, or of the base.
    pose: Isometry3<f64>,
    shape: Box<dyn Shape>,
}

impl Placed {
    /// A solid in a frame that has this pose where it is carried.
    pub(super) fn new(owner: Owner, carrier: Option<usize>, frame: &Isometry3<f64>, solid: &Solid) -> Self {
        let mut pose = frame * solid.pose;
        let (shape, radius): (Box<dyn Shape>, f64) = match solid.form {
            Form::Box { half } => (Box::new(Cuboid::new(vector(&half))), half.norm()),
            Form::Sphere { radius } => (Box::new(Ball::new(radius)), radius),
            Form::Cylinder { radius, half_length } => {
                // Along y in the library.
                pose *= UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
                (Box::new(Cylinder::new(half_length, radius)), half_length.hypot(radius))
            }
            Form::Capsule { radius, half_length } => {
                let end = Vector::new(0.0, 0.0, half_length);
                (Box::new(Capsule::new(-end, end, radius)), half_length + radius)
            }
            Form::HalfSpace => (Box::new(HalfSpace::new(Vector::new(0.0, 0.0, 1.0))), f64::INFINITY),
        };
        Self { owner, carrier, ball: (pose.translation.vector, radius), pose, shape }
    }

    /// Distance of two solids, m, zero where they touch or overlap; `poses` are those of the links of all joints in the frame of the base.
    pub(super) fn distance(&self, other: &Self, poses: &[Isometry3<f64>]) -> f64 {
        let [ours, theirs] = [self, other].map(|solid| {
            let pose = solid.carrier.map_or(solid.pose, |joint| poses[joint] * solid.pose);
            let [i, j, k, w] = pose.rotation.coords.into();
            Pose::from_parts(vector(&pose.translation.vector), Rotation::from_xyzw(i, j, k, w))
        });
        // All pairs of these shapes but two half spaces are supported, and half spaces do not move.
        query::distance(&ours, &*self.shape, &theirs, &*other.shape).map_or(0.0, |found| found.distance)
    }
}

fn vector(of: &Vector3<f64>) -> Vector {
    Vector::new(of.x, of.y, of.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_shapes_wherever_they_are() {
        let up = |z: f64| Isometry3::translation(0.0, 0.0, z);
        let place = |form: Form, pose: Isometry3<f64>| {
            Placed::new(Owner::Link(0), Some(0), &pose, &Solid { pose: Isometry3::identity(), form })
        };
        let floor = Placed::new(
            Owner::Obstacle("floor".to_owned()),
            None,
            &up(-1.0),
            &Solid { pose: Isometry3::identity(), form: Form::HalfSpace },
        );
        let table = Placed::new(
            Owner::Obstacle("table".to_owned()),
            None,
            &up(-2.0),
            &Solid { pose: Isometry3::identity(), form: Form::Box { half: Vector3::new(1.0, 1.0, 0.5) } },
        );
        let half = Vector3::new(0.1, 0.2, 0.3);
        for (form, below) in [
            (Form::Box { half }, 0.3),
            (Form::Sphere { radius: 0.25 }, 0.25),
            (Form::Cylinder { radius: 0.1, half_length: 0.4 }, 0.4),
            (Form::Capsule { radius: 0.1, half_length: 0.4 }, 0.5),
        ] {
            let solid = place(form, up(0.5));
            for (obstacle, top) in [(&floor, -1.0), (&table, -1.5)] {
                let found = solid.distance(obstacle, &[up(0.7)]);
                assert!((found - (1.2 - below - top)).abs() < 1e-9, "{form:?}: {found}");
            }
            assert_eq!(solid.distance(&floor, &[up(-1.6)]), 0.0);
            let (middle, radius) = solid.ball;
            assert!((middle - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-12 && radius >= below);
        }
    }
}

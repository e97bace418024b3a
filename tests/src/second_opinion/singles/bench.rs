//! The torques of a recording while an effect is put into it.

use super::RigidBody;
use crate::second_opinion::joint::Joint;
use crate::second_opinion::motion::{Grid, Motion, Trajectory};
use crate::second_opinion::numeric::rms;
use crate::second_opinion::random::{Random, factor};

/// A joint on its motion, and the torques at every instant, N m or N.
#[derive(Debug)]
pub struct Bench<'a> {
    /// The joint.
    pub joint: Joint,
    /// The instants.
    pub grid: Grid,
    /// The motion, for a finer grid.
    pub motion: Motion,
    /// The motion at the instants.
    pub path: Trajectory,
    /// How the rigid body is known.
    pub known_by: RigidBody,
    /// Friction.
    pub friction: Vec<f64>,
    /// Whatever is added to friction and rigid body.
    pub extra: Vec<f64>,
    /// Torque of the rigid body, loads included.
    pub rigid_body: Vec<f64>,
    /// The same as the recording or the joint file states it.
    pub stated_rigid_body: Vec<f64>,
    /// Further columns.
    pub columns: Vec<(&'static str, Vec<f64>)>,
    /// What was hidden, in words.
    pub note: String,
    /// Random details.
    pub random: &'a mut Random,
    plain_friction: Vec<f64>,
}

impl<'a> Bench<'a> {
    /// A joint with nothing hidden in it.
    pub fn new(joint: Joint, grid: Grid, motion: Motion, known_by: RigidBody, random: &'a mut Random) -> Self {
        let path = motion.at(&grid);
        let friction = path.map(|_, _, v, _| joint.friction(v));
        let rigid_body = path.map(|_, q, _, a| joint.rigid_body(q, a));
        Self {
            joint,
            grid,
            motion,
            known_by,
            extra: vec![0.0; path.len()],
            path,
            plain_friction: friction.clone(),
            friction,
            stated_rigid_body: rigid_body.clone(),
            rigid_body,
            columns: Vec::new(),
            note: String::from("nothing hidden"),
            random,
        }
    }

    /// A share of Coulomb friction, drawn about `share`, N m or N.
    pub fn torque(&mut self, share: f64) -> f64 {
        share * self.joint.coulomb * factor(self.random)
    }

    /// A value drawn about `value`.
    pub fn about(&mut self, value: f64) -> f64 {
        value * factor(self.random)
    }

    /// Adds a torque of time, position, velocity and acceleration.
    pub fn add(&mut self, torque: impl Fn(f64, f64, f64, f64) -> f64) {
        self.extra = self.path.map(torque);
    }

    /// Signs of the velocity, smooth about zero.
    #[must_use]
    pub fn signs(&self) -> Vec<f64> {
        self.path.velocity.iter().map(|v| self.joint.sign(*v)).collect()
    }

    /// Root mean square of what is hidden, as a share of Coulomb friction.
    #[must_use]
    pub fn hidden_share(&self) -> f64 {
        let hidden = |i: usize| {
            self.extra[i] + self.friction[i] - self.plain_friction[i] + self.rigid_body[i] - self.stated_rigid_body[i]
        };
        rms(&(0..self.extra.len()).map(hidden).collect::<Vec<_>>()) / self.joint.coulomb
    }
}

//! What an improved model is written from.

use crate::compile::host_model::HostModel;
use crate::diagnose::comparison::simulation::InverseLaw;
use frikan_shared::model::RigidBody;

/// Where the base law comes from.
#[derive(Clone, Copy, Debug)]
pub enum Origin<'a> {
    /// The static model of the recording itself, with the rigid body that the joint file gives.
    Recording(RigidBody),
    /// The learned law of a simulation, with the rigid body that the joint file gives.
    Simulation(&'a InverseLaw, RigidBody),
    /// A fitted model.
    Model(&'a HostModel),
}

/// Friction over velocity.
pub(super) type Friction<'a> = Box<dyn Fn(f64) -> f64 + Sync + 'a>;

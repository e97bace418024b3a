"""The joint in Drake.

Drake's joints have damping but no Coulomb friction: as its users do, a system beside the plant applies that as a generalized force, a tanh of
the velocity. The simulation is integrated continuously with steps of variable length; the recorded joint is a discrete plant of short steps,
which is what has limits of joints and rigid contact.
"""

import math

import numpy as np
from pydrake.geometry import AddContactMaterial, ProximityProperties, Sphere
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
from pydrake.multibody.tree import RevoluteJoint, RevoluteSpring, RotationalInertia, SpatialInertia
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from .drive import REAL_SUBSTEPS
from .joint import GRAVITY_M_S2
from .motion import CONTROL_PERIOD_S

TITLE = "Drake"
HAS_SOFT_CONSTRAINT = False
GEAR_RATIO = 50.0
# Of the integrator of variable step.
ACCURACY = 1e-5
AXIS = (0.0, 1.0, 0.0)


class Mechanism:
    """A joint under way."""

    def __init__(self, joint, plant, real):
        """The recorded joint with `real`, else the simulation."""
        self.substeps = REAL_SUBSTEPS if real else 1
        self.period_s = CONTROL_PERIOD_S / self.substeps
        self.simulated, self.steps, self.acceleration = joint, 0, 0.0
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(time_step=self.period_s if real else 0.0, discrete_contact_approximation="sap", contact_model="point")
        bodies, _ = AddMultibodyPlant(config, builder)
        self.driven = assemble(bodies, joint, plant)
        resistance = builder.AddSystem(Resistance(self, plant, bodies.num_positions()))
        builder.Connect(bodies.get_state_output_port(), resistance.get_input_port())
        builder.Connect(resistance.get_output_port(), bodies.get_applied_generalized_force_input_port())
        self.simulator = Simulator(builder.Build())
        config = SimulatorConfig(integration_scheme="runge_kutta3", max_step_size=CONTROL_PERIOD_S, accuracy=ACCURACY, publish_every_time_step=False)
        ApplySimulatorConfig(config, self.simulator)
        self.context = bodies.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        self.motor = bodies.get_actuation_input_port().FixValue(self.context, [0.0])

    def place(self, position, velocity):
        self.driven.set_angle(self.context, position)
        self.driven.set_angular_rate(self.context, velocity)
        self.simulator.Initialize()

    def state(self):
        return self.driven.get_angle(self.context), self.driven.get_angular_rate(self.context)

    def advance(self, motor, now):
        """A substep on; the torque that the simulation's joint would have needed for it, and what of it is friction."""
        q, v = self.state()
        self.motor.GetMutableData().get_mutable_value().SetAtIndex(0, motor)
        # A multiple of the period as Drake counts them: beyond it by a rounding error it would take two steps at once.
        self.steps += 1
        self.simulator.AdvanceTo(self.steps * self.period_s)
        self.acceleration = (self.driven.get_angular_rate(self.context) - v) / self.period_s
        joint = self.simulated
        friction = joint.frictionloss_Nm * math.tanh(v / joint.sign_width_rad_s) + joint.damping_Nms_rad * v
        return joint.inertia_kgm2 * self.acceleration + joint.gravity_Nm(q) + friction, friction


class Resistance(LeafSystem):
    """Generalized forces of what Drake's joints do not have: Coulomb friction, bristles, cubic damping, ripple and an applied torque."""

    def __init__(self, mechanism, plant, positions):
        super().__init__()
        self.mechanism, self.plant, self.real = mechanism, plant, plant.joint(mechanism.simulated)
        self.at, self.forces = mechanism.driven.position_start(), np.zeros(positions)
        self.rate_at = positions + mechanism.driven.velocity_start()
        self.DeclareVectorInputPort("state", 2 * positions)
        self.DeclareVectorOutputPort("force", positions, self.output)
        if plant.bristles:
            self.DeclareDiscreteState(1)
            self.DeclarePeriodicDiscreteUpdateEvent(mechanism.period_s, 0.0, self.deflect)

    def output(self, context, force):
        state = self.get_input_port().Eval(context)
        q, v, now = state[self.at], state[self.rate_at], context.get_time()
        coulomb = self.plant.coulomb_Nm(self.real, q, v, now, self.mechanism.acceleration)
        torque = self.plant.applied_Nm(q, v, now) - coulomb * math.tanh(v / self.real.sign_width_rad_s) - self.plant.cubic_damping_Nms3_rad3 * v**3
        if self.plant.ripple:
            ripple = self.plant.ripple
            torque += ripple.torque_Nm * math.sin(ripple.order * q + ripple.phase_rad)
        if self.plant.bristles:
            bristles, deflection = self.plant.bristles, context.get_discrete_state_vector()[0]
            torque -= bristles.stiffness_Nm_rad * deflection + bristles.damping_Nms_rad * self.rate(v, deflection)
        self.forces[self.at] = torque
        force.SetFromVector(self.forces)

    def rate(self, velocity, deflection):
        """Rate of deflection of the bristles (Canudas de Wit 1995)."""
        return velocity - self.plant.bristles.stiffness_Nm_rad * abs(velocity) / self.plant.bristles.coulomb_Nm * deflection

    def deflect(self, context, state):
        deflection = context.get_discrete_state_vector()[0]
        velocity = self.get_input_port().Eval(context)[self.rate_at]
        state.set_value([deflection + self.mechanism.period_s * self.rate(velocity, deflection)])


def assemble(bodies, joint, plant):
    """Adds the joint as `plant` alters it to an empty plant; the driven joint."""
    real = plant.joint(joint)
    bodies.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY_M_S2])
    own = real.link_inertia_kgm2 - real.mass_kg * real.lever_m**2
    link = bodies.AddRigidBody("link", inertia(real.mass_kg, at(real.lever_m, real.phase_rad), own))
    arm = link
    if plant.play:
        arm = bodies.AddRigidBody("hull", inertia(1e-6, np.zeros(3), plant.play.hull_kgm2(joint)))
        couple(bodies, arm, link, plant.play)
    driven = bodies.AddJoint(RevoluteJoint("joint", bodies.world_frame(), arm.body_frame(), AXIS, real.damping_Nms_rad))
    drive = bodies.AddJointActuator("drive", driven)
    drive.set_default_gear_ratio(GEAR_RATIO)
    drive.set_default_rotor_inertia(real.armature_kgm2 / GEAR_RATIO**2)
    if plant.spring:
        bodies.AddForceElement(RevoluteSpring(driven, plant.spring.rest_rad, plant.spring.stiffness_Nm_rad))
    if plant.payload:
        of = plant.payload
        mass = bodies.AddRigidBody("payload", inertia(of.mass_kg, np.zeros(3), of.own_inertia_kgm2))
        bodies.WeldFrames(link.body_frame(), mass.body_frame(), RigidTransform(at(of.lever_m, of.phase_rad)))
    if plant.stop:
        block(bodies, arm, joint, plant.stop)
    bodies.Finalize()
    return driven


def at(lever, angle):
    """Place on the link at zero position: an angle of zero hangs."""
    return RotationMatrix.MakeYRotation(angle) @ np.array([0.0, 0.0, -lever])


def inertia(mass, centre, own):
    """Spatial inertia about the origin of a body whose own one is the same about all axes."""
    return SpatialInertia.MakeFromCentralInertia(mass, centre, RotationalInertia(own, own, own))


def couple(bodies, arm, link, play):
    """The joint between drive and link."""
    joint = bodies.AddJoint(RevoluteJoint("play", arm.body_frame(), link.body_frame(), AXIS, play.damping_Nms_rad))
    if play.half_gap_rad is None:
        bodies.AddForceElement(RevoluteSpring(joint, 0.0, play.stiffness_Nm_rad))
    else:
        joint.set_position_limits([-play.half_gap_rad], [play.half_gap_rad])


def block(bodies, arm, joint, stop):
    """A ball on the arm that meets a ball of the world, without friction, where the stop is."""
    lever, radius = joint.lever_m, 0.1 * joint.lever_m
    apart = 2 * math.asin(radius / lever)
    there = stop.position_rad + (apart if stop.upper else -apart)
    # Compliance and dissipation of both balls add up.
    stiffness = 2 * joint.inertia_kgm2 / (stop.time_constant_s * lever) ** 2
    properties = ProximityProperties()
    AddContactMaterial(properties=properties, point_stiffness=stiffness, friction=CoulombFriction(0.0, 0.0))
    properties.AddProperty("material", "relaxation_time", stop.time_constant_s)
    for name, body, angle in (("arm", arm, 0.0), ("stop", bodies.world_body(), there)):
        bodies.RegisterCollisionGeometry(body, RigidTransform(at(lever, angle)), Sphere(radius), name, properties)

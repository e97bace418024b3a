//! From command, motion and constants to the torque on the joint, and what of it each identified constant makes.

use super::kind::Kind;
use crate::numerics::Number;

/// What an actuator is told at an instant; what its kind does not read may hold anything.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command<T = f64> {
    /// What it has to put out: torque in N m, current in A, duty (-1 to 1), or voltage in V.
    pub effort: T,
    /// Whether the effort of a motor is a voltage and not a duty.
    pub is_voltage: bool,
    /// Where the joint shall be, rad.
    pub reference: T,
    /// How fast it shall move, rad/s.
    pub reference_velocity: T,
    /// Torque that the controller adds, N m.
    pub feed_forward: T,
    /// Supply voltage, V.
    pub supply: T,
    /// Gain of the controller, kp in N m/rad or that of the firmware, where it is not the actuator's own.
    pub kp: Option<T>,
    /// Whether the actuator is switched on.
    pub enabled: bool,
}

/// Position, rad, and velocity, rad/s, of the joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<T = f64> {
    /// rad
    pub position: T,
    /// rad/s
    pub velocity: T,
}

/// What an actuator never exceeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<T = f64> {
    /// Largest duty, above 0 to 1.
    pub duty: T,
    /// Largest torque, N m.
    pub torque: T,
}

/// An actuator with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator<T = f64> {
    /// What it does.
    pub kind: Kind,
    /// Torque per effort, N m per A of a current, per V of a motor (torque constant over resistance); 1 of the others.
    pub gain: T,
    /// Torque that a motor loses per velocity, N m s/rad: torque constant squared over resistance. Zero of the others, and where
    /// it is counted as viscous friction.
    pub back_emf: T,
    /// Gain of the position error where no column has it: N m/rad, or as the firmware counts it.
    pub kp: T,
    /// Torque per velocity error, N m s/rad.
    pub kd: T,
    /// Duty per rad of position error and unit of the firmware's gain.
    pub error_gain: T,
    /// Position error up to which nothing happens, rad.
    pub dead_band: T,
    /// Share of the supply voltage that is lost per unit of duty squared: resistance of the supply over that of the winding.
    pub sag: T,
    /// Supply voltage where no column has it, V.
    pub supply: T,
    /// Time from the command to its effect, s.
    pub delay_s: T,
    /// Time from the motion to what a controller makes of it, s: that of its loop and of the filter of its velocity.
    pub feedback_delay_s: T,
    /// Speed at which the reference moves at most, rad/s.
    pub velocity_limit: T,
    /// What it never exceeds.
    pub limits: Limits<T>,
}

/// The torque that acts on the joint: `torque - damping * velocity - inertia * acceleration`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Applied<T = f64> {
    /// At the velocity zero, N m.
    pub torque: T,
    /// Torque lost per velocity, N m s/rad.
    pub damping: T,
    /// Torque lost per acceleration, kg m2: negative of a controller that sees the motion late.
    pub inertia: T,
    /// What of the torque one unit of [`Actuator::gain`] makes, N m per its unit: the derivative by it.
    pub by_gain: T,
    /// The derivative by [`Actuator::back_emf`], rad/s; zero where the actuator is off.
    pub by_back_emf: T,
    /// The derivative by the gain of the position error of a PD controller, rad.
    pub by_kp: T,
    /// The derivative by [`Actuator::kd`], rad/s.
    pub by_kd: T,
    /// Whether duty or torque stand at their limit.
    pub limited: bool,
}

impl Actuator {
    /// An actuator of a kind with unit gain, without losses, limits or dead band.
    #[must_use]
    pub fn ideal(kind: Kind) -> Self {
        let limits = Limits { duty: 1.0, torque: f64::INFINITY };
        Self {
            kind,
            gain: 1.0,
            back_emf: 0.0,
            kp: 0.0,
            kd: 0.0,
            error_gain: 0.0,
            dead_band: 0.0,
            sag: 0.0,
            supply: 0.0,
            delay_s: 0.0,
            feedback_delay_s: 0.0,
            velocity_limit: f64::INFINITY,
            limits,
        }
    }

    /// The same in other numbers.
    pub(crate) fn lifted<T: Number>(&self) -> Actuator<T> {
        Actuator {
            kind: self.kind,
            gain: self.gain.into(),
            back_emf: self.back_emf.into(),
            kp: self.kp.into(),
            kd: self.kd.into(),
            error_gain: self.error_gain.into(),
            dead_band: self.dead_band.into(),
            sag: self.sag.into(),
            supply: self.supply.into(),
            delay_s: self.delay_s.into(),
            feedback_delay_s: self.feedback_delay_s.into(),
            velocity_limit: self.velocity_limit.into(),
            limits: Limits { duty: self.limits.duty.into(), torque: self.limits.torque.into() },
        }
    }
}

impl<T: Number> Actuator<T> {
    /// The torque on the joint. Nothing acts while the actuator is off.
    #[must_use]
    pub fn apply(&self, command: &Command<T>, motion: Motion<T>) -> Applied<T> {
        if !command.enabled {
            return Applied::default();
        }
        if let Some(duty) = self.duty(command, motion) {
            return self.under_duty(duty, command, motion);
        }
        match self.kind {
            Kind::Torque => Applied { torque: command.effort, ..Applied::default() },
            Kind::Current => {
                let (torque, by_gain) = (self.gain * command.effort, command.effort);
                self.limited(Applied { torque, by_gain, ..Applied::default() }, motion)
            }
            Kind::DcMotor | Kind::PositionServo => self.motor(command.effort, false, motion),
            Kind::Pd => self.controller(command, motion),
        }
    }

    /// The duty that the firmware asks for, before its limit; `None` of what has none.
    #[must_use]
    pub fn duty(&self, command: &Command<T>, motion: Motion<T>) -> Option<T> {
        match self.kind {
            Kind::DcMotor if !command.is_voltage => Some(command.effort),
            Kind::PositionServo => Some(self.kp_of(command) * self.error_gain * self.error(command, motion)),
            Kind::DcMotor | Kind::Torque | Kind::Current | Kind::Pd => None,
        }
    }

    /// Gain of the position error under a command.
    #[must_use]
    pub fn kp_of(&self, command: &Command<T>) -> T {
        command.kp.unwrap_or(self.kp)
    }

    /// The position error that a controller sees, rad: of where the joint was as long ago as it takes to see it.
    pub(super) fn seen_error(&self, command: &Command<T>, motion: Motion<T>) -> T {
        command.reference - (motion.position - self.feedback_delay_s * motion.velocity)
    }

    /// The position error that is acted upon: none within the dead band, the rest beyond it.
    pub(super) fn error(&self, command: &Command<T>, motion: Motion<T>) -> T {
        let error = self.seen_error(command, motion);
        if error.abs() <= self.dead_band { T::zero() } else { error - with_sign_of(self.dead_band, error) }
    }

    fn controller(&self, command: &Command<T>, motion: Motion<T>) -> Applied<T> {
        let error = self.error(command, motion);
        let torque = self.kp_of(command) * error + self.kd * command.reference_velocity + command.feed_forward;
        let by_kd = command.reference_velocity - motion.velocity;
        let inertia = -self.kd * self.feedback_delay_s;
        self.limited(Applied { torque, damping: self.kd, inertia, by_kp: error, by_kd, ..Applied::default() }, motion)
    }

    /// A duty cycle of the supply, whose voltage sags with the current: at stall that is duty times voltage over the resistance, and the
    /// duty takes its share of it from the supply.
    fn under_duty(&self, duty: T, command: &Command<T>, motion: Motion<T>) -> Applied<T> {
        let is_limited = duty.abs() > self.limits.duty;
        let held = if is_limited { with_sign_of(self.limits.duty, duty) } else { duty };
        let supply = command.supply / (self.sag * held * held + 1.0);
        self.motor(held * supply, is_limited, motion)
    }

    fn motor(&self, voltage: T, limited: bool, motion: Motion<T>) -> Applied<T> {
        let applied = Applied {
            torque: self.gain * voltage,
            damping: self.back_emf,
            by_gain: voltage,
            by_back_emf: -motion.velocity,
            limited,
            ..Applied::default()
        };
        self.limited(applied, motion)
    }

    /// No more than the limit of the torque, which of a motor is that of its current.
    fn limited(&self, applied: Applied<T>, motion: Motion<T>) -> Applied<T> {
        let whole = applied.at(motion.velocity);
        if whole.abs() <= self.limits.torque {
            return applied;
        }
        Applied { torque: with_sign_of(self.limits.torque, whole), limited: true, ..Applied::default() }
    }
}

/// A size, zero or above, with the sign of another number.
fn with_sign_of<T: Number>(size: T, other: T) -> T {
    if other.re().is_sign_negative() { -size } else { size }
}

/// Nothing at all.
impl<T: Number> Default for Applied<T> {
    fn default() -> Self {
        let zero = T::zero();
        let (torque, damping, inertia) = (zero, zero, zero);
        Self { torque, damping, inertia, by_gain: zero, by_back_emf: zero, by_kp: zero, by_kd: zero, limited: false }
    }
}

impl<T: Number> Applied<T> {
    /// The torque at a velocity, rad/s, and without acceleration: N m.
    #[must_use]
    pub fn at(&self, velocity: T) -> T {
        self.torque - self.damping * velocity
    }

    /// Whether a gain changes it: neither at the limit of its torque nor within a dead band. At the limit of a duty the motor still has one.
    #[must_use]
    pub fn follows_command(&self) -> bool {
        self.by_gain != T::zero() || self.by_kp != T::zero() || self.by_kd != T::zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ON: Command = Command {
        effort: 0.0,
        is_voltage: false,
        reference: 0.3,
        reference_velocity: 0.5,
        feed_forward: 0.1,
        supply: 8.0,
        kp: Some(20.0),
        enabled: true,
    };
    const MOTION: Motion = Motion { position: 0.1, velocity: 0.4 };

    fn servo() -> Actuator {
        Actuator { gain: 0.1, back_emf: 0.03, error_gain: 0.1, ..Actuator::ideal(Kind::PositionServo) }
    }

    #[test]
    fn a_controller_is_its_formula_until_its_limit() {
        let pd = Actuator { kd: 0.7, ..Actuator::ideal(Kind::Pd) };
        let free = pd.apply(&ON, MOTION);
        assert!((free.at(0.4) - (20.0 * 0.2 + 0.7 * 0.1 + 0.1)).abs() < 1e-12 && !free.limited);
        let held = Actuator { limits: Limits { torque: 2.0, ..pd.limits }, ..pd }.apply(&ON, MOTION);
        assert_eq!((held.torque, held.damping, held.limited), (2.0, 0.0, true));
    }

    #[test]
    fn a_servo_is_a_motor_under_the_duty_of_its_firmware() {
        let applied = servo().apply(&ON, MOTION);
        let duty = 20.0 * 0.1 * 0.2;
        assert!((applied.at(0.4) - (0.1 * 8.0 * duty - 0.03 * 0.4)).abs() < 1e-12);
        let stuck = servo().apply(&Command { kp: Some(1000.0), ..ON }, MOTION);
        assert!((stuck.torque - 0.8).abs() < 1e-12 && stuck.limited && stuck.damping == 0.03);
        let short = Limits { torque: 0.5, ..servo().limits };
        let held = Actuator { limits: short, ..servo() }.apply(&Command { kp: Some(1000.0), ..ON }, MOTION);
        assert_eq!((held.torque, held.damping, held.limited), (0.5, 0.0, true));
        let band = Actuator { dead_band: 0.2, ..servo() }.apply(&ON, MOTION);
        assert_eq!(band.torque, 0.0);
        assert_eq!(servo().apply(&Command { enabled: false, ..ON }, MOTION), Applied::default());
    }

    #[test]
    fn derivatives_are_those_of_the_torque() {
        let step = 1e-6;
        let torque = |actuator: Actuator, command: &Command| actuator.apply(command, MOTION).at(MOTION.velocity);
        let slope = |up: f64, down: f64| (up - down) / (2.0 * step);
        let applied = servo().apply(&ON, MOTION);
        let gain = |gain: f64| torque(Actuator { gain, ..servo() }, &ON);
        assert!((slope(gain(0.1 + step), gain(0.1 - step)) - applied.by_gain).abs() < 1e-7);
        let loss = |back_emf: f64| torque(Actuator { back_emf, ..servo() }, &ON);
        assert!((slope(loss(0.03 + step), loss(0.03 - step)) - applied.by_back_emf).abs() < 1e-7);
        let pd = Actuator { kd: 0.7, dead_band: 0.05, ..Actuator::ideal(Kind::Pd) };
        let applied = pd.apply(&ON, MOTION);
        let kp = |kp: f64| torque(pd, &Command { kp: Some(kp), ..ON });
        assert!((slope(kp(20.0 + step), kp(20.0 - step)) - applied.by_kp).abs() < 1e-7);
        let kd = |kd: f64| torque(Actuator { kd, ..pd }, &ON);
        assert!((slope(kd(0.7 + step), kd(0.7 - step)) - applied.by_kd).abs() < 1e-7);
    }
}

//! The way back from a torque to a command: what an actuator has to be told to put out a torque, or so much more of it than its own law does.

use super::applied::{Actuator, Command, Motion};
use super::kind::Kind;

/// In what form an actuator is told of a torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedForward {
    /// The torque itself, N m.
    Torque,
    /// A current, A.
    Current,
    /// A duty of the supply, 1.
    Duty,
    /// A voltage at the motor, V.
    Voltage,
    /// An offset of the position reference, rad.
    PositionOffset,
}

impl FeedForward {
    /// Every form.
    pub const ALL: [Self; 5] = [Self::Torque, Self::Current, Self::Duty, Self::Voltage, Self::PositionOffset];

    /// Those that an actuator of a kind takes, the usual one first.
    #[must_use]
    pub fn of(kind: Kind) -> &'static [Self] {
        match kind {
            Kind::Torque => &[Self::Torque],
            Kind::Current => &[Self::Current],
            Kind::DcMotor => &[Self::Duty, Self::Voltage],
            Kind::Pd => &[Self::Torque, Self::PositionOffset],
            Kind::PositionServo => &[Self::PositionOffset],
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::Current => "current",
            Self::Duty => "duty",
            Self::Voltage => "voltage",
            Self::PositionOffset => "position_offset",
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Torque => "N m",
            Self::Current => "A",
            Self::Duty => "1",
            Self::Voltage => "V",
            Self::PositionOffset => "rad",
        }
    }
}

impl Actuator {
    /// How much of a form one N m is, at rest, at the full supply and beyond the dead band: not finite where a controller has no gain.
    #[must_use]
    pub fn per_torque(&self, form: FeedForward) -> f64 {
        match form {
            FeedForward::Torque => 1.0,
            FeedForward::Current | FeedForward::Voltage => 1.0 / self.gain,
            FeedForward::Duty => 1.0 / (self.gain * self.supply),
            FeedForward::PositionOffset if self.kind == Kind::Pd => 1.0 / self.kp,
            FeedForward::PositionOffset => 1.0 / (self.gain * self.supply * self.error_gain * self.kp),
        }
    }

    /// Current, A, duty or voltage, V, at which a motor puts out `torque`, N m, at a velocity, rad/s, the loss by which it makes up for. Of an
    /// actuator that is told no such thing, the torque itself.
    #[must_use]
    pub fn effort_for(&self, form: FeedForward, torque: f64, velocity: f64) -> f64 {
        let voltage = (torque + self.back_emf * velocity) / self.gain;
        match form {
            FeedForward::Current => torque / self.gain,
            FeedForward::Voltage => voltage,
            FeedForward::Duty => self.duty_for(voltage, self.supply).clamp(-self.limits.duty, self.limits.duty),
            FeedForward::Torque | FeedForward::PositionOffset => torque,
        }
    }

    /// Offset of the position reference of `command`, rad, by which an actuator that follows it puts out so much more torque, N m, than it
    /// does without: the way back through its gain, the sag of its supply and its dead band. Its limits are not made up for: where it stands at
    /// one, an offset finds no more torque there than any other command.
    #[must_use]
    pub fn offset_for(&self, torque: f64, command: &Command, motion: Motion) -> f64 {
        if torque == 0.0 {
            return 0.0;
        }
        let error = self.seen_error(command, motion);
        let acted_upon = self.error(command, motion);
        let wanted = if self.kind == Kind::PositionServo {
            let per_error = self.kp_of(command) * self.error_gain;
            let held = (per_error * acted_upon).clamp(-self.limits.duty, self.limits.duty);
            let voltage = held * command.supply / (1.0 + self.sag * held * held) + torque / self.gain;
            acted_upon + (self.duty_for(voltage, command.supply) - held) / per_error
        } else {
            acted_upon + torque / self.kp_of(command)
        };
        let reached = if wanted == 0.0 {
            error.clamp(-self.dead_band, self.dead_band)
        } else {
            wanted + self.dead_band.copysign(wanted)
        };
        reached - error
    }

    /// The duty that makes a voltage of a supply that sags with it: voltage = duty supply / (1 + sag duty^2), solved for the smaller duty.
    /// Where no duty makes as much, the one that makes most.
    fn duty_for(&self, voltage: f64, supply: f64) -> f64 {
        let square = supply * supply - 4.0 * self.sag * voltage * voltage;
        if square > 0.0 { 2.0 * voltage / (supply + square.sqrt()) } else { self.sag.sqrt().recip().copysign(voltage) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::applied::Limits;
    use super::*;

    fn servo(sag: f64, dead_band: f64) -> Actuator {
        let ideal = Actuator::ideal(Kind::PositionServo);
        Actuator { gain: 0.2, back_emf: 0.05, error_gain: 0.003, supply: 8.0, kp: 400.0, sag, dead_band, ..ideal }
    }

    fn command(actuator: &Actuator, reference: f64) -> Command {
        let supply = actuator.supply;
        Command { reference, supply, enabled: true, ..Command::default() }
    }

    #[test]
    fn an_offset_is_so_much_more_torque_within_the_limits() {
        let pd = Actuator { kp: 30.0, kd: 0.5, dead_band: 0.01, ..Actuator::ideal(Kind::Pd) };
        let motion = Motion { position: 0.1, velocity: 0.7 };
        for actuator in [servo(0.0, 0.0), servo(0.4, 0.0), servo(0.4, 0.02), pd] {
            for reference in [-0.05, 0.095, 0.1, 0.115, 0.3] {
                let told = command(&actuator, reference);
                for torque in [-0.3, -0.01, 0.01, 0.3] {
                    let offset = actuator.offset_for(torque, &told, motion);
                    let moved = Command { reference: reference + offset, ..told };
                    let more = actuator.apply(&moved, motion).at(0.7) - actuator.apply(&told, motion).at(0.7);
                    assert!((more - torque).abs() < 1e-12, "{actuator:?} {reference} {torque}: {more}");
                }
                assert_eq!(actuator.offset_for(0.0, &told, motion), 0.0);
            }
        }
    }

    #[test]
    fn a_torque_that_leaves_nothing_to_do_ends_at_the_dead_band() {
        let actuator = servo(0.0, 0.02);
        let told = command(&actuator, 0.1);
        let own = actuator.apply(&told, Motion::default()).torque;
        let offset = actuator.offset_for(-own, &told, Motion::default());
        assert!((told.reference + offset).abs() < 0.02 + 1e-12, "{offset}");
    }

    #[test]
    fn a_servo_at_its_limit_gives_no_more() {
        let limits = Limits { duty: 0.5, torque: f64::INFINITY };
        for sag in [0.0, 2.0] {
            let actuator = Actuator { limits, ..servo(sag, 0.0) };
            let told = command(&actuator, 3.0);
            let offset = actuator.offset_for(0.2, &told, Motion::default());
            assert!(offset.is_finite() && offset >= 0.0);
            let moved = Command { reference: 3.0 + offset, ..told };
            assert_eq!(actuator.apply(&moved, Motion::default()), actuator.apply(&told, Motion::default()));
        }
    }

    #[test]
    fn an_effort_puts_out_the_torque_that_it_is_for() {
        let motion = Motion { position: 0.0, velocity: 0.7 };
        for (kind, form) in [
            (Kind::Current, FeedForward::Current),
            (Kind::DcMotor, FeedForward::Duty),
            (Kind::DcMotor, FeedForward::Voltage),
        ] {
            let actuator = Actuator { kind, ..servo(0.3, 0.0) };
            let effort = actuator.effort_for(form, 0.4, 0.7);
            let is_voltage = form == FeedForward::Voltage;
            let told = Command { effort, is_voltage, ..command(&actuator, 0.0) };
            assert!((actuator.apply(&told, motion).at(0.7) - 0.4).abs() < 1e-12, "{form:?}");
        }
        let most = Actuator { kind: Kind::DcMotor, ..servo(4.0, 0.0) };
        assert_eq!(most.effort_for(FeedForward::Duty, 9.0, 0.0), 0.5);
    }

    #[test]
    fn every_kind_takes_a_form_and_says_how_much_of_it_is_a_newton_metre() {
        for (kind, expected) in [
            (Kind::Torque, 1.0),
            (Kind::Current, 5.0),
            (Kind::DcMotor, 1.0 / 1.6),
            (Kind::Pd, 1.0),
            (Kind::PositionServo, 1.0 / (1.6 * 1.2)),
        ] {
            let form = FeedForward::of(kind)[0];
            assert!((Actuator { kind, ..servo(0.0, 0.0) }.per_torque(form) - expected).abs() < 1e-12, "{kind:?}");
        }
    }
}

//! What a run in closed loop gives: sentences, JSON, and the trace.

use std::fmt::Write;

use crc::{CRC_32_ISO_HDLC, Crc};
use frikan_runtime::supervised::adaptation::Correction;
use serde_json::{Value, json};

use crate::actuator::{Actuator, FeedForward};
use crate::figures::{digits, quantity};
use crate::rig::{Row, Scores, trace_bytes};

/// Both runs, and where the compensated one ran.
pub(super) struct Account<'a> {
    pub(super) target: &'a str,
    pub(super) motion: &'a str,
    pub(super) friction_scale: f64,
    pub(super) gain: f32,
    /// How the actuator is told, where it reports no torque.
    pub(super) fed: Option<FedBy>,
    pub(super) uncompensated: Scores,
    pub(super) compensated: Scores,
    pub(super) instructions: Option<(u32, u32)>,
    /// The compensated run.
    pub(super) rows: &'a [Row],
}

/// In what form an actuator that reports no torque is told of one.
#[derive(Clone, Copy)]
pub(super) struct FedBy {
    form: FeedForward,
    /// How much of it one N m is.
    per_torque: f64,
    follows_position: bool,
}

impl FedBy {
    pub(super) fn of(actuator: &Actuator, form: FeedForward) -> Self {
        Self { form, per_torque: actuator.per_torque(form), follows_position: actuator.kind.follows_position() }
    }

    /// What it is told of, and as what.
    fn line(&self, largest: f64) -> String {
        let told =
            if self.follows_position { "the compensation alone" } else { "the drive's torque, compensation included," };
        let form = match self.form {
            FeedForward::Torque => "a torque to add",
            FeedForward::Current => "a current",
            FeedForward::Duty => "a duty",
            FeedForward::Voltage => "a voltage",
            FeedForward::PositionOffset => "an offset of its position reference",
        };
        let [each, largest] = [self.per_torque, largest].map(|value| quantity(value, self.form.unit()));
        format!("the actuator is told {told} as {form}: {each} for each N m, {largest} at most for friction")
    }
}

/// Names of the drive's status by its number.
const STATUS: [&str; 5] = ["active", "no_model", "not_finite", "implausible", DEGRADED];
const DEGRADED: &str = "degraded";

impl Account<'_> {
    /// CRC-32 (ISO-HDLC) of the numbers of the trace.
    fn trace_crc32(&self) -> u32 {
        Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&trace_bytes(self.rows))
    }

    /// What the drive has learnt at the end.
    fn last_correction(&self) -> Correction {
        self.rows.last().map_or(Correction::NONE, |row| row.answer.correction)
    }

    /// What the actuator was told of compensation at most, in its form; without an actuator, N m.
    fn largest_feed_forward(&self) -> f64 {
        let told = |row: &Row| row.fed.map_or(f64::from(row.answer.compensation), |fed| fed.feed_forward);
        self.rows.iter().map(|row| told(row).abs()).fold(0.0, f64::max)
    }

    /// The smallest share of the gain that the monitor left.
    fn lowest_gain_share(&self) -> f32 {
        self.rows.iter().map(|row| row.answer.gain_share).fold(1.0, f32::min)
    }

    /// Samples in each status of the drive, the active one first.
    fn statuses(&self) -> impl Iterator<Item = (&'static str, usize)> + '_ {
        let count = |index: usize| self.rows.iter().filter(|row| row.answer.status as usize == index).count();
        STATUS.into_iter().enumerate().map(move |(index, name)| (name, count(index)))
    }

    /// The result in sentences, one a line.
    pub(super) fn lines(&self) -> Vec<String> {
        let (before, after) = (&self.uncompensated, &self.compensated);
        let mut lines = vec![format!(
            "{} for {} samples on {}, friction {} of the model's, gain {}",
            self.motion,
            self.rows.len(),
            self.target,
            digits(self.friction_scale),
            digits(f64::from(self.gain)),
        )];
        lines.extend(self.fed.map(|fed| fed.line(self.largest_feed_forward())));
        let mut compared = |what: &str, unit: &str, before: f64, after: f64| {
            lines.push(format!(
                "{what}: {} without compensation, {} with it",
                quantity(before, unit),
                quantity(after, unit)
            ));
        };
        if after.rms_error > 0.0 {
            compared("tracking error (RMS)", "rad", before.rms_error, after.rms_error);
            compared("largest tracking error", "rad", before.peak_error, after.peak_error);
        }
        if after.hold_peak_to_peak > 0.0 {
            compared("range of the position at rest", "rad", before.hold_peak_to_peak, after.hold_peak_to_peak);
        }
        if after.max_speed_after_nudge > 0.0 {
            compared(
                "largest speed after the nudge",
                "rad/s",
                before.max_speed_after_nudge,
                after.max_speed_after_nudge,
            );
            compared("speed at the end", "rad/s", before.final_speed, after.final_speed);
        }
        let lowest = self.lowest_gain_share();
        if lowest < 1.0 {
            lines.push(format!("the monitor lowered the gain to {} of its setting", digits(f64::from(lowest))));
        }
        let learnt = self.last_correction();
        if learnt != Correction::NONE {
            let [level, viscous, offset] =
                [learnt.level, learnt.viscous, learnt.offset].map(|value| digits(f64::from(value)));
            lines.push(format!(
                "learnt at the end: {level} times the friction of the model, {viscous} N m s/rad and {offset} N m"
            ));
        }
        for (name, count) in self.statuses().skip(1) {
            if count > 0 && name == DEGRADED {
                lines.push(format!(
                    "the drive says of {count} samples that it compensates by less than half, or cannot see"
                ));
            } else if count > 0 {
                lines.push(format!("no compensation in {count} samples: {}", name.replace('_', " ")));
            }
        }
        if let Some((fewest, most)) = self.instructions {
            lines.push(format!("the drive's step took {fewest} to {most} instructions"));
        }
        lines.push(format!("trace: CRC-32 {:08x}", self.trace_crc32()));
        lines
    }

    /// The result as JSON.
    pub(super) fn to_json(&self) -> Value {
        let statuses = self.statuses().map(|(name, count)| (name.to_owned(), Value::from(count)));
        let form = self.fed.map_or(FeedForward::Torque, |fed| fed.form);
        json!({
            "schema": "frikan.loop/1",
            "target": self.target,
            "motion": self.motion,
            "friction_scale": self.friction_scale,
            "gain": self.gain,
            "feed_forward": form.name(),
            "feed_forward_unit": form.unit(),
            "feed_forward_per_Nm": self.fed.map_or(1.0, |fed| fed.per_torque),
            "largest_feed_forward": self.largest_feed_forward(),
            "steps": self.rows.len(),
            "compensated": scores(&self.compensated),
            "uncompensated": scores(&self.uncompensated),
            "lowest_gain_share": self.lowest_gain_share(),
            "correction": correction(self.last_correction()),
            "status": Value::Object(statuses.collect()),
            "instructions": self.instructions.map(|(fewest, most)| json!({"min": fewest, "max": most})),
            "trace_crc32": format!("{:08x}", self.trace_crc32()),
        })
    }
}

fn correction(learnt: Correction) -> Value {
    json!({ "level": learnt.level, "viscous_Nms_rad": learnt.viscous, "offset_Nm": learnt.offset })
}

fn scores(scores: &Scores) -> Value {
    json!({
        "rms_error": scores.rms_error,
        "peak_error": scores.peak_error,
        "hold_peak_to_peak": scores.hold_peak_to_peak,
        "torque_rms": scores.torque_rms,
        "final_speed": scores.final_speed,
        "max_speed_after_nudge": scores.max_speed_after_nudge,
    })
}

/// The run as a recording, with what the drive did and the actuator was told beside it.
pub(super) fn trace(rows: &[Row], form: FeedForward) -> String {
    let mut text = String::from(
        "time_s,position_rad,velocity_rad_s,temperature_C,reference_position_rad,reference_velocity_rad_s,torque_Nm,\
         filtered_velocity_rad_s,compensation_torque_Nm,gain_share,friction_level,viscous_correction_Nms_rad,\
         offset_correction_Nm,status",
    );
    if rows.iter().any(|row| row.fed.is_some()) {
        text.push_str(match form {
            FeedForward::Torque => ",told_torque_Nm",
            FeedForward::Current => ",told_current_A",
            FeedForward::Duty => ",told_duty",
            FeedForward::Voltage => ",told_voltage_V",
            FeedForward::PositionOffset => ",told_position_rad",
        });
    }
    text.push('\n');
    for row in rows {
        let [position, velocity] =
            row.reference.map(|value| if value.is_nan() { String::new() } else { value.to_string() });
        let answer = &row.answer;
        // As short as a number of the drive is, where the torque is the drive's.
        let torque = row.fed.map_or_else(|| answer.torque.to_string(), |fed| fed.torque.to_string());
        let told = row.fed.map_or_else(String::new, |fed| format!(",{}", fed.told));
        let _ = writeln!(
            text,
            "{},{},{},{},{position},{velocity},{torque},{},{},{},{},{},{},{}{told}",
            row.time,
            row.position,
            row.velocity,
            row.temperature,
            answer.velocity,
            answer.compensation,
            answer.gain_share,
            answer.correction.level,
            answer.correction.viscous,
            answer.correction.offset,
            answer.status,
        );
    }
    text
}

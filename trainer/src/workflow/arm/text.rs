//! The result of an arm for a reader.

use std::fmt::Write;

use super::fitted::{FittedArm, beyond_trained, joint_doubt};
use crate::fit::outcome::{Score, SplitScore};
use crate::law::significant;
use crate::workflow::fit::text::write_parameter;
use crate::workflow::recordings::folded_warnings;

/// Significant digits of printed figures.
const DIGITS: usize = 4;
/// Share of rows beyond the velocities that a law was learnt from, from which it is told.
const TOLD_BEYOND: f64 = 0.001;

/// What `trainer arm` prints; `images` holds the name of the image of each joint, `None` where it was kept back.
pub(super) fn summary(arm: &FittedArm, images: &[Option<String>]) -> String {
    let mut text: String =
        folded_warnings(&arm.warnings).iter().map(|warning| format!("warning     {warning}\n")).collect();
    // Writing to a string cannot fail.
    let _ = write_summary(&mut text, arm, images);
    text
}

fn write_summary(out: &mut String, arm: &FittedArm, images: &[Option<String>]) -> std::fmt::Result {
    writeln!(out, "samples     {}", arm.outcome.filter)?;
    for (joint, image) in arm.outcome.joints.iter().zip(images) {
        writeln!(out, "\n{}", joint.name)?;
        if let Ok(law) = &joint.law {
            writeln!(out, "  law         friction = {}", law.law.expression)?;
            law.parameters.iter().try_for_each(|parameter| write_parameter(out, parameter))?;
            write_score(out, "train", law.train_score, &law.train_split, law.unit)?;
            for test in &law.tests {
                write_score(out, &format!("test {}", test.label), test.score, &test.split, law.unit)?;
                let beyond = beyond_trained(law, test);
                if beyond > TOLD_BEYOND {
                    writeln!(
                        out,
                        "              {:.1} % of its rows are faster than any that the law was learnt from",
                        100.0 * beyond
                    )?;
                }
            }
        }
        match joint.load_friction {
            Some(load) => {
                let [low, high] = load.ci95.map(|end| significant(end, DIGITS));
                writeln!(
                    out,
                    "  load        friction grows by {} of the transmitted load, 95 % in [{low}, {high}]",
                    significant(load.value, DIGITS)
                )?;
            }
            None => writeln!(out, "  load        no friction that grows with the transmitted load shows")?,
        }
        if let Some(constant) = joint.torque_constant {
            let known = constant.ci95.map_or_else(
                || "as given".to_owned(),
                |[low, high]| {
                    format!(
                        "by the masses of the URDF, 95 % in [{}, {}]",
                        significant(low, DIGITS),
                        significant(high, DIGITS)
                    )
                },
            );
            writeln!(out, "  current     {} N m/A, {known}", significant(constant.value, DIGITS))?;
        }
        match (image, joint_doubt(joint)) {
            (Some(image), None) => writeln!(out, "  image       {image}")?,
            (Some(image), Some(doubt)) => writeln!(out, "  image       {image}, in spite of {doubt}")?,
            (None, doubt) => {
                let why = doubt.map_or_else(String::new, |doubt| format!(": {doubt}"));
                writeln!(out, "  image       not written{why}")?;
            }
        }
    }
    let (known, unknown): (Vec<_>, Vec<_>) =
        arm.outcome.parameters.iter().partition(|parameter| parameter.estimate.ci95.is_some());
    writeln!(out, "\nbase inertial parameters within 5 %")?;
    for parameter in known {
        let [low, high] = parameter.estimate.ci95.unwrap_or_default().map(|end| significant(end, DIGITS));
        let value = significant(parameter.estimate.value, DIGITS + 1);
        writeln!(out, "  {} = {value} {}  95 % in [{low}, {high}]", parameter.expression, parameter.unit)?;
    }
    if !unknown.is_empty() {
        writeln!(out, "not determined within 5 % by this motion")?;
        unknown.iter().try_for_each(|parameter| writeln!(out, "  {}", parameter.expression))?;
    }
    writeln!(out, "\n{:.1} s, seed {}", arm.seconds, arm.seed)
}

fn write_score(out: &mut String, name: &str, score: Score, split: &SplitScore, unit: &str) -> std::fmt::Result {
    writeln!(
        out,
        "  {name:<11} relative error {:.2} % (moving {:.2} %), rmse {} {unit} (moving {})",
        100.0 * score.relative_error,
        100.0 * split.moving.relative_error,
        significant(score.rmse, DIGITS),
        significant(split.moving.rmse, DIGITS),
    )
}

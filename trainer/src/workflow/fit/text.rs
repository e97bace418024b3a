//! The result of a fit for a reader.

use std::fmt::Write;
use std::path::Path;

use super::integers;
use crate::fit::Outcome;
use crate::fit::outcome::{Score, Trace};
use crate::law::significant;
use crate::parameter::Parameter;
use crate::workflow::recordings::{Warning, folded_warnings};

/// Significant digits of printed figures.
const DIGITS: usize = 4;

/// What `trainer fit` prints; `image` is where it went, `None` where it was kept back.
pub(super) fn summary(outcome: &Outcome, warnings: &[Warning], image: Option<&Path>, seconds: f64) -> String {
    let mut text: String = folded_warnings(warnings).iter().map(|warning| format!("warning     {warning}\n")).collect();
    // Writing to a string cannot fail.
    let _ = write_summary(&mut text, outcome, image, seconds);
    text
}

fn write_summary(out: &mut String, outcome: &Outcome, image: Option<&Path>, seconds: f64) -> std::fmt::Result {
    let unit = outcome.unit;
    writeln!(out, "samples     {}", outcome.filter)?;
    writeln!(out, "\ninputs                 correlation  explained  beyond velocity")?;
    for row in &outcome.relevance {
        let mark = if row.picked { "used" } else { "" };
        let (explained, added) = (100.0 * row.explained, 100.0 * row.added);
        writeln!(out, "  {:<20} {:>+11.4} {explained:>8.1} % {added:>14.1} %  {mark}", row.input, row.correlation)?;
    }
    let network = &outcome.network;
    let edges = |graph: &crate::kan::GraphSummary| graph.edges.iter().filter(|edge| edge.active).count();
    let nodes = |graph: &crate::kan::GraphSummary| graph.nodes.iter().filter(|node| node.active).count();
    writeln!(
        out,
        "\nnetwork     {}: {} of {} nodes and {} of {} edges kept, rmse {} {unit}",
        network.architecture,
        nodes(&network.after),
        nodes(&network.before),
        edges(&network.after),
        edges(&network.before),
        significant(network.rmse, DIGITS),
    )?;
    writeln!(
        out,
        "law         friction = {}\n            {} nodes, {} structures tried, rmse {} {unit}",
        outcome.law.expression,
        outcome.law.nodes,
        outcome.law.explored,
        significant(outcome.law.rmse, DIGITS)
    )?;
    writeln!(out, "\nparameters")?;
    outcome.parameters.iter().try_for_each(|parameter| write_parameter(out, parameter))?;
    writeln!(out, "\nclassical laws on the same samples")?;
    for law in &outcome.classical {
        writeln!(out, "  {:<32} rmse {:>10} {unit}", law.name, significant(law.rmse, DIGITS))?;
    }
    let name = image.map_or_else(|| "not written,".to_owned(), |image| image.display().to_string());
    writeln!(out, "\nimage       {name} of {} bytes: {}", outcome.image.len(), outcome.choice)?;
    for candidate in &outcome.candidates {
        let mark = if candidate.chosen { "chosen" } else { "" };
        writeln!(
            out,
            "  {:<36} {:<28} {:>6} bytes {:>5} instructions, {} rmse {} {unit}  {mark}",
            candidate.form.name(),
            candidate.description,
            candidate.bytes,
            candidate.instructions,
            if outcome.held_out { "held-out" } else { "fitted" },
            significant(candidate.held_out_rmse, DIGITS)
        )?;
        if let Some(violation) = &candidate.violation {
            writeln!(out, "      {violation}")?;
        }
    }
    if let Some(integers) = &outcome.integers {
        out.push_str(&integers::text(integers, outcome));
    }
    writeln!(
        out,
        "\ngain        {:.2} for a supervised drive: by its 95 % band the friction may be {:.1} % lower",
        outcome.gain(),
        100.0 * outcome.uncertain_share()
    )?;
    writeln!(out, "\nscores of the image on the recorded rows        n        R2        rmse   error   at 100 Hz")?;
    outcome.train.iter().try_for_each(|trace| write_score(out, "train", trace, unit))?;
    outcome.tests.iter().try_for_each(|trace| write_score(out, "test", trace, unit))?;
    for remark in &outcome.remarks {
        writeln!(out, "\nnote        {remark}")?;
    }
    writeln!(out, "\n{seconds:.1} s, seed {}", outcome.seed)
}

/// A line for a parameter, in a list.
pub(in crate::workflow) fn write_parameter(out: &mut String, parameter: &Parameter) -> std::fmt::Result {
    let interval = parameter.without_interval().map_or_else(
        || {
            let [low, high] = parameter.ci95.map(|bound| significant(bound, DIGITS));
            format!("95 % in [{low}, {high}]")
        },
        str::to_owned,
    );
    writeln!(
        out,
        "  {:<30} {:<6} {:>11} {:<10} {interval}",
        parameter.name,
        parameter.symbol,
        significant(parameter.value, DIGITS + 1),
        parameter.unit,
    )
}

fn write_score(out: &mut String, kind: &str, trace: &Trace, unit: &str) -> std::fmt::Result {
    let Score { n, r2, rmse, relative_error } = trace.score;
    writeln!(
        out,
        "  {kind:<5} {:<34} {n:>8} {r2:>9.6} {:>11} {unit} {:>6.2} %  {:>6.2} %",
        trace.label,
        significant(rmse, DIGITS + 1),
        100.0 * relative_error,
        100.0 * trace.filtered_score.relative_error,
    )?;
    let (moving, rest) = (trace.split.moving, trace.split.rest);
    if rest.n == 0 {
        return Ok(());
    }
    writeln!(
        out,
        "        moving {:>40} {:>9.6} {:>11} {unit}; {} rows at rest, {:.1} % of them within break-away",
        moving.n,
        moving.r2,
        significant(moving.rmse, DIGITS + 1),
        rest.n,
        100.0 * rest.inside_breakaway,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_determined_has_no_interval() {
        let line = |ci95| {
            let parameter = Parameter {
                name: "coulomb_torque".to_owned(),
                symbol: "F_c".to_owned(),
                value: 2.0,
                unit: "N m".to_owned(),
                ci95,
            };
            let mut text = String::new();
            write_parameter(&mut text, &parameter).unwrap();
            text
        };
        assert!(line([1.9, 2.1]).contains("95 % in [1.9, 2.1]"));
        let open = line([f64::NEG_INFINITY, f64::INFINITY]);
        assert!(open.contains("not told apart") && !open.contains("inf"), "{open}");
        let held = line([2.0, 2.0]);
        assert!(held.contains("not determined") && !held.contains('['), "{held}");
    }
}

//! A fleet in sentences, and as JSON.

use serde_json::{Value, json};

use super::gathered::{Gathered, Unfitted, reasons};
use crate::figures::{digits, quantity};
use crate::fleet::{Comparison, Estimate, Kind, Member, Quantity};

/// Failures that are told one by one; the table has all.
const MOST_TOLD: usize = 20;

/// One sentence on the whole, then one for each kind, outlier and failure.
pub(super) fn text(gathered: &Gathered<'_>) -> (String, Vec<String>) {
    let Gathered { survey, fitted, unfitted } = gathered;
    let outliers: Vec<&Member> = survey.members.iter().filter(|member| member.is_outlier).collect();
    let failed = unfitted.iter().filter(|unfitted| unfitted.failure.is_some()).count();
    let headline = format!(
        "{} joints in {} recordings, {failed} of them failed, {} not done: {} differ from their siblings (of these at most {} % are \
         expected to be healthy).",
        survey.members.len(),
        fitted.len() + unfitted.len(),
        unfitted.len() - failed,
        outliers.len(),
        digits(100.0 * survey.false_share),
    );
    let kinds = survey.kinds.iter().map(kind_sentence);
    let outliers = outliers.into_iter().map(|member| outlier_sentence(&survey.kinds[member.kind], member));
    let failures = unfitted.iter().take(MOST_TOLD).map(failure_sentence);
    let rest = unfitted.len().checked_sub(MOST_TOLD + 1).map(|rest| format!("and {} more that left no fit", rest + 1));
    (headline, kinds.chain(outliers).chain(failures).chain(rest).collect())
}

fn kind_sentence(kind: &Kind) -> String {
    let constant = |(name, unit, siblings): &(String, String, Option<crate::fleet::Siblings>)| {
        let siblings = siblings.as_ref()?;
        let name = name.replace('_', " ");
        let mean = quantity(siblings.mean, unit);
        // Where the intervals alone explain what the joints differ by.
        let spread = || format!("± {}", quantity(siblings.spread, unit));
        Some(format!("{name} {mean} {}", if siblings.spread > 0.0 { spread() } else { "in all".to_owned() }))
    };
    let constants: Vec<String> = kind.constants.iter().filter_map(constant).collect();
    let name = if kind.name.is_empty() { "all joints" } else { &kind.name };
    let law = kind.law.as_deref().unwrap_or("no law that all can be fitted by");
    let constants = if constants.is_empty() { String::new() } else { format!(": {}", constants.join(", ")) };
    format!("{name}: {} joints, {law}{constants}", kind.joints)
}

fn outlier_sentence(kind: &Kind, member: &Member) -> String {
    let told = |compared: &Comparison| {
        let (value, departure) = (compared.value?, compared.departure?);
        let size = match compared.quantity {
            Quantity::Trend => format!("{} % a year", digits(100.0 * value.value)),
            _ => quantity(value.value, &kind.unit),
        };
        let side = if departure.deviations > 0.0 { "above" } else { "below" };
        let name = compared.quantity.name().replace('_', " ");
        Some(format!("{name} {size}, {:.1} deviations {side} its siblings", departure.deviations.abs()))
    };
    let told: Vec<String> = member.compared.iter().filter(|compared| compared.stands_out).filter_map(told).collect();
    format!("{}: {}", member.joint, told.join("; "))
}

fn failure_sentence(unfitted: &Unfitted<'_>) -> String {
    let Unfitted { task, failure } = unfitted;
    match failure {
        Some(failure) => format!("{} failed: {} {}", task.recording, failure.code, failure.message),
        None => format!("{} was not done: `trainer run --index {}`", task.recording, task.index),
    }
}

/// The whole as JSON, schema `frikan.fleet/1`.
pub(super) fn json(gathered: &Gathered<'_>) -> Value {
    let survey = &gathered.survey;
    let estimate = |estimate: Estimate| json!({ "value": estimate.value, "error": estimate.error });
    let siblings = |siblings: &Option<crate::fleet::Siblings>| {
        siblings.map(|s| json!({ "mean": s.mean, "spread": s.spread, "joints": s.count }))
    };
    let kind = |kind: &Kind| {
        let quantities = Quantity::ALL.iter().zip(&kind.common);
        json!({
            "name": kind.name,
            "unit": kind.unit,
            "joints": kind.joints,
            "law": kind.law,
            "speeds": kind.levels.0,
            "parameters": kind.constants.iter()
                .map(|(name, unit, common)| json!({ "name": name, "unit": unit, "siblings": siblings(common) }))
                .collect::<Vec<_>>(),
            "quantities": quantities
                .map(|(quantity, common)| json!({
                    "name": quantity.name(),
                    "scale": if *quantity == Quantity::Trend { "per_year" } else { "logarithm" },
                    "siblings": siblings(common),
                }))
                .collect::<Vec<_>>(),
        })
    };
    let member = |member: &Member| {
        json!({
            "joint": member.joint,
            "kind": survey.kinds[member.kind].name,
            "recordings": member.recordings,
            "parameters": member.constants.iter()
                .map(|(own, expected)| json!({
                    "name": own.name, "symbol": own.symbol, "value": own.value, "unit": own.unit, "ci95": own.ci95,
                    "expected": estimate(*expected),
                }))
                .collect::<Vec<_>>(),
            "quantities": member.compared.iter()
                .map(|compared| json!({
                    "name": compared.quantity.name(),
                    "value": compared.value.map(estimate),
                    "deviations": compared.departure.map(|departure| departure.deviations),
                    "p": compared.departure.map(|departure| departure.p),
                }))
                .collect::<Vec<_>>(),
            "ripple_order": member.ripple_order,
            "false_share": member.adjusted,
            "outlier": member.is_outlier,
            "outlier_by": reasons(member),
        })
    };
    let unfitted = |unfitted: &Unfitted<'_>| {
        let Unfitted { task, failure } = unfitted;
        json!({ "index": task.index, "joint": task.joint, "recording": task.recording, "error": failure })
    };
    json!({
        "schema": "frikan.fleet/1",
        "false_share": survey.false_share,
        "recordings": gathered.fitted.len() + gathered.unfitted.len(),
        "kinds": survey.kinds.iter().map(kind).collect::<Vec<_>>(),
        "joints": survey.members.iter().map(member).collect::<Vec<_>>(),
        "unfitted": gathered.unfitted.iter().map(unfitted).collect::<Vec<_>>(),
    })
}

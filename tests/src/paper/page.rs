//! The page `docs/paper.md` with its pictures: every experiment, our figure beside the published one and pykan's.

mod networks;

use std::fmt::Write;

use frikan_trainer::error::Result;
use frikan_trainer::fit::Outcome;
use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::kan::GraphSummary;
use frikan_trainer::law::KnownForm;
use frikan_trainer::report::picture::{self, Ink, Mark, Series};

use super::symbolic::{Symbolic, symbolic};
use super::{Effort, JOINTS, known_form, robot};

/// pykan 0.2.8 on clean data, 300 L-BFGS steps, as measured for this project: test RMSE in N m; 64 s a joint.
pub const PYKAN_CLEAN_RMSE: [f64; 6] = [0.017, 0.067, 0.040, 0.042, 0.37, 0.18];
/// Seconds of that.
pub const PYKAN_SECONDS: f64 = 64.0;
/// pykan's R2 against the clean truth under the noise of the paper, 100 steps.
pub const PYKAN_NOISY_R2: [f64; 6] = [0.9999, 0.9996, 0.9993, 0.9988, 0.9976, 0.9957];
/// What the median of many draws shall reach under that noise.
pub const NOISY_R2_WANTED: [f64; 6] = [0.9999, 0.9998, 0.9996, 0.999, 0.9985, 0.997];

/// Points of a drawn curve.
const POINTS: usize = 241;

const HEAD: &str = "\
# The paper's experiments

Written, with its pictures, by `cargo run --release -p frikan-tests --bin reproduce-paper`; every figure of ours is computed by that
command. The experiments are those of Wang, Rabczuk & Liu, *Physics-informed Machine Learning for Static Friction Modeling in
Robotic Manipulators Based on Kolmogorov-Arnold Networks*; the figures of pykan 0.2.8 were measured for this project on a
machine of the same class, one thread. N = 1000 samples, v uniform in [-1, 1] rad/s; test errors are against the clean truth on 2000
other samples.
";

/// Files by name, relative to the folder of the page.
pub type Files = Vec<(String, String)>;

/// The page and its pictures.
///
/// # Errors
/// As reading and fitting the recordings of the robot.
pub fn files(effort: Effort) -> Result<Files> {
    let mut files = Files::new();
    let mut page = String::from(HEAD);
    // Writing to a string cannot fail.
    let _ = known_forms(&mut page, effort);
    let _ = networks::networks(&mut page, &mut files, effort);
    let _ = formulas(&mut page, &mut files);
    match robot::folder() {
        Some(folder) => {
            let axes =
                [1, 2, 3].into_iter().map(|axis| robot::axis(&folder, axis, None)).collect::<Result<Vec<_>>>()?;
            let formula = robot::axis(&folder, 1, Some(Representation::Expression))?;
            let _ = robots(&mut page, &mut files, &axes, &formula);
        }
        None => page.push_str("\n## P7 to P9\n\nThe robot's recordings are not on this machine.\n"),
    }
    files.push(("paper.md".into(), page));
    Ok(files)
}

fn known_forms(page: &mut String, effort: Effort) -> std::fmt::Result {
    writeln!(
        page,
        "\n## P1: known form, clean\n\nLargest relative error of the four constants. Published: 1.1e-6 to 9.5e-6 after 30 000 steps of Adam.\n"
    )?;
    writeln!(page, "| joint | 10 % | 30 % | 80 % |\n|---|---|---|---|")?;
    for j in 0..JOINTS.len() {
        let errors = [0.1, 0.3, 0.8].map(|share| format!("{:.0e}", known_form::clean_error(j, share, 30_000)));
        writeln!(page, "| {} | {} |", j + 1, errors.join(" | "))?;
    }
    writeln!(
        page,
        "\n## P2: known form, noise of a quarter of the range\n\nPublished: the curve stays on the clean truth. The last columns \
         count draws, of {}, in which a constant is within two\nstandard errors of the truth.\n\n\
         | joint | R2, clean truth | R2, noisy samples | k1 | k2 | k3 | k4 |\n|---|---|---|---|---|---|---|",
        effort.coverage
    )?;
    for j in 0..JOINTS.len() {
        let known_form::Noisy { clean_r2, noisy_r2, within } = known_form::noisy(j, effort);
        let within = within.map(|n| n.to_string()).join(" | ");
        writeln!(page, "| {} | {clean_r2:.5} | {noisy_r2:.4} | {within} |", j + 1)?;
    }
    Ok(())
}

fn series(mark: Mark, ink: Ink, label: &str) -> Series {
    Series { mark, ink, label: label.into() }
}

const OVER_VELOCITY: [&str; 2] = ["velocity (rad/s)", "friction torque (N m)"];

fn formulas(page: &mut String, files: &mut Files) -> std::fmt::Result {
    writeln!(
        page,
        "\n## P4 and P6: formulas\n\n`[1,[5,2],1]`, pruned, activations matched, law searched. Published: R2 close to 1, formulas of \
         40 to 150 operators, none of\nthem the law that generated the data. pykan 0.2.8: a constant or a crash by default, 60 to 142 \
         nodes in 48 to 86 s with its weight\non simplicity off.\n\n| experiment | joint | formula | nodes | R2, clean truth | seconds |\n|---|---|---|---|---|---|"
    )?;
    for (name, share) in [("P4, clean", 0.0), ("P6, 5 % noise", 0.025)] {
        for joint in [0, 1] {
            let result = symbolic(joint, share, 0);
            let Symbolic { formula, nodes, r2, seconds, .. } = &result;
            writeln!(page, "| {name} | {} | `{formula}` | {nodes} | 1 - {:.0e} | {seconds:.1} |", joint + 1, 1.0 - r2)?;
            if share == 0.0 && joint == 0 {
                network_pictures(files, &result);
            }
        }
    }
    writeln!(
        page,
        "\n| trained | pruned | symbolic |\n|---|---|---|\n| ![trained](paper/graph-trained.svg) | ![pruned](paper/graph-pruned.svg) | \
         ![symbolic](paper/graph-symbolic.svg) |\n\nAn edge is as dark as its attribution; one that follows a function of the library is of \
         another colour. Activations that are left:\n"
    )?;
    for (name, _) in files.iter().filter(|(name, _)| name.starts_with("paper/activation-")) {
        writeln!(page, "![activation]({name})")?;
    }
    Ok(())
}

fn network_pictures(files: &mut Files, result: &Symbolic) {
    let input = ["velocity".to_owned()];
    for (graph, name) in result.graphs.iter().zip(["trained", "pruned", "symbolic"]) {
        files.push((format!("paper/graph-{name}.svg"), picture::network(graph, &input)));
    }
    let graph: &GraphSummary = &result.graphs[2];
    for (index, edge) in graph.edges.iter().enumerate().filter(|(_, edge)| edge.active) {
        let points = graph.curve(&result.network, index, POINTS);
        let place = format!("layer {}, {} to {}", edge.layer, edge.from, edge.to);
        let label = edge.symbolic.as_ref().map_or(place.clone(), |function| format!("{place}: {function}"));
        let svg = picture::curves(["in", "out"], &[series(Mark::Line(points), Ink::One, &label)]);
        files.push((format!("paper/activation-{}-{}-{}.svg", edge.layer, edge.from, edge.terminal), svg));
    }
}

fn robots(page: &mut String, files: &mut Files, axes: &[Outcome], formula: &Outcome) -> std::fmt::Result {
    writeln!(
        page,
        "\n## P7: a real robot\n\nThe paper's robot is not public; a KUKA KR300 (J. Weigand, MIT licence) stands in, trained on trajectory A. \
         Published, for the\npaper's robot: R2 above 0.95 on every trajectory. The ceiling is what means over 80 narrow bins of velocity explain on the \
         very\ntrajectory, not held out: no law of velocity alone does much better.\n\n\
         | axis | trajectory | R2, torque | R2, friction | ceiling, friction |\n|---|---|---|---|---|"
    )?;
    for (axis, outcome) in axes.iter().enumerate() {
        for trace in outcome.train.iter().chain(&outcome.tests) {
            let (friction, ceiling) = (robot::friction_score(trace).r2, robot::ceiling(trace));
            writeln!(
                page,
                "| {} | {} | {:.4} | {friction:.4} | {ceiling:.4} |",
                axis + 1,
                trace.label,
                trace.score.r2
            )?;
            let name = format!("paper/scatter-{}.svg", trace.label.trim_end_matches(".csv"));
            let points = |values: &[f64]| trace.velocity.iter().zip(values).map(|(v, f)| [*v, *f]).collect();
            let marks = [
                series(Mark::Dots(points(&trace.friction)), Ink::Data, "measured"),
                series(Mark::Dots(points(&trace.predicted_friction)), Ink::One, "predicted"),
            ];
            files.push((name.clone(), picture::curves(OVER_VELOCITY, &marks)));
        }
    }
    let trace = &axes[0].tests[0];
    let over_time = |values: &[f64]| Mark::Line(trace.time.iter().zip(values).map(|(t, f)| [*t, *f]).collect());
    let marks = [
        series(over_time(&trace.friction), Ink::Data, "measured"),
        series(over_time(&trace.predicted_friction), Ink::One, "predicted"),
    ];
    files.push(("paper/time-axis1.svg".into(), picture::curves(["time (s)", OVER_VELOCITY[1]], &marks)));
    writeln!(
        page,
        "\n![Axis 1, test trajectory over velocity](paper/scatter-axis1-B.svg)\n![Axis 1, test trajectory over time](paper/time-axis1.svg)"
    )?;
    writeln!(
        page,
        "\n## P8: a formula of the real robot\n\nAxis 1. Published: holds on the other trajectories, 40 operators and more.\n\n    {}\n\n{} nodes; R2 of the torque {}.",
        formula.law.expression,
        formula.law.nodes,
        formula.tests.iter().map(|t| format!("{:.4} on {}", t.score.r2, t.label)).collect::<Vec<_>>().join(", ")
    )?;
    let axis3 = &axes[2];
    let known = robot::known_form_scores(axis3, KnownForm::Stribeck);
    writeln!(
        page,
        "\n## P9: one trajectory to another, and which input matters\n\nAxis 3. Published: friction correlates with velocity (.92, .93), not with the rigid-body torque (.02, -.37); \
         the symbolic network is\nas good as the known form.\n\n| trajectory | R2, friction, image | R2, friction, known Stribeck form |\n|---|---|---|"
    )?;
    for (trace, known) in axis3.tests.iter().zip(known) {
        writeln!(page, "| {} | {:.4} | {:.4} |", trace.label, robot::friction_score(trace).r2, known.r2)?;
    }
    let rows: Vec<(String, f64, bool)> =
        axis3.relevance.iter().map(|row| (row.input.clone(), row.correlation.abs(), row.picked)).collect();
    files.push(("paper/correlation-axis3.svg".into(), picture::bars(&rows, "")));
    writeln!(
        page,
        "\nMagnitude of the correlation of friction with each candidate; the picked ones stand out.\n\n![Correlations](paper/correlation-axis3.svg)"
    )
}

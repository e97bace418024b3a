//! What a recording cannot tell apart, the proposed motion does.

use frikan_tests::concealed::advised::{pairs, run};

#[test]
fn explore() {
    for case in pairs() {
        let begin = std::time::Instant::now();
        let advised = run(&case, 1).unwrap();
        let set = |d: &frikan_trainer::diagnose::Diagnosis| {
            d.findings
                .iter()
                .map(|f| {
                    format!(
                        "{} ({:.0} nats; {})",
                        f.effect.name(),
                        f.score,
                        f.standings
                            .iter()
                            .take(3)
                            .map(|(e, n)| format!("{} {n:.1}", e.name()))
                            .collect::<Vec<_>>()
                            .join(", ")
                    )
                })
                .collect::<Vec<_>>()
                .join(" + ")
        };
        println!("{} / {}: before {}", case.truth, case.rival, set(&advised.before));
        if let Some(plan) = &advised.plan {
            println!("    plan {} present {:.1} expected {:.1}", plan.words, plan.present_nats, plan.expected_nats);
        }
        if let Some(after) = &advised.after {
            println!("    after {}; reached {:?}", set(after), advised.reached_nats(&case));
        }
        println!("    {:.1} s", begin.elapsed().as_secs_f64());
    }
}

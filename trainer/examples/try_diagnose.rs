//! Scratch.
use frikan_trainer::diagnose::*;
use frikan_trainer::{joint::Joint, recording};
fn main() {
    for file in std::env::args().skip(1) {
        let joint = Joint {
            drive: frikan_trainer::joint::Drive { counts_per_turn: Some(8192.0), ..Default::default() },
            ..Default::default()
        };
        let rec = recording::load(std::path::Path::new(&file), &joint).unwrap();
        let signals = Signals::of(&rec, &joint).unwrap();
        let t = std::time::Instant::now();
        let lock = if std::env::var("TAIL").is_ok() { Lock::Tail(0.5) } else { Lock::Spread };
        match diagnose(&signals, "X", &Options { lock, ..Options::default() }) {
            Ok(d) => {
                println!(
                    "{file} {:?} cut {} rows {} delay {:.2e} noise {:.4} base {:?} improved {:?} proof {:?}  ({:?})",
                    d.verdict,
                    d.cut_off_hz,
                    d.rows,
                    d.sampling_delay_s,
                    d.noise_rmse,
                    d.baseline,
                    d.improved,
                    d.proof,
                    t.elapsed()
                );
                for p in &d.base_parameters {
                    println!("   {} = {:.4} {:?} {}", p.name, p.value, p.ci95, p.unit);
                }
                for h in &d.health {
                    println!("   health {}", h.sentence);
                }
                for f in &d.findings {
                    println!(
                        "   FOUND {} {:?} p={:.2} alt {:?} score {:.1} margin {:.1} locked {:?} shape {:?}",
                        f.effect.name(),
                        f.fitted.label,
                        f.probability,
                        f.alternatives,
                        f.score,
                        f.margin,
                        f.locked_gain_nats,
                        f.fitted.shape
                    );
                    for p in &f.parameters {
                        println!("       {} = {:.5} {:?} {}", p.name, p.value, p.ci95, p.unit);
                    }
                    if let Some(r) = f.location.regions.first() {
                        println!("       {r:?}");
                    }
                }
                println!("   withdrawn {:?}", d.withdrawn);
                for r in d.rivals.iter().take(6) {
                    println!(
                        "   rival {:?} S {:.1} heldout {:.1} crit {:.1} p {:.1e} T {:.1}",
                        r.label,
                        r.score,
                        r.evidence.held_out,
                        r.evidence.criterion,
                        r.family_wise,
                        r.evidence.statistic
                    );
                }
            }
            Err(e) => println!("{file}: {e}"),
        }
    }
}

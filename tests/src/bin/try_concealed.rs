//! Scratch: try_concealed LAMBDA SEEDS EFFECT...
use frikan_tests::concealed::*;
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::plant::{CATALOGUE, NoiseKind, OUTSIDE};
use rayon::prelude::*;
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let lambda: f64 = args[0].parse().unwrap();
    let (a, b) = args[1].split_once('-').unwrap();
    let seeds: Vec<u64> = (a.parse().unwrap()..b.parse().unwrap()).collect();
    let base = if std::env::var("SPLINE").is_ok() { BaseKind::Spline } else { BaseKind::CoulombViscous };
    let mut cases = Vec::new();
    if args[2] == "controls" {
        for &seed in &seeds {
            for noise in NoiseKind::ALL {
                cases.push(Case { hidden: Hidden::Nothing, noise, base, seed });
            }
        }
    } else {
        let mut names: Vec<&'static str> = Vec::new();
        for e in CATALOGUE.iter().chain(OUTSIDE.iter()) {
            if args[2] == "all" && CATALOGUE.iter().any(|c| c.name == e.name)
                || args[2] == "outside" && OUTSIDE.iter().any(|c| c.name == e.name)
                || args[2..].iter().any(|n| n == e.name)
            {
                names.push(e.name);
            }
        }
        for &seed in &seeds {
            for name in &names {
                cases.push(Case { hidden: Hidden::Effect(name, lambda), noise: NoiseKind::Coloured, base, seed });
            }
        }
    }
    let out: Vec<String> = cases.par_iter().map(|case| {
        let t = std::time::Instant::now();
        let line = match run(case) {
        Ok(o) => {
            let d = &o.diagnosis;
            let f: Vec<String> = d.findings.iter().map(|f| format!("{}{}{:?} S{:.0} m{:.1} L{:.1} {:?}", f.effect.name(), if f.effect.name()=="unknown" {format!("{:?}", f.fitted.label)} else {String::new()}, f.alternatives.iter().map(|(e, _)| e.name()).collect::<Vec<_>>(), f.score, f.margin, f.locked_gain_nats.unwrap_or(0.0), f.fitted.shape)).collect();
            let top: Vec<String> = d.rivals.iter().take(2).map(|r| format!("{:?} S{:.1} p{:.0e} T{:.0}", r.label, r.score, r.family_wise, r.evidence.statistic)).collect();
            format!("{:?} {:?} s{} lam {:.0} enr {:.2} cut {} rows {} | {} | wd {:?} | base {:.3} imp {:.3} noise {:.3} | {} | {:.1?}", case.hidden, case.noise, case.seed, o.lambda, o.effect_to_noise, d.cut_off_hz, d.rows, f.join(" + "), d.withdrawn, d.baseline.rmse, d.improved.rmse, d.noise_rmse, top.join(" ; "), t.elapsed())
        }
        Err(e) => format!("{case:?} ERROR {e}"),
    }; println!("{line}"); line }).collect();
    let _ = out;
}

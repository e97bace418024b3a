use super::*;
use crate::plant::recording::root_mean_square;
use crate::plant::{CATALOGUE, Campaign, NoiseKind, OUTSIDE, Trajectory};

/// A joint without noise.
fn quiet() -> Joint {
    let mut joint = Joint::default();
    joint.noise.white_torque_Nm = 0.0;
    joint.noise.coloured_torque_Nm = 0.0;
    joint.drive.torque_resolution_Nm = 0.0;
    joint
}

#[test]
fn survey() {
    let joint = Joint::default();
    let start = std::time::Instant::now();
    let clean = simulate(&joint, 5).unwrap();
    eprintln!("{} rows in {:?}; noise {}", clean.len(), start.elapsed(), clean.truth.noise_rms);
    let t = clean.column("temperature_C").unwrap();
    eprintln!("T {} .. {}", t[0], t[t.len() - 1]);
    let r = clean.column("reference_position_rad").unwrap();
    for part in clean.split() {
        let r = part.column("reference_position_rad").unwrap();
        let e: Vec<f64> = r.iter().zip(&part.truth.position).map(|(a, b)| a - b).collect();
        let m = |x: &[f64]| x.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        eprintln!(
            "traj {} ref peak {:.3} v peak {:.3} a peak {:.2} err rms {:.5} rest {:.3} end {:.4} tau {:.2}",
            part.column("trajectory").unwrap()[0],
            m(r),
            m(&part.truth.velocity),
            m(&part.truth.acceleration),
            root_mean_square(&e),
            part.truth.velocity.iter().filter(|v| **v == 0.0).count() as f64 / part.len() as f64,
            r[r.len() - 1],
            m(part.column("torque_Nm").unwrap())
        );
    }
    let _ = r;
    for entry in CATALOGUE.iter().chain(OUTSIDE) {
        let mut line = String::new();
        for seed in 1..5 {
            let start = std::time::Instant::now();
            match conceal(&joint, entry.name, 1.0, seed) {
                Ok(x) => {
                    line += &format!(
                        " {:.3} ({:.0} ms)",
                        root_mean_square(&x.truth.effect_torque),
                        start.elapsed().as_secs_f64() * 1e3
                    )
                }
                Err(e) => line += &format!(" {e}"),
            }
        }
        eprintln!("{:32}{line}", entry.name);
    }
}

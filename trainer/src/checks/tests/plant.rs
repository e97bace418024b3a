//! Recordings of joints that exist nowhere: the motion is a sum of sines, the torque follows from it, noise comes on top.

use crate::joint::Joint;
use crate::recording::{Recording, parse};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A joint and how it is recorded.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    pub(super) columns: [&'static str; 4],
    pub(super) rate_hz: f64,
    pub(super) seconds: f64,
    /// Amplitude (rad or m) and frequency (Hz) of the parts of the motion.
    pub(super) motion: Vec<[f64; 2]>,
    /// Speed of a steady motion on top, rad/s or m/s.
    pub(super) steady: f64,
    pub(super) inertia: f64,
    pub(super) gravity: f64,
    pub(super) coulomb: f64,
    pub(super) viscous: f64,
    /// Step of the encoder.
    pub(super) step: f64,
    /// Noise of the torque, largest value.
    pub(super) noise: f64,
}

/// Time, position, velocity, torque.
pub(super) type Row = [f64; 4];

/// A robot's joint in N m at 500 Hz.
pub(super) fn robot() -> Plant {
    Plant {
        columns: ["time_s", "position_rad", "velocity_rad_s", "torque_Nm"],
        rate_hz: 500.0,
        seconds: 30.0,
        motion: vec![[0.9, 0.11], [0.35, 0.43], [0.12, 1.3]],
        steady: 0.0,
        inertia: 0.05,
        gravity: 2.0,
        coulomb: 0.8,
        viscous: 0.3,
        step: 1e-5,
        noise: 0.03,
    }
}

/// A linear axis in N at 5 kHz.
pub(super) fn axis() -> Plant {
    Plant {
        columns: ["time_s", "position_m", "velocity_m_s", "force_N"],
        rate_hz: 5000.0,
        seconds: 12.0,
        motion: vec![[0.08, 0.4], [0.015, 1.7]],
        steady: 0.0,
        inertia: 95.0,
        gravity: 0.0,
        coulomb: 20.0,
        viscous: 200.0,
        step: 1e-6,
        noise: 1.0,
    }
}

/// A small motor in A at 100 Hz.
pub(super) fn motor() -> Plant {
    Plant {
        columns: ["time_s", "position_rad", "velocity_rad_s", "current_A"],
        rate_hz: 100.0,
        seconds: 80.0,
        motion: vec![[6.0, 0.07], [1.1, 0.31], [0.4, 0.9]],
        steady: 0.0,
        inertia: 0.02,
        gravity: 0.0,
        coulomb: 0.12,
        viscous: 0.03,
        step: std::f64::consts::TAU / 65536.0,
        noise: 0.01,
    }
}

pub(super) fn joints() -> [Plant; 3] {
    [robot(), axis(), motor()]
}

impl Plant {
    /// The rows as a healthy recording has them.
    pub(super) fn rows(&self) -> Vec<Row> {
        let mut noise = Noise(1);
        let count = (self.rate_hz * self.seconds) as usize;
        let row = |index: usize| {
            let t = index as f64 / self.rate_hz;
            let [mut q, mut v, mut a] = [self.steady * t, self.steady, 0.0];
            for (index, [amplitude, frequency]) in self.motion.iter().enumerate() {
                let (order, phase) = (TAU * frequency, TAU * frequency * t + 0.7 * index as f64);
                q += amplitude * phase.sin();
                v += amplitude * order * phase.cos();
                a -= amplitude * order * order * phase.sin();
            }
            let u = self.inertia * a + self.gravity * q.sin() + self.coulomb * (v / 1e-3).tanh() + self.viscous * v;
            let v = v + 1e-3 * self.motion[0][0] * noise.next();
            [t, (q / self.step).round() * self.step, v, u + self.noise * noise.next()]
        };
        (0..count).map(row).collect()
    }

    /// A recording of these rows.
    pub(super) fn recording(&self, rows: &[Row]) -> Recording {
        let mut text = self.columns.join(",") + "\n";
        for [t, q, v, u] in rows {
            writeln!(text, "{t},{q},{v},{u:e}").unwrap();
        }
        parse("plant.csv", text.as_bytes(), &Joint::default()).unwrap()
    }

    /// A recording whose every row is `changed` with its index.
    pub(super) fn changed(&self, changed: impl Fn(usize, Row) -> Row) -> Recording {
        let rows: Vec<Row> = self.rows().into_iter().enumerate().map(|(index, row)| changed(index, row)).collect();
        self.recording(&rows)
    }

    /// Index of the row at a time, s.
    pub(super) fn at(&self, time_s: f64) -> usize {
        (time_s * self.rate_hz) as usize
    }
}

/// Evenly distributed between -1 and 1 (Knuth's linear congruential generator).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((self.0 >> 11) as f64 / (1u64 << 53) as f64) - 1.0
    }
}

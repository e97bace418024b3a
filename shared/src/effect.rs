//! The correction terms that a diagnosis adds to a law, each with its coefficients.
//!
//! Notation: `v` velocity, `q` position, `dt` sample period, `dq = v dt`, `s(v) = tanh(v / smoothing_velocity)` a smoothed sign.
//! Every term costs the same at every step, keeps a bounded state, and reads its channels held to their trained
//! ranges (the angle of a ripple excepted: it repeats). Linear axes read metre and newton for radian and newton metre.

use serde::{Deserialize, Serialize};

use crate::table::Table;

/// Most effects of a model.
pub const MAX_EFFECTS: usize = 8;

/// Most harmonics of one ripple.
pub const MAX_HARMONICS: usize = 4;

/// What a periodic or position-dependent term adds to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Torque, whatever the direction (cogging).
    Torque,
    /// Friction: torque times `s(v)`.
    Friction,
    /// Position of the link against the motor (kinematic error).
    Position,
}

/// One line of an order spectrum: `cosine cos(order q) + sine sin(order q)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Harmonic {
    /// Periods for each radian of joint position, times 2 pi; need not be whole.
    pub order: f32,
    /// Cosine coefficient, N m (rad for [`Kind::Position`]).
    pub cosine: f32,
    /// Sine coefficient, N m (rad for [`Kind::Position`]).
    pub sine: f32,
}

/// A correction term.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Effect {
    /// `(coulomb s(v) + viscous v)`: a correction of the law's own two main parameters.
    Coulomb {
        /// N m.
        coulomb: f32,
        /// N m s/rad.
        viscous: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `amplitude exp(-(|v| / velocity)^exponent) s(v)` (Stribeck 1902; Bo & Pavelescu 1982).
    Stribeck {
        /// Static minus Coulomb torque, N m.
        amplitude: f32,
        /// Stribeck velocity, rad/s.
        velocity: f32,
        /// Shape, 0.5 to 2.
        exponent: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `coefficient |v|^exponent s(v)` (Wolf & Iskandar 2018).
    PowerViscous {
        /// N m at 1 rad/s.
        coefficient: f32,
        /// Above 0.
        exponent: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `coulomb |s(v)| + viscous |v|` (Armstrong-Helouvry 1991).
    Asymmetry {
        /// N m.
        coulomb: f32,
        /// N m s/rad.
        viscous: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `(coulomb s(v) + viscous v) (T - reference)` (Bittencourt & Gunnarsson 2012).
    Temperature {
        /// degC.
        reference: f32,
        /// N m/K.
        coulomb: f32,
        /// N m s/(rad K).
        viscous: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `(coulomb s(v) + viscous v) h` with `h += (1 - exp(-dt / time_constant)) (P - h)` and `P = |law v|`, held to
    /// `power_limit` (Simoni et al. 2015). The state starts cold, at 0.
    WarmUp {
        /// s.
        time_constant: f32,
        /// N m/W.
        coulomb: f32,
        /// N m s/(rad W).
        viscous: f32,
        /// Largest dissipated power of the training data, W.
        power_limit: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `(mean |load| s(v) + difference load |s(v)|) (1 + stribeck exp(-(v / velocity)^2)) + quadratic load^2 s(v)`.
    ///
    /// With `mean = (driving + backdriving) / 2` and `difference = (driving - backdriving) / 2` the first bracket is
    /// `driving |load| s(v)` where load and velocity have one sign and `backdriving |load| s(v)` where they have not
    /// (Hamon, Gautier & Garrec 2010).
    Load {
        /// Dimensionless.
        mean: f32,
        /// Dimensionless.
        difference: f32,
        /// 1/(N m).
        quadratic: f32,
        /// Rise of the load friction at rest, dimensionless.
        stribeck: f32,
        /// rad/s.
        velocity: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// The law and what depends on it see the lagged velocity `v_L += (1 - exp(-dt / time_constant)) (v - v_L)`
    /// (Hess & Soom 1990). Adds no torque of its own.
    FrictionalLag {
        /// s.
        time_constant: f32,
    },
    /// `z - g(v) s(v)` with `z` the LuGre bristle torque, stepped exactly:
    /// `z <- S + (z - S) exp(-|dq| stiffness / g(v))`, `S = g(v) sgn(dq)`,
    /// `g(v) = coulomb + (breakaway - coulomb) exp(-(v / velocity)^2)` (Canudas de Wit et al. 1995; Dahl 1968 where
    /// `breakaway = coulomb`). It replaces the smoothed sign of the law by the bristle.
    Presliding {
        /// N m, above 0.
        coulomb: f32,
        /// N m, at least `coulomb`.
        breakaway: f32,
        /// Stribeck velocity, rad/s.
        velocity: f32,
        /// Bristle stiffness `sigma_0`, N m/rad.
        stiffness: f32,
        /// Of the law that it corrects, rad/s.
        smoothing_velocity: f32,
    },
    /// `A exp(-x / distance) s(v)` over the distance `x` travelled since rest, `A = gain ln(1 + t_d / time)` latched from
    /// the dwell `t_d` when motion starts (Rabinowicz 1958; Dieterich 1979).
    DwellBreakaway {
        /// N m.
        gain: f32,
        /// s.
        time: f32,
        /// rad.
        distance: f32,
        /// Speed below which the joint rests, rad/s.
        rest_velocity: f32,
        /// Longest dwell that counts, s.
        dwell_limit: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// `sum of harmonics of q`, as torque, as friction or as position (Holtz & Springob 1996; Tuttle & Seering 1996).
    Ripple {
        /// What the sum adds to.
        kind: Kind,
        /// Of `s(v)` where the ripple is one of friction, rad/s.
        smoothing_velocity: f32,
        /// The lines.
        harmonics: heapless::Vec<Harmonic, MAX_HARMONICS>,
    },
    /// `b(q)`, a table in the model's pool, as torque, as friction (times `s(v)`) or as position.
    PositionTable {
        /// What the table adds to.
        kind: Kind,
        /// Of `s(v)` where the table is one of friction, rad/s.
        smoothing_velocity: f32,
        /// `b`.
        table: Table,
    },
    /// `torque (q - w) / half_width` with the play `w <- min(max(w, q - half_width), q + half_width)`; the link's
    /// position lags the motor's by `q - w` (Ruderman, Hoffmann & Bertram 2009).
    Play {
        /// Half the dead zone, rad.
        half_width: f32,
        /// Torque at either flank, N m; 0 where only the position is corrected.
        torque: f32,
    },
    /// `torque z` with `z <- S + (z - S) exp(-|dq| / distance)`, `S = sgn(dq)` (Taghirad & Belanger 1998).
    WindupHysteresis {
        /// N m.
        torque: f32,
        /// Winding distance, rad.
        distance: f32,
    },
    /// `stiffness (q - rest)`.
    Spring {
        /// N m/rad.
        stiffness: f32,
        /// rad.
        rest: f32,
    },
}

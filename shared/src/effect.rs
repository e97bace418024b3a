//! The correction terms that a diagnosis adds to a law, each with its coefficients.
//!
//! Notation: `v` velocity, `q` position, `dt` sample period, `dq` the distance of a sample, `s(v) = tanh(v / smoothing_velocity)` a
//! smoothed sign. Where the model reads the position, `dq` is its change since the sample before (0 at the first one); else it is `v dt`.
//! Every term costs the same at every step, keeps a bounded state, and reads its channels held to their trained ranges (the angle of a
//! ripple and the distance excepted). Linear axes read metre and newton for radian and newton metre.
//!
//! Arithmetic is `f32`, each operation rounded by itself, products and sums from left to right as the equations are written; functions are
//! those of [`crate::elementary`], `1 - exp(-x)` of a lag its `lag_share(x)`, `exp(-x / y)` the exponential of the negated quotient.

use serde::{Deserialize, Serialize};

use crate::table::Table;

/// Most effects of a model.
pub const MAX_EFFECTS: usize = 8;

/// Most harmonics of one ripple.
pub const MAX_HARMONICS: usize = 4;

/// Most elements of one presliding term.
pub const MAX_ELEMENTS: usize = 4;

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

/// A Maxwell slip element: a spring in series with dry friction (Al-Bender, Lampaert & Swevers 2005).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// Torque at which it slips, N m, above 0.
    pub torque: f32,
    /// Distance over which it turns over after a reversal, rad, above 0.
    pub distance: f32,
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
    /// `(coulomb s(v)) (T - reference) + (viscous v) w` (Bittencourt & Gunnarsson 2012) with `w = T - reference`, or, for a viscosity that
    /// falls exponentially as that of a grease does, `w = (1 - exp(-(decay (T - reference)))) / decay`.
    Temperature {
        /// degC.
        reference: f32,
        /// N m/K.
        coulomb: f32,
        /// N m s/(rad K), at the reference.
        viscous: f32,
        /// 1/K, 1e-4 to 10; 0 for a viscosity that falls linearly.
        decay: f32,
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
    /// `(mean + stribeck exp(-(v / velocity)^2)) |load| s(v) + difference load |s(v)| + quadratic load load s(v)`.
    ///
    /// With `mean = (driving + backdriving) / 2` and `difference = (driving - backdriving) / 2` and no `stribeck` the first two terms are
    /// `driving |load| s(v)` where load and velocity have one sign and `backdriving |load| s(v)` where they have not
    /// (Hamon, Gautier & Garrec 2010).
    Load {
        /// Dimensionless.
        mean: f32,
        /// Dimensionless.
        difference: f32,
        /// 1/(N m).
        quadratic: f32,
        /// What it is more at rest, dimensionless.
        stribeck: f32,
        /// Over which that falls, rad/s.
        velocity: f32,
        /// rad/s.
        smoothing_velocity: f32,
    },
    /// The law and what depends on it see the lagged velocity `v_L += (1 - exp(-dt / time_constant)) (v - v_L)`
    /// (Hess & Soom 1990); the first sample starts without lag. Adds no torque of its own, and is the first of a model's effects.
    FrictionalLag {
        /// s.
        time_constant: f32,
    },
    /// `sum of torque_i z_i - (sum of torque_i) s(v)` with the Maxwell slip elements, each stepped exactly over the distance of a sample:
    /// `z_i <- z_i r_i + (1 - r_i) S`, `r_i = exp(-|dq| / distance_i)`, `S` the sign of `dq` (Dahl 1968; Al-Bender, Lampaert & Swevers 2005). It replaces
    /// the smoothed sign of the law by the elements, which begin relaxed, at 0.
    Presliding {
        /// Of the law that it corrects, rad/s.
        smoothing_velocity: f32,
        /// The elements, one at least.
        elements: heapless::Vec<Element, MAX_ELEMENTS>,
    },
    /// `A exp(-x) s(v)` over the way `x <- x + |dq| / distance` travelled since rest, at most 20, `A = gain ln(1 + t_d / time)` latched from
    /// the dwell `t_d <- t_d + dt` when motion starts (Rabinowicz 1958; Dieterich 1979).
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
    /// `torque z` with `z <- z r + (1 - r) S`, `r = exp(-|dq| / distance)`, `S` the sign of `dq` (Taghirad & Belanger 1998).
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

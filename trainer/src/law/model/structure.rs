//! The grammar of friction laws: a sum of terms, each a shape over velocity times an optional factor of another channel,
//! with shared non-linear constants. A structure says *which* law, never with which numbers.

mod template;

/// How the sign of the velocity is smoothed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SignForm {
    /// `tanh(k v)`.
    Tanh,
    /// `2/π atan(k v)`.
    Arctan,
    /// `v / sqrt(v² + w²)`.
    Algebraic,
    /// `c (2 - |c|)` with `c = v/w` clipped to ±1 (Bengisu & Akay 1994); the Stribeck decline starts at `w`.
    Parabolic,
    /// `c (3 - c²)/2` with `c = v/w` clipped to ±1, the cubic envelope (Awrejcewicz, Grzelczyk & Pyryev 2008).
    Cubic,
}

/// Shape of a term over the velocity; `S` is the smoothed sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// `S`: Coulomb (1785).
    Sign,
    /// `S exp(-|v|/v_s)`: Tustin (1947).
    StribeckExponential,
    /// `S exp(-(v/v_s)²)`: Armstrong-Hélouvry (1991).
    StribeckGaussian,
    /// `S exp(-|v/v_s|^α)`: Bo & Pavelescu (1982).
    StribeckPower,
    /// `S (1 - c²)` with `c = v/v_b` clipped to ±1: static friction that ends at the breakaway velocity.
    Breakaway,
    /// `S |v|^p`.
    SignPower,
    /// `v`: viscous.
    Viscous,
    /// `v |v|`: churning, windage.
    Quadratic,
    /// `v |v|^n`, faster than linear.
    OddPower,
    /// `v / |v|^m`, slower than linear; a nano-unit keeps the divisor off zero.
    OddRoot,
    /// `|S|`: difference of the Coulomb torque between the directions.
    AbsSign,
    /// `|v|`: difference of the viscous friction between the directions.
    AbsViscous,
    /// `1`.
    Offset,
}

/// Factor of another channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Modulation {
    /// None.
    Plain,
    /// `|x|` of channel `x`.
    Magnitude(usize),
    /// `x`.
    Value(usize),
    /// `x - x_ref`, the reference being a round value inside the data.
    Difference(usize),
    /// `exp(-κ (x - x_ref))`.
    Decay(usize),
    /// `sin(n x)`.
    Sine(usize),
    /// `cos(n x)`.
    Cosine(usize),
}

/// One term with a linear coefficient of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Term {
    /// Over velocity.
    pub shape: Shape,
    /// Over another channel.
    pub modulation: Modulation,
}

/// A constant that enters non-linearly; one value serves all terms of a law that use it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Nonlinear {
    /// Slope `k` or width `w` of the smoothed sign.
    Smoothing,
    /// Stribeck velocity `v_s`.
    StribeckVelocity,
    /// Stribeck exponent `α`.
    StribeckExponent,
    /// Breakaway velocity `v_b`.
    BreakawayVelocity,
    /// Exponent `p` of `S |v|^p`, or `n` of `v |v|^n`.
    Exponent,
    /// Exponent `m` of `v / |v|^m`, below 1.
    RootExponent,
    /// Rate `κ` of a decay with a channel.
    Rate(usize),
    /// Order `n` of a ripple over a channel.
    Order(usize),
}

/// Which law: the smoothing of its sign and its terms, sorted and without repetition.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Structure {
    sign: SignForm,
    terms: Vec<Term>,
}

impl SignForm {
    /// Velocity at which the slope at zero would reach 1.
    pub fn width(self, constant: f64) -> f64 {
        match self {
            Self::Tanh => 1.0 / constant,
            Self::Arctan => std::f64::consts::FRAC_PI_2 / constant,
            Self::Algebraic => constant,
            Self::Parabolic => 0.5 * constant,
            Self::Cubic => constant / 1.5,
        }
    }

    /// The constant that gives such a width.
    pub fn from_width(self, width: f64) -> f64 {
        match self {
            Self::Tanh => 1.0 / width,
            Self::Arctan => std::f64::consts::FRAC_PI_2 / width,
            Self::Algebraic => width,
            Self::Parabolic => 2.0 * width,
            Self::Cubic => 1.5 * width,
        }
    }
}

impl Shape {
    /// Whether the smoothed sign is a factor, so that the term belongs into the bracket that it multiplies.
    pub fn has_sign(self) -> bool {
        self <= Self::SignPower
    }

    /// Whether it is a form of the Stribeck effect.
    pub fn is_stribeck(self) -> bool {
        matches!(self, Self::StribeckExponential | Self::StribeckGaussian | Self::StribeckPower | Self::Breakaway)
    }

    /// Whether it has a free exponent over the speed.
    pub fn is_power(self) -> bool {
        matches!(self, Self::SignPower | Self::OddPower | Self::OddRoot)
    }

    fn nonlinear(self) -> &'static [Nonlinear] {
        match self {
            Self::Sign | Self::AbsSign => &[Nonlinear::Smoothing],
            Self::StribeckExponential | Self::StribeckGaussian => &[Nonlinear::Smoothing, Nonlinear::StribeckVelocity],
            Self::StribeckPower => &[Nonlinear::Smoothing, Nonlinear::StribeckVelocity, Nonlinear::StribeckExponent],
            Self::Breakaway => &[Nonlinear::Smoothing, Nonlinear::BreakawayVelocity],
            Self::SignPower => &[Nonlinear::Smoothing, Nonlinear::Exponent],
            Self::OddPower => &[Nonlinear::Exponent],
            Self::OddRoot => &[Nonlinear::RootExponent],
            Self::Viscous | Self::Quadratic | Self::AbsViscous | Self::Offset => &[],
        }
    }
}

impl Modulation {
    fn nonlinear(self) -> Option<Nonlinear> {
        match self {
            Self::Decay(i) => Some(Nonlinear::Rate(i)),
            Self::Sine(i) | Self::Cosine(i) => Some(Nonlinear::Order(i)),
            Self::Plain | Self::Magnitude(_) | Self::Value(_) | Self::Difference(_) => None,
        }
    }

    /// The channel it reads.
    pub fn channel(self) -> Option<usize> {
        match self {
            Self::Plain => None,
            Self::Magnitude(i)
            | Self::Value(i)
            | Self::Difference(i)
            | Self::Decay(i)
            | Self::Sine(i)
            | Self::Cosine(i) => Some(i),
        }
    }
}

impl Term {
    /// A term of velocity alone.
    pub fn plain(shape: Shape) -> Self {
        Self { shape, modulation: Modulation::Plain }
    }

    /// The non-linear constants it uses.
    pub fn nonlinear(self) -> impl Iterator<Item = Nonlinear> {
        self.shape.nonlinear().iter().copied().chain(self.modulation.nonlinear())
    }
}

/// Where the channels of a law are and what their reference values are.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Index of the velocity.
    pub velocity: usize,
    /// Reference value of each channel (`x_ref`).
    pub references: Vec<f64>,
}

impl Structure {
    /// A structure of `terms` in any order.
    pub fn new(sign: SignForm, terms: impl IntoIterator<Item = Term>) -> Self {
        let mut terms: Vec<Term> = terms.into_iter().collect();
        terms.sort_unstable();
        terms.dedup();
        // Without a term that holds the sign there is only one structure.
        let sign =
            if terms.iter().any(|t| t.nonlinear().any(|n| n == Nonlinear::Smoothing)) { sign } else { SignForm::Tanh };
        Self { sign, terms }
    }

    /// The smoothing of the sign.
    pub fn sign(&self) -> SignForm {
        self.sign
    }

    /// Terms, sorted.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The structure with one more term.
    pub fn with(&self, term: Term) -> Self {
        Self::new(self.sign, self.terms.iter().copied().chain([term]))
    }

    /// The structure without a term.
    pub fn without(&self, term: Term) -> Self {
        Self::new(self.sign, self.terms.iter().copied().filter(|t| *t != term))
    }

    /// The structure with another smoothing.
    pub fn with_sign(&self, sign: SignForm) -> Self {
        Self::new(sign, self.terms.iter().copied())
    }

    /// Whether the term is part of it.
    pub fn has(&self, term: Term) -> bool {
        self.terms.contains(&term)
    }

    /// Number of constants that are fitted; an order is found by a scan and costs as two.
    pub fn constants(&self) -> usize {
        let nonlinear = self.nonlinear();
        let orders = nonlinear.iter().filter(|n| matches!(n, Nonlinear::Order(_))).count();
        nonlinear.len() + orders + self.terms().len()
    }

    /// Non-linear constants, sorted. They are parameters `0..`, the coefficients of the terms follow.
    pub fn nonlinear(&self) -> Vec<Nonlinear> {
        let mut all: Vec<Nonlinear> = self.terms.iter().flat_map(|t| t.nonlinear()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

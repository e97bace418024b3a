//! The engineer's names of the constants of a law, with symbols and units.

use super::data::LawData;
use super::structure::{Layout, Modulation, Nonlinear, Shape, SignForm, Structure, Term};

/// Name, symbol and unit of a constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Naming {
    /// `coulomb_torque`.
    pub name: String,
    /// `F_c`.
    pub symbol: String,
    /// `N m`.
    pub unit: String,
}

fn naming(name: impl Into<String>, symbol: impl Into<String>, unit: impl Into<String>) -> Naming {
    Naming { name: name.into(), symbol: symbol.into(), unit: unit.into() }
}

/// Names of all constants of a structure, in the order of its parameters; `values` supplies the exponents that stand in
/// units.
pub fn name_all(structure: &Structure, data: &LawData, layout: &Layout, values: &[f64]) -> Vec<Naming> {
    let names = structure.nonlinear();
    let context = Context {
        structure,
        data,
        layout,
        exponent: names
            .iter()
            .position(|n| matches!(n, Nonlinear::Exponent | Nonlinear::RootExponent))
            .map(|k| values[k]),
    };
    names.iter().map(|n| context.nonlinear(*n)).chain(structure.terms().iter().map(|t| context.term(*t))).collect()
}

struct Context<'a> {
    structure: &'a Structure,
    data: &'a LawData,
    layout: &'a Layout,
    exponent: Option<f64>,
}

impl Context<'_> {
    fn speed(&self) -> &str {
        &self.data.channels[self.layout.velocity].unit
    }

    fn kind(&self) -> &'static str {
        match self.data.target_unit.as_str() {
            "N" => "force",
            "A" => "current",
            _ => "torque",
        }
    }

    fn nonlinear(&self, constant: Nonlinear) -> Naming {
        let channel = |i: usize| &self.data.channels[i];
        match constant {
            Nonlinear::Smoothing => match self.structure.sign() {
                SignForm::Tanh | SignForm::Arctan => naming("smoothing", "k", divided("", self.speed(), 1.0)),
                SignForm::Algebraic | SignForm::Parabolic | SignForm::Cubic => {
                    naming("smoothing_velocity", "v_0", self.speed())
                }
            },
            Nonlinear::StribeckVelocity => naming("stribeck_velocity", "v_s", self.speed()),
            Nonlinear::StribeckExponent => naming("stribeck_exponent", "α", "1"),
            Nonlinear::BreakawayVelocity => naming("breakaway_velocity", "v_b", self.speed()),
            Nonlinear::Exponent => naming("velocity_exponent", "p", "1"),
            Nonlinear::RootExponent => naming("velocity_exponent", "m", "1"),
            Nonlinear::Rate(i) => naming(format!("{}_rate", channel(i).name), "κ", divided("", &channel(i).unit, 1.0)),
            Nonlinear::Order(i) => {
                naming(format!("{}_ripple_order", channel(i).name), "n", divided("", &channel(i).unit, 1.0))
            }
        }
    }

    fn term(&self, term: Term) -> Naming {
        let kind = self.kind();
        let target = self.data.target_unit.as_str();
        let over = |power: f64| divided(target, self.speed(), power);
        let plain = match term.shape {
            Shape::Sign => naming(format!("coulomb_{kind}"), "F_c", target),
            Shape::StribeckExponential | Shape::StribeckGaussian | Shape::StribeckPower => {
                naming(format!("stribeck_extra_{kind}"), "F_e", target)
            }
            Shape::Breakaway => naming(format!("static_extra_{kind}"), "F_e", target),
            Shape::SignPower => naming("viscous_power_coefficient", "F_p", over(self.exponent.unwrap_or(1.0))),
            Shape::Viscous => naming("viscous_coefficient", "F_v", over(1.0)),
            Shape::Quadratic => naming("quadratic_coefficient", "F_2", over(2.0)),
            Shape::OddPower => naming("viscous_power_coefficient", "F_p", over(1.0 + self.exponent.unwrap_or(0.0))),
            Shape::OddRoot => naming("viscous_power_coefficient", "F_p", over(1.0 - self.exponent.unwrap_or(0.0))),
            Shape::AbsSign => naming(format!("coulomb_asymmetry_{kind}"), "ΔF_c", target),
            Shape::AbsViscous => naming("viscous_asymmetry_coefficient", "ΔF_v", over(1.0)),
            Shape::Offset => naming(format!("offset_{kind}"), "F_0", target),
        };
        let channel = |i: usize| &self.data.channels[i];
        match term.modulation {
            Modulation::Plain | Modulation::Decay(_) => plain,
            Modulation::Magnitude(i) | Modulation::Value(i) | Modulation::Difference(i) => {
                let c = channel(i);
                let unit = if c.unit == plain.unit { "1".into() } else { divided(&plain.unit, &c.unit, 1.0) };
                naming(format!("{}_per_{}", plain.name, c.name), format!("{}_{}", plain.symbol, initial(&c.name)), unit)
            }
            Modulation::Sine(_) => {
                naming(format!("{}_ripple_sine", plain.name), format!("{}_sin", plain.symbol), plain.unit)
            }
            Modulation::Cosine(_) => {
                naming(format!("{}_ripple_cosine", plain.name), format!("{}_cos", plain.symbol), plain.unit)
            }
        }
    }
}

fn initial(name: &str) -> String {
    name.chars().take(1).collect()
}

/// `unit / by^power`, `by` being of the form `a` or `a/b`: `N m` over `rad/s` is `N m s/rad`.
fn divided(unit: &str, by: &str, power: f64) -> String {
    let (over, under) = by.split_once('/').unwrap_or((by, ""));
    let raised = |base: &str| -> String {
        if base.is_empty() || (power - 1.0).abs() < 1e-9 {
            base.into()
        } else if (power - 2.0).abs() < 1e-9 {
            format!("{base}²")
        } else {
            format!("{base}^{power:.3}")
        }
    };
    let numerator =
        [unit, raised(under).as_str()].iter().filter(|s| !s.is_empty()).copied().collect::<Vec<_>>().join(" ");
    format!("{}/{}", if numerator.is_empty() { "1" } else { &numerator }, raised(over))
}

#[cfg(test)]
mod tests {
    use super::divided;

    #[test]
    fn units_divide_as_they_are_read() {
        assert_eq!(divided("N m", "rad/s", 1.0), "N m s/rad");
        assert_eq!(divided("N", "m/s", 2.0), "N s²/m²");
        assert_eq!(divided("", "°C", 1.0), "1/°C");
        assert_eq!(divided("", "rad/s", 1.0), "s/rad");
    }
}

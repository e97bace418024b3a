use super::*;
use crate::law::model::canonical::canonical;
use crate::law::model::expression::Unary;

fn reference() -> Expr {
    let v = || Expr::Input(0);
    let c = |x: f64| Expr::Const(x);
    canonical(&((c(22.0) + c(8.0) * (-(v().abs() / c(0.1))).exp()) * (c(50.0) * v()).then(Unary::Tanh) + c(0.03) * v()))
}

#[test]
fn the_reference_law_reads_as_it_is_written() {
    let law = reference();
    let of = |language| render(&law, language, &["v"]);
    assert_eq!(of(Language::Unicode), "(22 + 8·exp(−|v|/0.1))·tanh(50·v) + 0.03·v");
    assert_eq!(of(Language::SymPy), "(22.0 + 8.0*exp(-Abs(v)/0.1))*tanh(50.0*v) + 0.03*v");
    assert_eq!(
        of(Language::Latex),
        "\\left(22 + 8 \\, \\exp\\left(-\\frac{\\left|v\\right|}{0.1}\\right)\\right) \\, \\tanh\\left(50 \\, v\\right) + 0.03 \\, v"
    );
}

#[test]
fn brackets_keep_the_value() {
    let v = || Expr::Input(0);
    let e = v() - (v() - (Expr::Const(2.0) + v())) / (v() * (Expr::Const(3.0) / v()));
    assert_eq!(render(&e, Language::SymPy, &["v"]), "v - (v - (2.0 + v))/(v*(3.0/v))");
}

#[test]
fn numbers_keep_the_digits_asked_for() {
    assert_eq!(significant(22.000_000_1, 6), "22");
    assert_eq!(significant(0.030_456_78, 4), "0.03046");
    assert_eq!(significant(1.5e-9, 3), "1.5e-9");
    assert_eq!(significant(123_456_789.0, 3), "1.23e8");
    assert_eq!(significant(-0.25, 6), "-0.25");
}

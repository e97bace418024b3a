//! Every notation of a law, executed and compared with the image that it was exported from.

use std::path::Path;
use std::process::Command;

use frikan_runtime::evaluate::evaluate;
use frikan_shared::model::Law;
use frikan_tests::command::run;
use frikan_tests::fixtures::folder;
use frikan_trainer::compile::program::compile_program;
use frikan_trainer::fit::{HostModel, formula_of, model};
use frikan_trainer::law::{Expr, Unary};

/// Points over the trained range of the velocity.
const POINTS: usize = 41;

/// Reads the notations for readers as Python; where SymPy is not installed, Python's own functions stand in.
const NOTATIONS: &str = r#"
import math, sys
functions = dict(exp=math.exp, tanh=math.tanh, sin=math.sin, cos=math.cos, atan=math.atan, sqrt=math.sqrt, log=math.log, Abs=abs)

def bars(text):
    out, last = [], "("
    for c in text:
        if c == "|":
            c = "Abs(" if last in "(+-*/^√n" else ")"
        if not c.isspace():
            last = c[-1]
        out.append(c)
    return "".join(out)

def unicode(text):
    text = bars(text.replace("·", "*").replace("−", "-").replace("²", "**2"))
    return text.replace("√Abs(", "sqrt_of(").replace("lnAbs(", "ln_of(").replace("^", "**")

def latex(text):
    def group(at):
        depth = 0
        for end in range(at, len(text)):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            if depth == 0:
                return text[at + 1:end], end + 1
        raise ValueError(text)

    words = {"\\ln\\left|": "ln_of(", "\\left(": "(", "\\right)": ")", "\\left|": "Abs(", "\\right|": ")", "\\,": "*", "\\cdot": "*",
             "\\arctan": "atan", "\\exp": "exp", "\\tanh": "tanh", "\\sin": "sin", "\\cos": "cos"}
    out, at = [], 0
    while at < len(text):
        if text.startswith("\\frac", at):
            (above, at), (below, at) = (first := group(at + 5)), group(first[1])
            out.append(f"(({latex(above)})/({latex(below)}))")
        elif text.startswith("\\mathrm", at):
            name, at = group(at + 7)
            out.append(name)
        elif text.startswith("\\sqrt", at):
            root, at = group(at + 5)
            out.append(f"sqrt({latex(root)})")
        elif text[at] in "^{":
            power = text[at] == "^"
            inner, at = group(at + power)
            out.append(("**" if power else "") + f"({latex(inner)})")
        else:
            word = next((w for w in words if text.startswith(w, at)), text[at])
            out.append(words.get(word, word))
            at += len(word)
    return "".join(out)

def of(kind, text):
    if kind == "python":
        space = {}
        exec(text, space)
        return space["friction"]
    if kind == "sympy":
        try:
            import sympy
            law = sympy.sympify(text)
            return lambda v: float(law.subs(sympy.Symbol("velocity"), v).evalf())
        except ImportError:
            pass
    else:
        text = dict(text=unicode, latex=latex)[kind](text)
    space = dict(functions, sqrt_of=lambda x: math.sqrt(abs(x)), ln_of=lambda x: math.log(abs(x)))
    return lambda v: eval(text, space, dict(velocity=v))

law = of(sys.argv[1], open(sys.argv[2], encoding="utf-8").read().strip())
for v in map(float, sys.argv[3:]):
    print(repr(float(law(v))))
"#;

fn succeed(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Exports the image and evaluates what comes out at `velocities`.
fn executed(at: &Path, form: &str, velocities: &[f32]) -> Vec<f64> {
    let export = run(at, &["export", "law.frk", "--to", form, "-o", form]);
    assert_eq!(export.status, 0, "{}", export.messages);
    let list = velocities.iter().map(|v| format!("{:?}", f64::from(*v))).collect::<Vec<_>>();
    let source = std::fs::read_to_string(at.join(form)).unwrap();
    let printed = match form {
        "rust" => {
            let points = list.join(", ");
            let main = format!(
                "{source}\nfn main() {{\n    for v in [{points}] {{\n        println!(\"{{:?}}\", friction(v));\n    }}\n}}\n"
            );
            std::fs::write(at.join("law.rs"), main).unwrap();
            succeed(Command::new("rustc").current_dir(at).args(["--edition", "2024", "-o", "law-rust", "law.rs"]));
            succeed(&mut Command::new(at.join("law-rust")))
        }
        notation => {
            std::fs::write(at.join("notations.py"), NOTATIONS).unwrap();
            succeed(Command::new("python3").current_dir(at).args(["notations.py", notation, form]).args(&list))
        }
    };
    printed.lines().map(|line| line.parse().unwrap()).collect()
}

/// The law as a drive evaluates it, and code that is exported: nothing at rest.
fn of_the_drive(law: &HostModel, velocity: f32) -> f64 {
    if velocity == 0.0 { 0.0 } else { f64::from(evaluate(law, &[velocity, 0.0, 0.0, 0.0])) }
}

/// Every notation that this machine can execute gives what the image gives, to the digits that it prints.
fn agree(law: &HostModel, bytes: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("law.frk"), bytes).unwrap();
    let (low, high) = (law.inputs[0].low, law.inputs[0].high);
    let over = |low: f32, high: f32| -> Vec<f32> {
        (0..POINTS).map(|i| low + (high - low) * i as f32 / (POINTS - 1) as f32).collect()
    };
    // Code holds the value at the nearer end of the trained range, as the drive does; a formula says nothing of ranges.
    let (within, beyond) = (over(low, high), over(2.0 * low, 2.0 * high));
    let expected = |velocities: &[f32], is_code: bool| -> Vec<f64> {
        let value =
            |v: &f32| if is_code { of_the_drive(law, *v) } else { f64::from(evaluate(law, &[*v, 0.0, 0.0, 0.0])) };
        velocities.iter().map(value).collect()
    };
    let python = Command::new("python3").arg("--version").output().is_ok();
    let forms = ["rust", "python", "sympy", "latex", "text"];
    for form in forms.into_iter().filter(|form| python || *form == "rust") {
        let is_code = ["rust", "python"].contains(&form);
        let velocities = if is_code { &beyond } else { &within };
        let expected = expected(velocities, is_code);
        let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let got = executed(folder.path(), form, velocities);
        assert_eq!(got.len(), expected.len(), "{form}");
        let worst = got.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{form}: largest difference {worst:.1e} of {largest:.3}");
        assert!(worst < 2e-5 * largest, "{form}: {worst}");
    }
    assert!(python || std::env::var_os("CI").is_none(), "python3 executes four of the notations");
}

#[test]
fn a_fitted_law_is_the_same_in_every_language() {
    let (bytes, image) = model::load(&folder().join("elbow.frk")).unwrap();
    assert!(matches!(image.model.law, Law::Expression(_)));
    agree(&image.model, &bytes);
}

#[test]
fn every_function_and_bracket_is_the_same_in_every_language() {
    let v = || Expr::Input(0);
    let c = Expr::Const;
    let law = (c(2.5) - (-(v() / c(0.7)).then(Unary::Square)).exp()) * (c(9.0) * v()).then(Unary::Tanh)
        - (v() - c(0.3)).then(Unary::Sin) / (c(1.5) + v().then(Unary::Square))
        + (c(2.0) * v()).then(Unary::Cos) * (v() - (v() - c(0.25))).then(Unary::Atan)
        + (v() - c(0.2)).pow(c(1.5))
        + (v() + c(0.1)).then(Unary::Sqrt)
        - (v() - c(8.0)).then(Unary::Log)
        - v() * (v().abs() - (v() + c(1.0)).abs()).abs();
    let (_, mut image) = model::load(&folder().join("elbow.frk")).unwrap();
    image.model.law = Law::Expression(compile_program(&formula_of(&law), 1).unwrap());
    agree(&image.model, &model::to_bytes(&image).unwrap());
}

/// A table has a form in code: the bits of the drive in Rust, its value but for rounding in Python, held at the ends of its range; NaN gives 0.
#[test]
fn a_table_is_the_same_in_code() {
    let (bytes, image) = model::load(&folder().join("stribeck.frk")).unwrap();
    assert!(!matches!(image.model.law, Law::Expression(_)));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("law.frk"), bytes).unwrap();
    let velocities: Vec<f32> = (-200..=200).map(|i| 0.013 * i as f32).chain([1.0e30, -1.0e30]).collect();
    for form in ["rust", "python"] {
        let got = executed(folder.path(), form, &velocities);
        for (v, got) in velocities.iter().zip(got) {
            let expected = of_the_drive(&image.model, *v);
            assert!((got - expected).abs() < 2e-6 * expected.abs().max(1.0), "{form} at {v}: {got} for {expected}");
        }
    }
    let python = std::fs::read_to_string(folder.path().join("python")).unwrap() + "\nprint(friction(math.nan))\n";
    std::fs::write(folder.path().join("nan.py"), python).unwrap();
    assert_eq!(succeed(Command::new("python3").current_dir(folder.path()).arg("nan.py")).trim(), "0.0");
}

#[test]
fn a_table_has_no_formula() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(frikan_tests::fixtures::folder().join("stribeck.frk"), folder.path().join("law.frk")).unwrap();
    let export = run(folder.path(), &["export", "law.frk", "--to", "latex", "-o", "law.tex"]);
    assert_eq!(export.status, 2);
    assert!(export.messages.contains("--representation expression"), "{}", export.messages);
    assert!(!folder.path().join("law.tex").exists());
}

/// What the page of the drive says: beside separated friction a prediction leaves the rigid body off, so that exported source can be compared with it.
#[test]
fn a_prediction_of_separated_friction_is_the_law_alone() {
    let (bytes, image) = model::load(&folder().join("elbow.frk")).unwrap();
    assert!(image.model.rigid_body.inertia > 0.0);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("law.frk"), bytes).unwrap();
    let velocities: Vec<f32> = (-60..=60).map(|i| 0.02 * i as f32).collect();
    let rows: String = velocities.iter().map(|v| format!("{v},0\n")).collect();
    std::fs::write(folder.path().join("v.csv"), format!("velocity_rad_s,friction_torque_Nm\n{rows}")).unwrap();
    let done = run(folder.path(), &["predict", "law.frk", "v.csv", "-o", "out.csv"]);
    assert_eq!(done.status, 0, "{}", done.messages);
    let text = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|name| *name == "predicted_friction_torque_Nm").unwrap();
    let predicted: Vec<f64> = lines.map(|cells| cells[place].parse().unwrap()).collect();
    assert_eq!(predicted.len(), velocities.len());
    for (v, predicted) in velocities.iter().zip(predicted) {
        let expected = f64::from(evaluate(&image.model, &[*v, 0.0, 0.0, 0.0]));
        assert!((predicted - expected).abs() < 1e-5, "{predicted} for {expected} at {v}");
    }
}

//! A USD layer over one joint, with the per-axis attributes of PhysX 5.6 (`PhysxJointAxisAPI`): static and dynamic friction, viscous
//! friction and armature. The user's stage stays untouched: the layer takes it as a sublayer.

use std::fmt::Write;

use super::content::Content;
use super::model_file::ModelFile;
use crate::error::{Error, Result, codes};
use crate::figures::digits;

/// The layer. `--joint-name` is the path of the joint's prim in the stage.
///
/// # Errors
/// `FRK-D030` where a stage that is text has no such prim, or bodies are heavier than was identified.
pub(super) fn layer(content: &Content, file: Option<&ModelFile>) -> Result<String> {
    let path = file.map_or(if content.joint.is_empty() { "joint" } else { content.joint }, |file| file.joint);
    let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
    if names.is_empty() {
        return Err(Error::new(&codes::BAD_MODEL_FILE, "`--joint-name` is empty: it has to be the path of a prim"));
    }
    let checked = match file {
        Some(file) => check_prim(file, &names)?,
        None => "",
    };
    let (form, static_friction) = (content.coulomb_viscous, content.static_friction());
    let (axis, per_unit) = if content.is_linear { ("linear", 1.0) } else { ("angular", 1f64.to_radians()) };
    let mut remark = content.remark(&form, |_| false) + checked + " PhysX was not run with this layer.";
    let bodies = file.and_then(|file| file.inertia_of_model);
    let armature = bodies.map(|bodies| content.armature(bodies)).transpose()?.flatten();
    if let (Some(inertia), None) = (content.inertia(), armature) {
        let _ = write!(
            remark,
            " Identified inertia {}, link and rotor: what of it the bodies lack is the armature, for which `--inertia-of-model` is needed.",
            digits(inertia)
        );
    }
    content.gravity().iter().for_each(|gravity| remark = format!("{remark} {gravity}"));
    let mut attributes = vec![
        ("staticFrictionEffort", static_friction),
        ("dynamicFrictionEffort", form.coulomb),
        // Stored for each degree of a turning joint; PhysX takes it for each radian.
        ("viscousFrictionCoefficient", form.damping[0] * per_unit),
    ];
    attributes.extend(armature.map(|armature| ("armature", armature)));
    let mut text = "#usda 1.0\n(\n".to_owned();
    let _ = writeln!(text, "    doc = \"{}\"", remark.replace('\\', "/").replace('"', "'"));
    if let Some(file) = file {
        let _ = writeln!(text, "    subLayers = [\n        @{}@\n    ]", file.path);
    }
    text += ")\n\n";
    for (depth, name) in names.iter().enumerate() {
        let indentation = "    ".repeat(depth);
        let is_joint = depth + 1 == names.len();
        let schema =
            format!(" (\n{indentation}    prepend apiSchemas = [\"PhysxJointAxisAPI:{axis}\"]\n{indentation})");
        let _ = writeln!(text, "{indentation}over \"{name}\"{}\n{indentation}{{", if is_joint { &schema } else { "" });
    }
    let indentation = "    ".repeat(names.len());
    for (name, value) in attributes {
        let _ = writeln!(text, "{indentation}float physxJointAxis:{axis}:{name} = {}", value as f32);
    }
    for depth in (0..names.len()).rev() {
        let _ = writeln!(text, "{}}}", "    ".repeat(depth));
    }
    Ok(text)
}

/// Whether a stage has a prim, as far as it says so itself: what is to be told where it does not.
fn check_prim(file: &ModelFile, names: &[&str]) -> Result<&'static str> {
    if !file.text.starts_with("#usda") {
        return Ok(" The stage is no text: whether it has this prim was not checked.");
    }
    let prims = prims(file.text);
    let path = format!("/{}", names.join("/"));
    if prims.contains(&path) {
        return Ok("");
    }
    if ["references", "payload", "subLayers", "inherits", "specializes"].iter().any(|word| file.text.contains(word)) {
        return Ok(" The stage refers to others: whether they have this prim was not checked.");
    }
    let message = format!("`--joint-name` has to be the path of a prim of this stage: {}", prims.join(", "));
    Err(Error::new(&codes::BAD_MODEL_FILE, message).with_value(path))
}

/// The paths of the prims that a text layer names.
fn prims(text: &str) -> Vec<String> {
    let (mut found, mut open, mut next, mut is_prim) = (Vec::new(), Vec::new(), None, false);
    let (mut parentheses, mut rest) = (0, text);
    while let Some(first) = rest.chars().next() {
        let mut length = first.len_utf8();
        match first {
            '#' => length = rest.find('\n').unwrap_or(rest.len()),
            '"' | '@' | '\'' => {
                let mark = [first; 3].iter().collect::<String>();
                let mark = if rest.starts_with(&mark) { mark } else { first.to_string() };
                let inner = &rest[mark.len()..];
                let end = inner.find(&mark).unwrap_or(inner.len());
                if is_prim && parentheses == 0 {
                    (next, is_prim) = (Some(&inner[..end]), false);
                }
                length = (2 * mark.len() + end).min(rest.len());
            }
            '(' => parentheses += 1,
            ')' => parentheses -= 1,
            '{' if parentheses == 0 => {
                open.push(next);
                if next.take().is_some() {
                    found.push(open.iter().flatten().fold(String::new(), |path, name| path + "/" + name));
                }
            }
            '}' if parentheses == 0 => drop(open.pop()),
            letter if letter.is_alphabetic() => {
                length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
                is_prim |= ["def", "over", "class"].contains(&&rest[..length]);
            }
            _ => {}
        }
        rest = &rest[length..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_prims_of_a_stage_are_read_from_its_text() {
        let stage = "#usda 1.0\n(\n doc = \"def \\\"x\\\"\"\n)\n# def \"no\"\ndef Xform \"robot\" (\n customData = { string a = \"b\" }\n)\n{\n  def PhysicsRevoluteJoint \"elbow\"\n  {\n    float x = 1\n  }\n  over \"wrist\" {}\n}\n";
        assert_eq!(prims(stage), ["/robot", "/robot/elbow", "/robot/wrist"]);
        let file = |text| ModelFile { text, path: "s", joint: "", inertia_of_model: None, gains: None };
        assert_eq!(check_prim(&file(stage), &["robot", "elbow"]).unwrap(), "");
        let error = check_prim(&file(stage), &["robot", "elbw"]).unwrap_err();
        assert!(error.code().id == "FRK-D030" && error.message().contains("/robot/elbow"), "{error}");
        assert!(check_prim(&file("PXR-USDC"), &["robot"]).unwrap().contains("not checked"));
    }
}

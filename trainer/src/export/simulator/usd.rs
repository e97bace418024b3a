//! A USD layer over one joint, with the per-axis attributes of PhysX 5.6 (`PhysxJointAxisAPI`): static and dynamic friction, viscous
//! friction and armature. The user's stage stays untouched: the layer takes it as a sublayer.

use std::fmt::Write;

use super::content::Content;
use super::model_file::ModelFile;
use crate::figures::digits;

/// The layer. `--joint-name` is the path of the joint's prim in the stage.
pub(super) fn layer(content: &Content, file: Option<&ModelFile>) -> String {
    let path = file.map_or(if content.joint.is_empty() { "joint" } else { content.joint }, |file| file.joint);
    let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
    let (form, static_friction) = (content.coulomb_viscous, content.static_friction());
    let (axis, per_unit) = if content.is_linear { ("linear", 1.0) } else { ("angular", 1f64.to_radians()) };
    let mut remark = content.remark(&form, |_| false);
    let bodies = file.and_then(|file| file.inertia_of_model);
    let armature = bodies.and_then(|bodies| content.armature(bodies)).map(|armature| armature.max(0.0));
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
    text
}

//! The rigid body in force: what `joint.toml` gives and what was identified along with friction.

use frikan_shared::model::RigidBody;

use super::gather::{MOST_ATTENUATION, Material, RigidColumn};
use crate::joint::Joint;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::NORMAL_95;
use crate::parameter::Parameter;
use crate::recording::Axis;
use crate::samples::rigid_body::TermKind;

/// A column of which the others and friction leave less than this share of its square cannot be told from them.
const COLLINEAR_SHARE: f64 = 1e-4;

/// The rigid body for an image from one coefficient for each column of the material.
pub(in crate::fit) fn in_force(material: &Material, joint: &Joint, coefficients: &[f64]) -> RigidBody {
    let Some(separation) = &material.separation else { return RigidBody::default() };
    let per_newton_metre = joint.actuator_per_torque(material.samples.actuator_unit).unwrap_or(1.0);
    let mut body = [0.0; 5];
    let [inertia, gravity_sin, gravity_cos, offset, given_scale] = &mut body;
    *inertia = per_newton_metre * joint.rigid_body.inertia_kgm2.unwrap_or(0.0);
    if let Some(gravity) = joint.rigid_body.gravity_torque_nm {
        let phase = joint.rigid_body.gravity_phase_rad.unwrap_or(0.0);
        *gravity_sin = per_newton_metre * gravity * phase.cos();
        *gravity_cos = per_newton_metre * gravity * phase.sin();
    }
    if joint.rigid_body.recorded_is_exact && material.samples.rigid_body.is_some() {
        *given_scale = 1.0;
    }
    for (term, coefficient) in separation.terms.iter().zip(coefficients) {
        match term.kind {
            TermKind::Inertia | TermKind::ExtraInertia => *inertia += coefficient,
            TermKind::GravitySine => *gravity_sin += coefficient,
            TermKind::GravityCosine => *gravity_cos += coefficient,
            TermKind::TorqueScale => *given_scale += coefficient,
            TermKind::TorqueOffset => *offset += coefficient,
        }
    }
    let [inertia, gravity_sin, gravity_cos, offset, given_scale] = body.map(|x| x as f32);
    RigidBody { inertia, gravity_sin, gravity_cos, offset, given_scale }
}

/// Coefficients with standard errors as named parameters, one for each column.
pub(in crate::fit) fn parameters(material: &Material, coefficients: &[(f64, f64)]) -> Vec<Parameter> {
    let named = material.columns.iter().zip(coefficients);
    let attenuation = attenuation(material);
    named
        .map(|(column, &(value, standard_error))| {
            let (name, symbol) = names(column.kind, material.samples.axis);
            Parameter {
                name: name.to_owned(),
                symbol: symbol.to_owned(),
                value,
                unit: unit(column.kind, material.samples.axis, material.samples.actuator_unit),
                ci95: interval(value, standard_error, if column.kind.is_inertia() { attenuation } else { 0.0 }),
            }
        })
        .collect()
}

/// 95 % interval of a coefficient of which the noise of its column may have taken this share.
fn interval(value: f64, standard_error: f64, attenuation: f64) -> [f64; 2] {
    let whole = value / (1.0 - attenuation.min(MOST_ATTENUATION));
    [value.min(whole) - NORMAL_95 * standard_error, value.max(whole) + NORMAL_95 * standard_error]
}

/// Share of the inertia that the noise of the acceleration takes at most: its power over that of the acceleration which the other
/// columns, velocity and its sign do not hold (errors in variables; Fuller 1987). Zero where no inertia is identified.
pub(in crate::fit) fn attenuation(material: &Material) -> f64 {
    let Some(index) = material.columns.iter().position(|column| column.kind.is_inertia()) else { return 0.0 };
    let own = left_by_others(material, index);
    let power = own.iter().map(|x| x * x).sum::<f64>() / own.len().max(1) as f64;
    if power > 0.0 { (material.acceleration_noise.powi(2) / power).min(1.0) } else { 0.0 }
}

/// Columns of the constants beside one of the rigid body, with what these are called: its others by their names, Coulomb and viscous friction,
/// whose names have the actuator's quantity, by their symbols.
pub(in crate::fit) fn beside(material: &Material, index: Option<usize>) -> (Vec<&'static str>, Vec<Vec<f64>>) {
    let velocity = material.pick(material.samples.velocity.as_deref().unwrap_or_default());
    let sign = velocity.iter().map(|v| v.signum()).collect();
    let others = material.columns.iter().enumerate().filter(|(other, _)| Some(*other) != index);
    let named = |column: &RigidColumn| (name(material, column), material.pick(&column.values));
    let others = others.map(|(_, column)| named(column));
    others.chain([("F_c", sign), ("F_v", velocity)]).unzip()
}

/// Name of the constant of a column.
pub(in crate::fit) fn name(material: &Material, column: &RigidColumn) -> &'static str {
    names(column.kind, material.samples.axis).0
}

/// What the other columns, velocity and its sign leave of a column.
fn left_by_others(material: &Material, index: usize) -> Vec<f64> {
    let (_, others) = beside(material, Some(index));
    let whole: Vec<_> = std::iter::once(0..material.rows.len()).collect();
    least_squares(&others, &material.pick(&material.columns[index].values), &whole).residuals
}

/// Whether this is the name of the coefficient that is the whole inertia, which no joint has negative; what is added to that
/// of a recorded rigid-body torque may be.
pub(in crate::fit) fn is_inertia(name: &str) -> bool {
    name == TermKind::Inertia.name()
}

/// Name and symbol of a constant.
fn names(kind: TermKind, axis: Axis) -> (&'static str, &'static str) {
    match (kind, axis) {
        (TermKind::Inertia, Axis::Rotary) => ("inertia", "J"),
        (TermKind::Inertia, Axis::Linear) => ("mass", "M"),
        (TermKind::ExtraInertia, Axis::Rotary) => ("extra_inertia", "ΔJ"),
        (TermKind::ExtraInertia, Axis::Linear) => ("extra_mass", "ΔM"),
        (TermKind::GravitySine, _) => ("gravity_sine", "G_s"),
        (TermKind::GravityCosine, _) => ("gravity_cosine", "G_c"),
        (TermKind::TorqueScale, _) => ("torque_scale", "k"),
        (TermKind::TorqueOffset, _) => ("torque_offset", "τ_0"),
    }
}

/// Unit of a coefficient as printed.
pub(in crate::fit) fn unit(kind: TermKind, axis: Axis, actuator: &str) -> String {
    match (kind, axis, actuator) {
        (TermKind::TorqueScale, _, _) => "1".to_owned(),
        (TermKind::Inertia | TermKind::ExtraInertia, Axis::Rotary, "Nm") => "kg m²".to_owned(),
        (TermKind::Inertia | TermKind::ExtraInertia, Axis::Linear, "N") => "kg".to_owned(),
        (TermKind::Inertia | TermKind::ExtraInertia, Axis::Rotary, _) => format!("{} s²/rad", printed(actuator)),
        (TermKind::Inertia | TermKind::ExtraInertia, Axis::Linear, _) => format!("{} s²/m", printed(actuator)),
        _ => printed(actuator).to_owned(),
    }
}

/// The unit of an actuator as printed.
pub(in crate::fit) fn printed(suffix: &str) -> &'static str {
    match suffix {
        "N" => "N",
        "A" => "A",
        _ => "N m",
    }
}

/// Name of the first column that the others, velocity and its sign hold almost entirely.
pub(in crate::fit) fn collinear(material: &Material) -> Option<String> {
    let separation = material.separation.as_ref()?;
    let left_of = |index: usize| {
        let power: f64 = material.pick(&material.columns[index].values).iter().map(|x| x * x).sum();
        left_by_others(material, index).iter().map(|x| x * x).sum::<f64>() / power.max(f64::MIN_POSITIVE)
    };
    let lost = (0..material.columns.len()).find(|&index| left_of(index) < COLLINEAR_SHARE);
    lost.map(|index| name(material, &material.columns[index]).to_owned())
        .or_else(|| (separation.rank_deficiency > 0).then(|| "a parameter of the rigid body".to_owned()))
}

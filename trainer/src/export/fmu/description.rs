//! `modelDescription.xml` of FMI 3.0.2, section 2.4.

use std::fmt::Write;

use frikan_shared::model::Model;
use frikan_shared::units::Unit;

use crate::fit::CELLS;
use crate::markup::escape;

/// How the sources are compiled (FMI 3.0.2, section 2.5.1).
pub(super) fn build<'a>(identifier: &str, sources: impl Iterator<Item = &'a str>) -> String {
    let files: String = sources.map(|name| format!("      <SourceFile name=\"{name}\"/>\n")).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n  \
         <BuildConfiguration modelIdentifier=\"{identifier}\">\n    <SourceFileSet language=\"C99\">\n{files}    </SourceFileSet>\n  \
         </BuildConfiguration>\n</fmiBuildDescription>\n"
    )
}

/// Value references: those of `fmi3.c`.
const FRICTION: usize = 1;
const POSITION_CORRECTION: usize = 2;
const FIRST_INPUT: usize = 3;

/// What the document says.
pub(super) struct Description<'a> {
    pub(super) identifier: &'a str,
    pub(super) title: &'a str,
    pub(super) token: &'a str,
    pub(super) model: &'a Model<CELLS>,
    /// Names of the inputs.
    pub(super) names: &'a [String],
    pub(super) moves_link: bool,
}

impl Description<'_> {
    pub(super) fn xml(&self) -> String {
        let Self { identifier, title, token, model, names, moves_link } = self;
        let title = escape(title);
        let is_linear = model.inputs.iter().any(|input| matches!(input.unit, Unit::MetrePerSecond | Unit::Metre));
        let position_unit = if is_linear { Unit::Metre } else { Unit::Radian };
        let mut units = vec![model.output_unit, position_unit];
        units.extend(model.inputs.iter().map(|input| input.unit));
        units.sort_unstable_by_key(|unit| unit.symbol());
        units.dedup();
        let mut xml = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{identifier}\" \
             instantiationToken=\"{token}\" description=\"{title}\" generationTool=\"Frikan\" variableNamingConvention=\"flat\">\n  \
             <CoSimulation modelIdentifier=\"{identifier}\" canHandleVariableCommunicationStepSize=\"true\" \
             canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"/>\n  <UnitDefinitions>\n"
        );
        // Writing to a string cannot fail.
        for unit in &units {
            let _ = writeln!(xml, "    <Unit name=\"{}\"><BaseUnit{}/></Unit>", unit.symbol(), base(*unit));
        }
        xml += "  </UnitDefinitions>\n  <ModelVariables>\n    <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" \
                variability=\"continuous\"/>\n";
        let mut output = |name: &str, reference: usize, what: &str, unit: Unit| {
            let _ = writeln!(
                xml,
                "    <Float64 name=\"{name}\" valueReference=\"{reference}\" causality=\"output\" initial=\"calculated\" \
                 description=\"{what}\" unit=\"{}\"/>",
                unit.symbol()
            );
        };
        let what = "Friction in the sign of the velocity: the joint feels it with the other sign";
        output("friction", FRICTION, what, model.output_unit);
        if *moves_link {
            let what = "What the effects add to the position of the link";
            output("position_correction", POSITION_CORRECTION, what, position_unit);
        }
        for (place, (input, name)) in model.inputs.iter().zip(*names).enumerate() {
            let _ = writeln!(
                xml,
                "    <Float64 name=\"{}\" valueReference=\"{}\" causality=\"input\" description=\"Trained from {:?} to {:?}, held at the \
                 nearer end outside\" unit=\"{}\" start=\"0\"/>",
                escape(name),
                FIRST_INPUT + place,
                input.low,
                input.high,
                input.unit.symbol()
            );
        }
        let inputs: Vec<String> = (0..names.len()).map(|place| (FIRST_INPUT + place).to_string()).collect();
        let dependencies = format!("dependencies=\"{}\"", inputs.join(" "));
        xml += "  </ModelVariables>\n  <ModelStructure>\n";
        let outputs = [FRICTION, POSITION_CORRECTION];
        let outputs = &outputs[..1 + usize::from(*moves_link)];
        for element in ["Output", "InitialUnknown"] {
            for reference in outputs {
                let _ = writeln!(xml, "    <{element} valueReference=\"{reference}\" {dependencies}/>");
            }
        }
        xml + "  </ModelStructure>\n</fmiModelDescription>\n"
    }
}

/// A unit by the exponents of its base units.
fn base(unit: Unit) -> &'static str {
    match unit {
        Unit::One => "",
        Unit::Radian => " rad=\"1\"",
        Unit::RadianPerSecond => " rad=\"1\" s=\"-1\"",
        Unit::RadianPerSecondSquared => " rad=\"1\" s=\"-2\"",
        Unit::Metre => " m=\"1\"",
        Unit::MetrePerSecond => " m=\"1\" s=\"-1\"",
        Unit::MetrePerSecondSquared => " m=\"1\" s=\"-2\"",
        Unit::NewtonMetre => " kg=\"1\" m=\"2\" s=\"-2\"",
        Unit::Newton => " kg=\"1\" m=\"1\" s=\"-2\"",
        Unit::Ampere => " A=\"1\"",
        Unit::Celsius => " K=\"1\" offset=\"273.15\"",
        Unit::Volt => " kg=\"1\" m=\"2\" s=\"-3\" A=\"-1\"",
    }
}

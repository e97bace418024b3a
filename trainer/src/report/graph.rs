//! The network as a graph: inputs below, the output above, edges as dark as their attribution.

use crate::kan::{GraphSummary, NodeKind};
use crate::markup::escape;
use std::fmt::Write;

const WIDTH: f64 = 520.0;
const ROW: f64 = 110.0;
const MARGIN: f64 = 34.0;

/// Picture of a network; pruned nodes and edges are left out.
pub(super) fn network(graph: &GraphSummary, inputs: &[String]) -> String {
    let layers = graph.nodes.iter().map(|node| node.layer).max().unwrap_or(0);
    let height = ROW * layers as f64 + 2.0 * MARGIN;
    let count = |layer: usize| graph.nodes.iter().filter(|node| node.layer == layer).count().max(1);
    let place = |layer: usize, index: usize| {
        let x = WIDTH * (index as f64 + 0.5) / count(layer) as f64;
        (x, height - MARGIN - ROW * layer as f64)
    };
    let strongest = graph.edges.iter().map(|edge| edge.score).fold(f64::MIN_POSITIVE, f64::max);
    let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\">");
    for edge in graph.edges.iter().filter(|edge| edge.active) {
        let ((x1, y1), (x2, y2)) = (place(edge.layer, edge.from), place(edge.layer + 1, edge.to));
        let depth = 0.06 + 0.94 * (edge.score / strongest).clamp(0.0, 1.0);
        // An activation that follows a function of the library is of another colour and says which.
        let (class, function) = match &edge.symbolic {
            Some(function) => ("s-two", format!(", {function}")),
            None => ("s-one", String::new()),
        };
        let _ = write!(
            svg,
            "<path class=\"{class}\" fill=\"none\" stroke-width=\"2.5\" stroke-opacity=\"{depth:.2}\" d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\"><title>attribution {:.4}{}</title></path>",
            edge.score,
            escape(&function)
        );
    }
    for node in graph.nodes.iter().filter(|node| node.active) {
        let (x, y) = place(node.layer, node.index);
        let _ =
            write!(svg, "<circle class=\"f-paper s-ink\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\" stroke-width=\"1.5\"/>");
        let sign = if node.kind == NodeKind::Product { "\u{d7}" } else { "+" };
        if node.layer > 0 {
            let _ = write!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{sign}</text>", y + 4.0);
        } else if let Some(name) = inputs.get(node.index) {
            let _ =
                write!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>", y + 25.0, escape(name));
        }
        if node.layer == layers {
            let _ = write!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">friction</text>", y - 15.0);
        }
    }
    svg.push_str("</svg>");
    svg
}

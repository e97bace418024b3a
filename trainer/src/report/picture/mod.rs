//! Pictures by themselves: SVG files for documents, with the colours of the pages.

mod axis;
mod chart;

use super::graph;
use crate::kan::GraphSummary;
pub(super) use axis::Scale;
use chart::Chart;

pub use super::ink::Ink;

/// Size of a chart, pixels.
const SIZE: (f64, f64) = (520.0, 340.0);

/// What is drawn.
#[derive(Clone, Debug)]
pub enum Mark {
    /// A line through points.
    Line(Vec<[f64; 2]>),
    /// Dots at points.
    Dots(Vec<[f64; 2]>),
    /// The area between two curves: `[x, low, high]`.
    Area(Vec<[f64; 3]>),
}

/// Something drawn, in its colour, with its name in the legend unless that is empty.
#[derive(Clone, Debug)]
pub struct Series {
    /// What.
    pub mark: Mark,
    /// Colour.
    pub ink: Ink,
    /// Name.
    pub label: String,
}

/// A chart with axes that hold all of the series; `labels` name the horizontal and the vertical axis.
#[must_use]
pub fn curves(labels: [&str; 2], series: &[Series]) -> String {
    let corners: Vec<[f64; 2]> = series
        .iter()
        .flat_map(|series| match &series.mark {
            Mark::Line(points) | Mark::Dots(points) => points.clone(),
            Mark::Area(points) => points.iter().flat_map(|[x, low, high]| [[*x, *low], [*x, *high]]).collect(),
        })
        .collect();
    let over = |axis: usize| Scale::over(corners.iter().map(|corner| corner[axis]));
    let mut chart = Chart::new(SIZE, over(0), over(1), labels);
    for Series { mark, ink, label } in series {
        match mark {
            Mark::Line(points) => chart.line(points, *ink, label),
            Mark::Dots(points) => chart.dots(points, *ink, label),
            Mark::Area(points) => chart.area(points, *ink, label),
        }
    }
    standing_alone(&chart.svg())
}

/// Horizontal bars: name, value, whether it stands out.
#[must_use]
pub fn bars(rows: &[(String, f64, bool)], unit: &str) -> String {
    standing_alone(&chart::bars(rows, unit))
}

/// The graph of a network: edges as dark as their attribution, those that follow a function in another colour.
#[must_use]
pub fn network(graph: &GraphSummary, inputs: &[String]) -> String {
    standing_alone(&graph::network(graph, inputs))
}

/// A picture of a page as a file of its own.
fn standing_alone(svg: &str) -> String {
    let drawn = [":root", "svg", ".grid", ".frame", ".line", ".s-", ".f-"];
    let style: String = include_str!("../page/style.css")
        .lines()
        .filter(|line| drawn.iter().any(|start| line.starts_with(start)) && !line.starts_with("svg{"))
        .collect();
    let head = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {}", svg.trim_start_matches("<svg "));
    let (opening, rest) = head.split_once('>').unwrap_or((&head, ""));
    format!("{opening}><style>{style}</style><rect class=\"f-paper\" width=\"100%\" height=\"100%\"/>{rest}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_one_whole_svg_with_all_that_was_drawn() {
        let line = Series { mark: Mark::Line(vec![[0.0, 1.0], [2.0, 3.0]]), ink: Ink::One, label: "law".into() };
        let area =
            Series { mark: Mark::Area(vec![[0.0, 0.0, 2.0], [2.0, 2.0, 4.0]]), ink: Ink::Two, label: String::new() };
        let svg = curves(["v", "torque"], &[area, line]);
        let parsed = roxmltree::Document::parse(&svg).unwrap();
        let names = |name: &str| {
            parsed.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", name))).count()
        };
        assert_eq!((names("svg"), names("style")), (1, 1));
        assert!(svg.contains("s-one") && svg.contains("f-two") && svg.contains("law") && svg.contains("torque"));
    }
}

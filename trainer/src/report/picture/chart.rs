//! Charts over two axes, and bars: inline SVG with colours left to the page.

use super::axis::Scale;
use crate::figures::digits;
use crate::markup::escape;
use crate::report::ink::Ink;
use std::fmt::Write;

/// Largest number of dots; more would only be slower to draw.
const MOST_DOTS: usize = 2500;
/// Pairs of extremes that a line is thinned to.
const MOST_COLUMNS: usize = 700;
const LEFT: f64 = 62.0;
const BOTTOM: f64 = 46.0;
const TOP: f64 = 26.0;
const RIGHT: f64 = 12.0;

/// A chart under construction.
pub(super) struct Chart {
    width: f64,
    height: f64,
    x: Scale,
    y: Scale,
    labels: [String; 2],
    body: String,
    legend: Vec<(Ink, String)>,
}

impl Chart {
    /// An empty chart of `width` by `height` pixels over the given ranges.
    pub(super) fn new(size: (f64, f64), x: (f64, f64), y: (f64, f64), labels: [&str; 2]) -> Self {
        let (width, height) = size;
        Self {
            width,
            height,
            x: Scale::new(x, LEFT, width - RIGHT),
            y: Scale::new(y, height - BOTTOM, TOP),
            labels: labels.map(str::to_string),
            body: String::new(),
            legend: Vec::new(),
        }
    }

    /// A line through points; long ones are thinned to the extremes of each pixel column. NaN breaks it.
    pub(super) fn line(&mut self, points: &[[f64; 2]], ink: Ink, label: &str) {
        let mut path = String::new();
        let mut pen_down = false;
        for [x, y] in thinned(points) {
            if !(x.is_finite() && y.is_finite()) {
                pen_down = false;
                continue;
            }
            let command = if pen_down { 'L' } else { 'M' };
            let _ = write!(path, "{command}{:.1} {:.1}", self.x.at(x), self.y.at(y));
            pen_down = true;
        }
        let _ = write!(self.body, "<path class=\"line s-{}\" d=\"{path}\"/>", ink.name());
        self.mention(ink, label);
    }

    /// The area between two curves, `[x, low, high]`.
    pub(super) fn area(&mut self, points: &[[f64; 3]], ink: Ink, label: &str) {
        let along = points.iter().map(|p| (p[0], p[1])).chain(points.iter().rev().map(|p| (p[0], p[2])));
        let corners: Vec<String> = along
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .map(|(x, y)| format!("{:.1} {:.1}", self.x.at(x), self.y.at(y)))
            .collect();
        let _ =
            write!(self.body, "<path class=\"f-{}\" fill-opacity=\".22\" d=\"M{}Z\"/>", ink.name(), corners.join("L"));
        self.mention(ink, label);
    }

    /// Dots; many are thinned evenly.
    pub(super) fn dots(&mut self, points: &[[f64; 2]], ink: Ink, label: &str) {
        let step = points.len().div_ceil(MOST_DOTS).max(1);
        let mut path = String::new();
        for [x, y] in points.iter().step_by(step).filter(|p| p.iter().all(|v| v.is_finite())) {
            let _ = write!(path, "M{:.1} {:.1}h0", self.x.at(*x), self.y.at(*y));
        }
        let _ = write!(
            self.body,
            "<path class=\"s-{}\" fill=\"none\" stroke-width=\"2.4\" stroke-linecap=\"round\" stroke-opacity=\".55\" d=\"{path}\"/>",
            ink.name()
        );
        self.mention(ink, label);
    }

    fn mention(&mut self, ink: Ink, label: &str) {
        if !label.is_empty() {
            self.legend.push((ink, label.to_string()));
        }
    }

    /// The picture.
    pub(super) fn svg(self) -> String {
        let (width, height) = (self.width, self.height);
        let (left, right, top, bottom) = (LEFT, width - RIGHT, TOP, height - BOTTOM);
        let mut svg = format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\">");
        for (value, label) in self.x.ticks(6) {
            let x = self.x.at(value);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/><text class=\"soft\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 16.0
            );
        }
        for (value, label) in self.y.ticks(5) {
            let y = self.y.at(value);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{left:.1} {y:.1}H{right:.1}\"/><text class=\"soft\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                left - 6.0,
                y + 4.0
            );
        }
        svg.push_str(&self.body);
        let _ = write!(
            svg,
            "<rect class=\"frame\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
            right - left,
            bottom - top
        );
        let _ = write!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            0.5 * (left + right),
            height - 10.0,
            escape(&self.labels[0])
        );
        let _ = write!(
            svg,
            "<text transform=\"translate(13 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            0.5 * (top + bottom),
            escape(&self.labels[1])
        );
        let mut x = left;
        for (ink, label) in &self.legend {
            let _ = write!(
                svg,
                "<rect class=\"f-{}\" x=\"{x:.1}\" y=\"9\" width=\"14\" height=\"4\"/><text x=\"{:.1}\" y=\"15\">{}</text>",
                ink.name(),
                x + 19.0,
                escape(label)
            );
            x += 34.0 + 6.6 * label.chars().count() as f64;
        }
        svg.push_str("</svg>");
        svg
    }
}

/// Points of a line, at most two for each of [`MOST_COLUMNS`] buckets: its extremes in their order.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= 2 * MOST_COLUMNS {
        return points.to_vec();
    }
    let size = points.len().div_ceil(MOST_COLUMNS);
    let mut kept = Vec::with_capacity(2 * MOST_COLUMNS);
    for bucket in points.chunks(size) {
        let by = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let drawn = || bucket.iter().filter(|point| !point[1].is_nan());
        if let (Some(low), Some(high)) = (drawn().min_by(by), drawn().max_by(by)) {
            kept.extend(if low[0] <= high[0] { [*low, *high] } else { [*high, *low] });
        }
        kept.extend(bucket.iter().find(|p| p[1].is_nan()).copied());
    }
    kept
}

/// Horizontal bars with their names at the left and values at the right; `marked` ones stand out.
pub(super) fn bars(rows: &[(String, f64, bool)], unit: &str) -> String {
    const ROW: f64 = 22.0;
    const NAMES: f64 = 250.0;
    const WIDTH: f64 = 720.0;
    let largest = rows.iter().map(|(_, value, _)| value.max(0.0)).fold(f64::MIN_POSITIVE, f64::max);
    let height = ROW * rows.len() as f64 + 8.0;
    let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\">");
    for (index, (name, value, marked)) in rows.iter().enumerate() {
        let y = ROW * index as f64 + 4.0;
        let length = (value.max(0.0) / largest) * (WIDTH - NAMES - 110.0);
        let class = if *marked { "f-two" } else { "f-data" };
        let _ = write!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text><rect class=\"{class}\" x=\"{NAMES}\" y=\"{:.1}\" width=\"{length:.1}\" height=\"{:.1}\"/><text class=\"soft\" x=\"{:.1}\" y=\"{:.1}\">{} {}</text>",
            NAMES - 8.0,
            y + 14.0,
            escape(name),
            y + 3.0,
            ROW - 8.0,
            NAMES + length + 6.0,
            y + 14.0,
            digits(*value),
            escape(unit)
        );
    }
    svg.push_str("</svg>");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_line_keeps_its_peaks_beside_a_break() {
        let mut points: Vec<[f64; 2]> = (0..10 * MOST_COLUMNS).map(|i| [i as f64, 0.0]).collect();
        points[1234][1] = 7.0;
        points[1235][1] = f64::NAN;
        let kept = thinned(&points);
        assert!(kept.contains(&[1234.0, 7.0]));
        assert_eq!(kept.iter().filter(|point| point[1].is_nan()).count(), 1);
    }
}

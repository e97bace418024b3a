//! A chart that its reader can zoom, read and save: the values, of which the page's script draws it.

use serde::{Serialize, Serializer};

use crate::report::ink::Ink;

/// Rows of a chart at most; more would only be slower to draw and to send.
const MOST_ROWS: usize = 2400;
/// Digits of a value of the horizontal axis: milliseconds of an hour.
const DIGITS_ALONG: usize = 7;
/// Digits of any other value.
const DIGITS: usize = 4;

/// How much room a chart takes.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::report) enum Size {
    /// The whole width.
    Wide,
    /// Half of it where there is room.
    Half,
    /// Half of it, and lower.
    Low,
}

/// A chart under construction.
#[derive(Debug, Serialize)]
pub(in crate::report) struct Plot {
    name: String,
    size: Size,
    labels: [String; 2],
    groups: Vec<Group>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    bands: Vec<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    link: Option<&'static str>,
    log: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    cells: Option<Cells>,
}

/// Series over the same values of the horizontal axis.
#[derive(Debug, Serialize)]
struct Group {
    #[serde(serialize_with = "along")]
    x: Vec<f64>,
    series: Vec<Series>,
}

#[derive(Debug, Serialize)]
struct Series {
    label: String,
    ink: Ink,
    mark: &'static str,
    #[serde(serialize_with = "figures")]
    y: Vec<f64>,
    #[serde(serialize_with = "figures", skip_serializing_if = "Vec::is_empty")]
    high: Vec<f64>,
}

/// Values in equal cells over both axes: their colour tells the sign, its depth the size.
#[derive(Debug, Serialize)]
pub(in crate::report) struct Cells {
    /// Ends of the horizontal axis.
    pub(in crate::report) x: [f64; 2],
    /// Ends of the vertical axis.
    pub(in crate::report) y: [f64; 2],
    /// Cells along both.
    pub(in crate::report) size: [usize; 2],
    /// Values by rows from below; none where there are too few rows.
    #[serde(rename = "v", serialize_with = "figures")]
    pub(in crate::report) values: Vec<f64>,
    /// Value of full colour.
    pub(in crate::report) reach: f64,
    /// Unit of the values.
    pub(in crate::report) unit: &'static str,
}

impl Plot {
    /// An empty chart; `name` is that of the file to save it in, `labels` those of the horizontal and the vertical axis.
    pub(in crate::report) fn new(name: &str, size: Size, labels: [&str; 2]) -> Self {
        let name = name.to_lowercase().replace(|character: char| !character.is_ascii_alphanumeric(), "-");
        let labels = labels.map(str::to_string);
        Self { name, size, labels, groups: Vec::new(), bands: Vec::new(), link: None, log: false, cells: None }
    }

    /// Lines over the same values, `(values, colour, name)`; NaN breaks them. Long ones are thinned to their extremes.
    pub(in crate::report) fn lines(&mut self, x: &[f64], series: &[(&[f64], Ink, &str)]) {
        let kept = extremes(x.len(), series);
        self.group("line", x, series, &kept);
    }

    /// Dots at the same values; many are thinned evenly.
    pub(in crate::report) fn dots(&mut self, x: &[f64], series: &[(&[f64], Ink, &str)]) {
        let step = x.len().div_ceil(MOST_ROWS).max(1);
        let kept: Vec<usize> = (0..x.len()).step_by(step).filter(|&row| self.holds(x[row])).collect();
        self.group("dots", x, series, &kept);
    }

    fn holds(&self, x: f64) -> bool {
        x.is_finite() && (x > 0.0 || !self.log)
    }

    fn group(&mut self, mark: &'static str, x: &[f64], series: &[(&[f64], Ink, &str)], kept: &[usize]) {
        let at = |values: &[f64]| kept.iter().map(|&row| values[row]).collect::<Vec<_>>();
        let series = series
            .iter()
            .map(|(y, ink, label)| Series { label: (*label).to_string(), ink: *ink, mark, y: at(y), high: Vec::new() })
            .collect();
        self.groups.push(Group { x: at(x), series });
    }

    /// The area between two curves, `[x, low, high]`.
    pub(in crate::report) fn area(&mut self, points: &[[f64; 3]], ink: Ink, label: &str) {
        let column = |which: usize| points.iter().map(|point| point[which]).collect::<Vec<_>>();
        let series = Series { label: label.to_string(), ink, mark: "area", y: column(1), high: column(2) };
        self.groups.push(Group { x: column(0), series: vec![series] });
    }

    /// Shades a stretch of the horizontal axis.
    pub(in crate::report) fn band(&mut self, from: f64, to: f64) {
        self.bands.push([from, to]);
    }

    /// Charts of one link show the same stretch of the horizontal axis and the same place under the pointer.
    pub(in crate::report) fn linked(mut self, link: &'static str) -> Self {
        self.link = Some(link);
        self
    }

    /// A horizontal axis of powers of ten, where `yes`; to be said before anything is drawn.
    pub(in crate::report) fn logarithmic(mut self, yes: bool) -> Self {
        self.log = yes;
        self
    }

    /// A chart of cells.
    pub(in crate::report) fn of_cells(name: &str, labels: [&str; 2], cells: Cells) -> Self {
        Self { cells: Some(cells), ..Self::new(name, Size::Half, labels) }
    }

    /// What the script draws it of, as it may stand in a page.
    pub(super) fn json(&self) -> String {
        serde_json::to_string(self).map_or_else(|_| "null".to_string(), |json| json.replace('<', "\\u003c"))
    }
}

/// Both columns of points.
pub(in crate::report) fn columns(points: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
    points.iter().map(|[x, y]| (*x, *y)).unzip()
}

/// Rows to keep: in each of some stretches the extremes of every series, and where a line breaks.
fn extremes(rows: usize, series: &[(&[f64], Ink, &str)]) -> Vec<usize> {
    if rows <= MOST_ROWS {
        return (0..rows).collect();
    }
    let stretches = MOST_ROWS / (2 * series.len().max(1));
    let length = rows.div_ceil(stretches.max(1));
    let mut kept = Vec::with_capacity(MOST_ROWS + stretches);
    for start in (0..rows).step_by(length) {
        let mut here = Vec::new();
        for (values, ..) in series {
            let by = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
            let drawn = || (start..(start + length).min(rows)).filter(|&row| !values[row].is_nan());
            here.extend(drawn().min_by(by).into_iter().chain(drawn().max_by(by)));
            here.extend((start..(start + length).min(rows)).find(|&row| values[row].is_nan()));
        }
        here.sort_unstable();
        here.dedup();
        kept.extend(here);
    }
    kept
}

/// Values with so many digits; what is not finite becomes null.
fn rounded<S: Serializer>(values: &[f64], digits: usize, serializer: S) -> Result<S::Ok, S::Error> {
    let figure = |value: &f64| format!("{value:.*e}", digits - 1).parse::<f64>().ok().filter(|value| value.is_finite());
    serializer.collect_seq(values.iter().map(figure))
}

fn along<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    rounded(values, DIGITS_ALONG, serializer)
}

fn figures<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    rounded(values, DIGITS, serializer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_line_keeps_its_peaks_and_its_breaks_and_no_more_rows_than_can_be_drawn() {
        let x: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut y = vec![0.0; x.len()];
        (y[12_345], y[12_346]) = (7.0, f64::NAN);
        let mut plot = Plot::new("A chart", Size::Wide, ["time (s)", "torque (N m)"]);
        plot.lines(&x, &[(&y, Ink::One, "a"), (&x, Ink::Two, "b")]);
        let json: serde_json::Value = serde_json::from_str(&plot.json()).unwrap();
        let [rows, values] =
            ["/groups/0/x", "/groups/0/series/0/y"].map(|at| json.pointer(at).unwrap().as_array().unwrap());
        assert!(rows.len() == values.len() && rows.len() < 2 * MOST_ROWS);
        let peak = values.iter().position(|value| *value == 7.0).unwrap();
        assert_eq!((&rows[peak], &values[peak + 1]), (&12_345.0.into(), &serde_json::Value::Null));
        assert_eq!(json["name"], "a-chart");
    }

    #[test]
    fn an_axis_of_powers_of_ten_holds_only_what_is_above_zero_and_no_label_closes_the_script() {
        let mut plot = Plot::new("d", Size::Half, ["</script>", ""]).logarithmic(true);
        plot.dots(&[0.0, 1e-3, f64::NAN, 2.0], &[(&[1.0, 2.0, 3.0, 4.0], Ink::Data, "")]);
        let json = plot.json();
        assert!(
            json.contains("\"x\":[0.001,2.0]") && json.contains("\"y\":[2.0,4.0]") && !json.contains('<'),
            "{json}"
        );
    }
}

//! The frame of a page: head, style for light, dark and paper, contents, charts, foot, and the few elements that pages are made of.

mod origin;
mod plot;

use std::fmt::Write;

use crate::figures::{digits, estimate, interval};
use crate::markup::escape;
use crate::parameter::{NOT_DETERMINED, Parameter};

pub use origin::Origin;
pub(super) use plot::{Cells, Plot, Size, columns};

/// Colours come from custom properties, so that a picture follows the reader's choice of light or dark.
const STYLE: &str = include_str!("style.css");
/// The charts of a page: [uPlot](https://github.com/leeoniya/uPlot), and what hands it the values.
const CHARTS: [&str; 2] = [include_str!("uplot/uPlot.iife.min.js"), include_str!("page.js")];
const CHART_STYLE: &str = include_str!("uplot/uPlot.min.css");
const CHART_LICENCE: &str = include_str!("uplot/LICENSE");

/// A page under construction.
#[derive(Debug, Default)]
pub(super) struct Page {
    title: String,
    subtitle: String,
    contents: Vec<String>,
    body: String,
    has_plots: bool,
}

impl Page {
    pub(super) fn new(title: &str, subtitle: &str) -> Self {
        Self { title: title.to_string(), subtitle: subtitle.to_string(), ..Self::default() }
    }

    /// Adds HTML as it is.
    pub(super) fn html(&mut self, html: &str) {
        self.body.push_str(html);
        self.body.push('\n');
    }

    /// A section, which the contents name.
    pub(super) fn heading(&mut self, text: &str) {
        let place = self.place(text);
        self.html(&format!("<h2 id=\"{place}\">{}</h2>", escape(text)));
    }

    /// A section that is folded at first.
    pub(super) fn folded(&mut self, text: &str, fill: impl FnOnce(&mut Self)) {
        let place = self.place(text);
        self.html(&format!("<details id=\"{place}\"><summary><h2>{}</h2></summary>", escape(text)));
        fill(self);
        self.html("</details>");
    }

    /// The anchor of a section that the contents name from now on.
    pub(super) fn place(&mut self, text: &str) -> String {
        self.contents.push(text.to_string());
        format!("section-{}", self.contents.len())
    }

    pub(super) fn subheading(&mut self, text: &str) {
        self.html(&format!("<h3>{}</h3>", escape(text)));
    }

    pub(super) fn paragraph(&mut self, text: &str) {
        self.html(&format!("<p>{}</p>", escape(text)));
    }

    /// A paragraph that stands out.
    pub(super) fn lead(&mut self, text: &str) {
        self.html(&format!("<p class=\"lead\">{}</p>", escape(text)));
    }

    pub(super) fn list(&mut self, items: &[String], class: &str) {
        if items.is_empty() {
            return;
        }
        let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
        self.html(&format!("<ul class=\"{class}\">{items}</ul>"));
    }

    pub(super) fn equation(&mut self, text: &str) {
        self.html(&format!("<pre class=\"equation\">{}</pre>", escape(text)));
    }

    /// Pictures side by side where there is room.
    pub(super) fn figures(&mut self, figures: &[(String, String)]) {
        let mut html = String::from("<div class=\"figures\">");
        for (svg, caption) in figures {
            let caption = escape(caption);
            let svg = svg.replacen("<svg ", &format!("<svg aria-label=\"{caption}\" "), 1);
            let _ = write!(
                html,
                "<figure><div class=\"table\" tabindex=\"0\">{svg}</div><figcaption>{caption}</figcaption></figure>"
            );
        }
        html.push_str("</div>");
        self.html(&html);
    }

    /// Charts side by side where there is room, each with what it shows.
    pub(super) fn plots(&mut self, plots: &[(Plot, String)]) {
        let figures: String = plots.iter().map(|(plot, caption)| self.figure_of(plot, caption)).collect();
        self.html(&format!("<div class=\"figures\">{figures}</div>"));
    }

    /// A chart over the whole width.
    pub(super) fn plot(&mut self, plot: &Plot, caption: &str) {
        let figure = self.figure_of(plot, caption);
        self.html(&figure);
    }

    /// A chart as HTML, to stand within other HTML.
    pub(super) fn figure_of(&mut self, plot: &Plot, caption: &str) -> String {
        self.has_plots = true;
        let caption = escape(caption);
        format!(
            "<figure><div class=\"plot\" role=\"img\" aria-label=\"{caption}\"></div>\
             <script type=\"application/json\">{}</script><figcaption>{caption}</figcaption></figure>",
            plot.json()
        )
    }

    /// Horizontal bars: name, value, whether it stands out.
    pub(super) fn bars(&mut self, rows: &[(String, f64, bool)], unit: &str, caption: &str) {
        let largest = rows.iter().map(|(_, value, _)| value.max(0.0)).fold(f64::MIN_POSITIVE, f64::max);
        let bar = |(name, value, is_marked): &(String, f64, bool)| {
            let (class, share) = (if *is_marked { "f-two" } else { "f-data" }, 100.0 * value.max(0.0) / largest);
            format!(
                "<tr><th scope=\"row\">{}</th><td class=\"bar\"><i class=\"{class}\" style=\"width:{share:.1}%\"></i></td>\
                 <td>{} {}</td></tr>",
                escape(name),
                digits(*value),
                escape(unit)
            )
        };
        let rows: String = rows.iter().map(bar).collect();
        self.html(&format!(
            "<div class=\"table\" tabindex=\"0\"><table class=\"bars\"><caption>{}</caption>{rows}</table></div>",
            escape(caption)
        ));
    }

    pub(super) fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        if rows.is_empty() {
            return;
        }
        let head: String = header.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
        // On a phone each cell stands below the one before it, behind the name of its column.
        let cell = |(name, text): (&&str, &String)| format!("<td data-of=\"{}\">{}</td>", escape(name), escape(text));
        let row = |row: &Vec<String>| format!("<tr>{}</tr>", header.iter().zip(row).map(cell).collect::<String>());
        let body: String = rows.iter().map(row).collect();
        self.html(&format!(
            "<div class=\"table\" tabindex=\"0\"><table class=\"stacked\"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
        ));
    }

    /// The whole file; `origin` stands at its foot.
    pub(super) fn finish(self, origin: &Origin) -> String {
        let (title, subtitle) = (escape(&self.title), escape(&self.subtitle));
        let (mut contents, mut script, mut style, mut licence) = Default::default();
        if self.contents.len() > 1 {
            let link = |(index, text): (usize, &String)| {
                format!("<li><a href=\"#section-{}\">{}</a></li>", index + 1, escape(text))
            };
            let links: String = self.contents.iter().enumerate().map(link).collect();
            contents = format!(
                "<nav aria-label=\"Contents\"><details><summary>Contents</summary><ul>{links}</ul></details></nav>"
            );
        }
        if self.has_plots {
            script = CHARTS.map(|source| format!("<script>{source}</script>")).concat();
            style = CHART_STYLE;
            licence = format!(
                "<details><summary>Charts: uPlot, MIT licence</summary><pre>{}</pre></details>\
                 <noscript>The charts need a browser that runs scripts.</noscript>",
                escape(CHART_LICENCE.trim())
            );
        }
        let (body, foot) = (self.body, origin.html());
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
             <meta name=\"color-scheme\" content=\"light dark\"><title>{title}</title><style>{style}\n{STYLE}</style></head>\n\
             <body><header><h1>{title}</h1><p>{subtitle}</p>{contents}</header><main>\n{body}</main>\n\
             <footer>{foot}{licence}</footer>\n{script}</body></html>\n"
        )
    }
}

/// Parameters as rows of a table: name, symbol, value, unit, interval; `held` is said of a value that has no width.
pub(super) fn parameter_rows(parameters: &[Parameter], held: &str) -> Vec<Vec<String>> {
    let row = |p: &Parameter| {
        let bounds = match p.without_interval() {
            None => interval(p.ci95, ""),
            Some(NOT_DETERMINED) => held.to_owned(),
            Some(why) => why.to_owned(),
        };
        vec![p.name.replace('_', " "), p.symbol.clone(), estimate(p.value, p.ci95, ""), p.unit.clone(), bounds]
    };
    parameters.iter().map(row).collect()
}

/// Header of [`parameter_rows`].
pub(super) const PARAMETER_HEADER: [&str; 5] = ["parameter", "symbol", "value", "unit", "95 % interval"];

//! The frame of a page: head, style for light, dark and paper, and the few elements that pages are made of.

use std::fmt::Write;

use crate::markup::escape;

/// Colours come from custom properties, so that a picture follows the reader's choice of light or dark.
const STYLE: &str = include_str!("style.css");

/// A page under construction.
#[derive(Debug, Default)]
pub(super) struct Page {
    title: String,
    body: String,
}

impl Page {
    pub(super) fn new(title: &str, subtitle: &str) -> Self {
        let mut page = Self { title: title.to_string(), body: String::new() };
        page.html(&format!("<header><h1>{}</h1><p>{}</p></header>", escape(title), escape(subtitle)));
        page
    }

    /// Adds HTML as it is.
    pub(super) fn html(&mut self, html: &str) {
        self.body.push_str(html);
        self.body.push('\n');
    }

    pub(super) fn heading(&mut self, text: &str) {
        self.html(&format!("<h2>{}</h2>", escape(text)));
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
            let _ = write!(html, "<figure>{svg}<figcaption>{}</figcaption></figure>", escape(caption));
        }
        html.push_str("</div>");
        self.html(&html);
    }

    /// One picture over the whole width.
    pub(super) fn figure(&mut self, svg: &str, caption: &str) {
        self.html(&format!("<figure class=\"wide\">{svg}<figcaption>{}</figcaption></figure>", escape(caption)));
    }

    pub(super) fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        if rows.is_empty() {
            return;
        }
        let cells = |tag: &str, cells: Vec<&str>| -> String {
            cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect()
        };
        let head = cells("th", header.to_vec());
        let body: String = rows
            .iter()
            .map(|row| format!("<tr>{}</tr>", cells("td", row.iter().map(String::as_str).collect())))
            .collect();
        self.html(&format!(
            "<div class=\"table\"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
        ));
    }

    /// The whole file.
    pub(super) fn finish(self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
             <meta name=\"color-scheme\" content=\"light dark\"><title>{}</title><style>{STYLE}</style></head>\n\
             <body><main>\n{}</main></body></html>\n",
            escape(&self.title),
            self.body
        )
    }
}

/// Parameters as rows of a table: name, symbol, value, unit, interval.
pub(super) fn parameter_rows(parameters: &[crate::parameter::Parameter]) -> Vec<Vec<String>> {
    use crate::figures::digits;
    parameters
        .iter()
        .map(|p| {
            let interval = if p.ci95[1] > p.ci95[0] {
                format!("{} to {}", digits(p.ci95[0]), digits(p.ci95[1]))
            } else {
                "fixed".to_string()
            };
            vec![p.name.replace('_', " "), p.symbol.clone(), digits(p.value), p.unit.clone(), interval]
        })
        .collect()
}

/// Header of [`parameter_rows`].
pub(super) const PARAMETER_HEADER: [&str; 5] = ["parameter", "symbol", "value", "unit", "95 % interval"];

//! Changes to a text that leave every other byte as it is.

use std::ops::Range;

use roxmltree::Node;

use crate::markup::escape;

/// What the title of every image begins with.
const OUR_REMARK: &str = "Frikan friction image";

/// A comment of XML, which must not hold two hyphens in a row.
pub(super) fn comment_of(text: &str) -> String {
    format!("<!-- {} -->", text.replace("--", "- -"))
}

/// Changes to a text, collected before any is made.
#[derive(Debug)]
pub(super) struct Edits<'a> {
    text: &'a str,
    changes: Vec<(Range<usize>, String)>,
}

impl<'a> Edits<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self { text, changes: Vec::new() }
    }

    /// Puts `text` in the place of a range; ranges must not overlap.
    pub(super) fn replace(&mut self, range: Range<usize>, text: impl Into<String>) {
        self.changes.push((range, text.into()));
    }

    /// Puts `text` before a place; several at one place keep their order.
    pub(super) fn insert(&mut self, at: usize, text: impl Into<String>) {
        self.replace(at..at, text);
    }

    /// Gives an attribute a value, where it stands or behind the last one.
    pub(super) fn set_attribute(&mut self, node: Node, name: &str, value: &str) {
        match node.attribute_node(name) {
            Some(attribute) => self.replace(attribute.range_value(), escape(value)),
            None => {
                let behind = node.attributes().map(|attribute| attribute.range().end).max();
                let at = behind.unwrap_or_else(|| node.range().start + 1 + node.tag_name().name().len());
                self.insert(at, format!(" {name}=\"{}\"", escape(value)));
            }
        }
    }

    /// Puts an element as the last child of `parent`, indented as its other children are.
    pub(super) fn append_child(&mut self, parent: Node, element: &str) {
        let range = parent.range();
        let last = parent.children().rfind(Node::is_element);
        if let Some(last) = last {
            let indentation = self.indentation(last.range().start);
            self.insert(last.range().end, format!("\n{indentation}{element}"));
            return;
        }
        let outer = self.indentation(range.start);
        let name = parent.tag_name().name();
        if self.text[range.clone()].ends_with("/>") {
            self.replace(range.end - 2..range.end, format!(">\n{outer}  {element}\n{outer}</{name}>"));
        } else {
            let end = self.text[range.clone()].rfind("</").map_or(range.end, |place| range.start + place);
            self.insert(end, format!("  {element}\n{outer}"));
        }
    }

    /// Puts a comment before `node`, in the place of one that an earlier export left there.
    pub(super) fn set_remark(&mut self, node: Node, remark: &str) {
        let is_ours = |node: &Node| node.is_comment() && node.text().is_some_and(|text| text.contains(OUR_REMARK));
        let before = node.prev_siblings().skip(1).find(|node| !node.is_text());
        let start = node.range().start;
        match before.filter(is_ours) {
            Some(comment) => self.replace(comment.range(), comment_of(remark)),
            None => {
                let begins_line = self.text[..start].ends_with(['\n', ' ', '\t']);
                let line = if begins_line { format!("\n{}", self.indentation(start)) } else { String::new() };
                self.insert(start, format!("{}{line}", comment_of(remark)));
            }
        }
    }

    /// The white space between the start of a line and `at`; nothing where other text stands there.
    pub(super) fn indentation(&self, at: usize) -> &'a str {
        let line = self.text[..at].rfind('\n').map_or(0, |place| place + 1);
        let before = &self.text[line..at];
        if before.trim().is_empty() { before } else { "" }
    }

    /// The text with every change made.
    pub(super) fn apply(mut self) -> String {
        self.changes.sort_by_key(|(range, _)| (range.start, range.end));
        let (mut result, mut done) = (String::with_capacity(self.text.len() + 512), 0);
        for (range, text) in self.changes {
            result += &self.text[done..range.start];
            result += &text;
            done = range.end;
        }
        result + &self.text[done..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use roxmltree::Document;

    #[test]
    fn nothing_but_what_is_changed_changes() {
        let text = "<a>\n  <!-- kept -->\n  <b  x='1'\n     y = \"2\" />\n  <c/>\n</a>\n";
        let document = Document::parse(text).unwrap();
        let find = |name: &str| document.descendants().find(|node| node.has_tag_name(name)).unwrap();
        let mut edits = Edits::of(text);
        edits.set_attribute(find("b"), "y", "<3>");
        edits.set_attribute(find("b"), "z", "4");
        edits.append_child(find("c"), "<d/>");
        edits.append_child(find("a"), "<e/>");
        let expected = "<a>\n  <!-- kept -->\n  <b  x='1'\n     y = \"&lt;3&gt;\" z=\"4\" />\n  <c>\n    <d/>\n  </c>\n  <e/>\n</a>\n";
        assert_eq!(edits.apply(), expected);
    }
}

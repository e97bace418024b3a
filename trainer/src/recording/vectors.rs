//! Cells that hold a list, such as `[0.1, 0.2]`: one column becomes one for each element.

/// The elements of a list in brackets, quotes around them left out; `None` where it is none.
pub(super) fn elements(cell: &str) -> Option<impl Iterator<Item = &str>> {
    // `array('d', [0.1, 0.2])` and `(0.1, 0.2)` are lists as well.
    let inside = |open: char, close: char| {
        let (start, end) = (cell.find(open)? + open.len_utf8(), cell.rfind(close)?);
        cell.get(start..end)
    };
    let whole = cell.ends_with([']', ')']) && (cell.starts_with(['[', '(']) || cell.starts_with("array("));
    let list = if whole { inside('[', ']').or_else(|| inside('(', ')')) } else { None }?;
    let parts = list.split(|mark: char| matches!(mark, ',' | ';') || mark.is_whitespace());
    Some(parts.map(|part| part.trim_matches(['\'', '"'])).filter(|part| !part.is_empty()))
}

/// How the columns of a file become those of the table: how many elements each has, `None` for a cell that is no list.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Expansion {
    lengths: Vec<Option<usize>>,
}

impl Expansion {
    /// Told from the first cell of each column that is not empty, in as many rows as are given.
    pub(super) fn of<'a>(width: usize, rows: impl Iterator<Item = Vec<&'a str>>) -> Self {
        let mut lengths: Vec<Option<Option<usize>>> = vec![None; width];
        for row in rows {
            for (length, cell) in
                lengths.iter_mut().zip(row).filter(|(length, cell)| length.is_none() && !cell.is_empty())
            {
                *length = Some(elements(cell).map(Iterator::count).filter(|count| *count > 0));
            }
            if lengths.iter().all(Option::is_some) {
                break;
            }
        }
        Self { lengths: lengths.into_iter().map(Option::flatten).collect() }
    }

    /// Elements of column `index`; `None` where it holds no lists.
    pub(super) fn length(&self, index: usize) -> Option<usize> {
        self.lengths.get(index).copied().flatten()
    }

    /// Names of the columns of the table: `position[0]`, `position[1]`, or `/elbow/position` where a column `name` lists the joints.
    pub(super) fn names(&self, header: &[String], joints: Option<&[String]>) -> Vec<String> {
        let mut names = Vec::new();
        for (index, name) in header.iter().enumerate() {
            match self.length(index) {
                None => names.push(name.clone()),
                Some(1) => names.push(name.clone()),
                Some(length) => match joints.filter(|joints| joints.len() == length && is_joint_state(name)) {
                    Some(joints) => names.extend(joints.iter().map(|joint| format!("/{joint}/{name}"))),
                    None => names.extend((0..length).map(|element| format!("{name}[{element}]"))),
                },
            }
        }
        names
    }
}

fn is_joint_state(name: &str) -> bool {
    matches!(name, "position" | "velocity" | "effort")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_several_writers_are_read() {
        for text in ["[1.5, -2]", "[1.5 -2]", "(1.5,-2)", "array('d', [1.5, -2])", "[1.5;-2]"] {
            assert_eq!(elements(text).unwrap().collect::<Vec<_>>(), ["1.5", "-2"], "{text}");
        }
        assert_eq!(elements("['elbow', 'wrist']").unwrap().collect::<Vec<_>>(), ["elbow", "wrist"]);
        for text in ["1.5", "position[1]", "[", "", "a (b)"] {
            assert!(elements(text).is_none(), "{text}");
        }
    }

    #[test]
    fn columns_are_named_by_element_or_by_joint() {
        let header = ["time_s", "position", "name", "flag"].map(str::to_owned);
        let rows = [vec!["0", "", "['a','b']", ""], vec!["0", "[1, 2]", "['a','b']", "[1]"]];
        let expansion = Expansion::of(4, rows.into_iter());
        let names = expansion.names(&header, None);
        assert_eq!(names, ["time_s", "position[0]", "position[1]", "name[0]", "name[1]", "flag"]);
        let joints = ["a", "b"].map(str::to_owned);
        assert_eq!(expansion.names(&header, Some(&joints))[1..3], ["/a/position", "/b/position"]);
    }
}

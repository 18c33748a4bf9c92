//! Markdown tables that can be read as they are.

use crate::output::progress;
use std::fmt;

/// A table; the first column is aligned left, the others right.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub(crate) fn new<T: Into<String>>(titles: impl IntoIterator<Item = T>) -> Self {
        let titles = titles.into_iter().map(Into::into).collect();
        Self { rows: vec![titles] }
    }

    /// Appends a row, and shows it as progress.
    pub(crate) fn report(&mut self, cells: Vec<String>) {
        progress(&format!("| {} |", cells.join(" | ")));
        self.push(cells);
    }

    /// Appends a row.
    pub(crate) fn push(&mut self, cells: Vec<String>) {
        self.rows.push(cells.iter().map(|cell| escape(cell)).collect());
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns)
            .map(|k| {
                let cells = self.rows.iter().filter_map(|row| row.get(k));
                cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
            })
            .collect();
        for (i, row) in self.rows.iter().enumerate() {
            for (k, &width) in widths.iter().enumerate() {
                let cell = row.get(k).map_or("", String::as_str);
                if k == 0 {
                    write!(f, "| {cell:<width$} ")?;
                } else {
                    write!(f, "| {cell:>width$} ")?;
                }
            }
            f.write_str("|\n")?;
            if i == 0 {
                for (k, &width) in widths.iter().enumerate() {
                    let end = if k == 0 { '-' } else { ':' };
                    write!(f, "|{:-<rule$}{end}", "", rule = width + 1)?;
                }
                f.write_str("|\n")?;
            }
        }
        Ok(())
    }
}

/// Text that ends no cell and no line.
pub(crate) fn escape(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_padded_and_bars_escaped() {
        let mut table = Table::new(["mesh", "n"]);
        table.push(vec!["a|b".into(), "12".into()]);
        assert_eq!(table.to_string(), "| mesh |  n |\n|------|---:|\n| a\\|b | 12 |\n");
    }
}

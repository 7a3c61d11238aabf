//! Text tables with aligned columns.

/// Spaces between two columns.
const GAP: &str = "  ";

/// One line for each row, after an indentation: the first column aligned left, the others right.
pub fn aligned(rows: &[Vec<String>], indent: &str) -> String {
    let widths = widths(rows);
    rows.iter()
        .map(|row| format!("{}\n", line(row, &widths, indent)))
        .collect()
}

/// Like [`aligned`], with the first row as a bold heading.
pub fn headed(rows: &[Vec<String>]) -> String {
    let text = aligned(rows, "");
    match text.split_once('\n') {
        Some((heading, rest)) => format!("\x1b[1m{heading}\x1b[0m\n{rest}"),
        None => text,
    }
}

/// Returns the number of characters of the widest entry of each column.
pub fn widths(rows: &[Vec<String>]) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    (0..columns).map(width).collect()
}

/// One row in columns of these widths.
pub fn line(row: &[String], widths: &[usize], indent: &str) -> String {
    let cells = row.iter().zip(widths).enumerate();
    let cells: Vec<String> = cells
        .map(|(column, (cell, &width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        })
        .collect();
    format!("{indent}{}", cells.join(GAP))
        .trim_end()
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::{aligned, headed};

    #[test]
    fn wide_entries_widen_their_column() {
        let row = |cells: [&str; 3]| cells.map(String::from).to_vec();
        let rows = [
            row(["function", "add", "mul"]),
            row(["ξ̇", "12345678", "1"]),
            row(["rate", "7", "123456789012"]),
        ];
        let text = aligned(&rows, " ");
        for line in text.lines().skip(1) {
            assert_eq!(
                line.split("  ").filter(|c| !c.is_empty()).count(),
                3,
                "{text}"
            );
        }
        let headed = headed(&rows);
        assert!(headed.starts_with("\x1b[1mfunction"), "{headed}");
        assert!(headed.contains("mul\x1b[0m\n"), "{headed}");
    }
}

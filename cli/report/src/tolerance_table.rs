//! A table of runs with error control: error and steps for each tolerance.

use crate::data::{Case, MethodRun, MethodRuns};
use crate::number::{error, group_thousands};

/// The tolerances of the table; a tolerance that was not measured is left out.
const TABLE_TOLERANCES: [f64; 4] = [1e-5, 1e-7, 1e-9, 1e-11];

/// Returns the heading and the rows: for every method, error, steps and rejected attempts at each tolerance; `None` if
/// no method of the case has error control.
pub fn table(case: &Case) -> Option<(Vec<String>, Vec<Vec<String>>)> {
    let of = |method: &&MethodRuns| method.runs.iter().any(|run| run.tolerance.is_some());
    let methods: Vec<&MethodRuns> = case.methods.iter().filter(of).collect();
    if methods.is_empty() {
        return None;
    }
    let mut head = vec!["tolerance".to_string()];
    for method in &methods {
        head.push(format!("{}: error", method.method));
        head.extend(["steps".to_string(), "refused".into()]);
    }
    let row = |tolerance: f64| {
        let mut cells = vec![format!("{tolerance:.0e}")];
        for method in &methods {
            let with = |run: &&MethodRun| run.tolerance == Some(tolerance);
            cells.extend(count(method.runs.iter().find(with)));
        }
        cells
    };
    Some((head, TABLE_TOLERANCES.map(row).to_vec()))
}

/// Returns error, steps and rejected attempts.
fn count(run: Option<&MethodRun>) -> [String; 3] {
    let none = || "-".to_string();
    let Some(run) = run else {
        return [none(), none(), none()];
    };
    if let Some(why) = &run.failure {
        return [why.clone(), none(), none()];
    }
    [
        run.error.map_or_else(none, error),
        group_thousands(run.steps),
        run.rejected.map_or_else(none, group_thousands),
    ]
}

#[cfg(test)]
mod tests {
    use super::table;
    use crate::data::{Case, Kind, MethodRun, MethodRuns};

    #[test]
    fn a_row_for_every_tolerance_that_is_shown() {
        let run = |tolerance: f64| MethodRun {
            steps: 1200,
            tolerance: Some(tolerance),
            rejected: Some(3),
            error: Some(40.0 * tolerance),
            ..MethodRun::default()
        };
        let method = |name: &str, runs: Vec<MethodRun>| MethodRuns {
            method: name.into(),
            kind: Kind::Method,
            order: Some(5),
            runs,
        };
        let mut case = Case {
            methods: vec![method("equal", vec![MethodRun::default()])],
            ..Case::default()
        };
        assert_eq!(table(&case), None);
        let mut runs = [1e-5, 1e-6, 1e-7].map(run).to_vec();
        runs[2].failure = Some("too small".into());
        case.methods.push(method("pair", runs));
        let (head, rows) = table(&case).expect("a table");
        assert_eq!(head, ["tolerance", "pair: error", "steps", "refused"]);
        assert_eq!(rows[0], ["1e-5", "4.0e-4", "1 200", "3"]);
        assert_eq!(rows[1], ["1e-7", "too small", "-", "-"]);
        assert_eq!(rows[2], ["1e-9", "-", "-", "-"]);
        assert_eq!(rows.len(), 4);
    }
}

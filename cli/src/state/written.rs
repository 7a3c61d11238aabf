//! Converts names in files from the notation of descriptions: `leg[3].knee` to `leg_3_knee`.

use hamel_codegen::syntax::path::plain;
use serde_json::{Map, Value};

/// The value with resolved names; an error if a name occurs twice.
pub fn plainly(value: Value) -> Result<Value, String> {
    Ok(match value {
        Value::Object(members) => {
            let mut all = Map::new();
            for (name, value) in members {
                let known = plain(&name);
                if all.insert(known.clone(), plainly(value)?).is_some() {
                    return Err(format!("{name}: given twice, also as `{known}`"));
                }
            }
            Value::Object(all)
        }
        Value::Array(entries) => {
            let entries: Result<Vec<Value>, String> = entries.into_iter().map(plainly).collect();
            Value::Array(entries?)
        }
        other => other,
    })
}

#[cfg(test)]
mod tests {
    use super::plainly;
    use serde_json::json;

    #[test]
    fn names_are_written_with_indices() {
        let given = json!({"coord": {"leg[3].knee": 1, "node[1, 2]": [2], "q": 3}, "samples": [{"j[2]_dot": 4}]});
        let wanted = json!({"coord": {"leg_3_knee": 1, "node_1_2": [2], "q": 3}, "samples": [{"j_2_dot": 4}]});
        assert_eq!(plainly(given), Ok(wanted));
        let twice = plainly(json!({"velocity": {"a_1": 1, "a[1]": 2}}));
        assert!(twice.is_err_and(|error| error.contains("given twice")));
    }
}

//! Converts names in files from the notation of descriptions: `leg[3].knee` to `leg_3_knee`.

use super::json::JsonError;
use hamel_codegen::syntax::path::plain;
use serde_json::{Map, Value};

/// Rewrites all names of a value; returns an error if a name then occurs twice.
pub fn with_plain_names(value: Value) -> Result<Value, JsonError> {
    Ok(match value {
        Value::Object(members) => {
            let mut all = Map::new();
            for (name, value) in members {
                let known = plain(&name);
                if all
                    .insert(known.clone(), with_plain_names(value)?)
                    .is_some()
                {
                    return Err(JsonError::Twice { name, plain: known });
                }
            }
            Value::Object(all)
        }
        Value::Array(entries) => {
            let entries: Result<Vec<Value>, JsonError> =
                entries.into_iter().map(with_plain_names).collect();
            Value::Array(entries?)
        }
        other => other,
    })
}

#[cfg(test)]
mod tests {
    use super::with_plain_names;
    use serde_json::json;

    #[test]
    fn names_are_written_with_indices() {
        let given = json!({"coord": {"leg[3].knee": 1, "node[1, 2]": [2], "q": 3}, "samples": [{"j[2]_dot": 4}]});
        let wanted = json!({"coord": {"leg_3_knee": 1, "node_1_2": [2], "q": 3}, "samples": [{"j_2_dot": 4}]});
        assert_eq!(
            with_plain_names(given).expect("no name stands twice"),
            wanted
        );
        let twice = with_plain_names(json!({"velocity": {"a_1": 1, "a[1]": 2}}));
        assert!(twice.is_err_and(|error| error.to_string().contains("given twice")));
    }
}

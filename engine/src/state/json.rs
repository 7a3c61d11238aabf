//! Parses JSON, and refuses repeated names in an object, whose meaning would be ambiguous.

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;

/// Error in a JSON text.
#[derive(Debug)]
pub enum JsonError {
    /// It is not JSON, or a name stands twice in an object.
    Text(serde_json::Error),
    /// Two names in an object are one when they are written plainly.
    Twice {
        /// The later name.
        name: String,
        /// The plain name of both.
        plain: String,
    },
}

impl fmt::Display for JsonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            JsonError::Text(error) if error.is_data() => error.fmt(f),
            JsonError::Text(error) => write!(f, "not valid JSON: {error}"),
            JsonError::Twice { name, plain } => {
                write!(f, "{name}: given twice, also as `{plain}`")
            }
        }
    }
}

impl std::error::Error for JsonError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            JsonError::Text(error) => Some(error),
            JsonError::Twice { .. } => None,
        }
    }
}

/// Parses a JSON text, with or without a byte order mark; the error contains its place.
pub fn parse(text: &str) -> Result<Value, JsonError> {
    match serde_json::from_str::<Strict>(text.strip_prefix('\u{feff}').unwrap_or(text)) {
        Ok(Strict(value)) => Ok(value),
        Err(error) => Err(JsonError::Text(error)),
    }
}

/// JSON value without repeated names.
struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(StateReader).map(Strict)
    }
}

struct StateReader;

impl<'de> Visitor<'de> for StateReader {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(Strict(value)) = list.next_element()? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Value, A::Error> {
        let mut members = Map::new();
        while let Some(name) = object.next_key::<String>()? {
            if members.contains_key(&name) {
                return Err(A::Error::custom(format_args!(
                    "`{name}` occurs twice in one object"
                )));
            }
            let Strict(value) = object.next_value()?;
            members.insert(name, value);
        }
        Ok(Value::Object(members))
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn a_name_that_stands_twice_is_refused_with_its_place() {
        let error = parse("{\"coord\": {\"q\": 1,\n \"q\": 2}}")
            .expect_err("twice")
            .to_string();
        assert_eq!(error, "`q` occurs twice in one object at line 2 column 4");
        // The same name in two objects is not repeated.
        assert!(parse("{\"a\": {\"q\": 1}, \"b\": {\"q\": 1}}").is_ok());
        assert!(parse("\u{feff}{\"q\": 1}").is_ok());
        let error = parse("{\"q\": NaN}").expect_err("no JSON").to_string();
        assert!(error.starts_with("not valid JSON"), "{error}");
        let error = parse("{\"q\": 1e999}").expect_err("too large").to_string();
        assert!(
            error.starts_with("not valid JSON: number out of range"),
            "{error}"
        );
    }
}

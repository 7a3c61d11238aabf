//! The file in a sweep's folder that specifies the sweep: everything on which a row depends.

use crate::json::Json;
use hamel_engine::state::{JsonError, parse};
use serde_json::{Map, Value};
use std::error::Error;
use std::fmt;

/// Version of the file's format.
const FORMAT: u128 = 1;
/// Longer texts are compared by their first differing line.
const MAX_INLINE_TEXT: usize = 60;

/// Reason why a text is not a manifest.
#[derive(Debug)]
pub enum ManifestError {
    /// It is not JSON.
    Json(JsonError),
    /// It is JSON, but not an object.
    NoObject,
    /// Its format is of another version.
    OtherFormat,
    /// The entry of this name is not a whole number above 0.
    NoCount(&'static str),
}

impl fmt::Display for ManifestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ManifestError::Json(error) => error.fmt(f),
            ManifestError::NoObject => f.write_str("expected an object"),
            ManifestError::OtherFormat => write!(
                f,
                "`format` is not {FORMAT}: another version of hamel wrote it"
            ),
            ManifestError::NoCount(name) => write!(f, "`{name}` is not a whole number above 0"),
        }
    }
}

impl Error for ManifestError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            ManifestError::Json(error) => Some(error),
            _ => None,
        }
    }
}

impl From<JsonError> for ManifestError {
    fn from(error: JsonError) -> Self {
        ManifestError::Json(error)
    }
}

/// The specification of a sweep.
#[derive(Clone, Debug)]
pub struct Manifest {
    /// Text of the file.
    pub text: String,
    members: Map<String, Value>,
    /// Number of members.
    pub count: u64,
    /// Number of members in a shard; the last one may have fewer.
    pub size: u64,
}

impl Manifest {
    /// Creates a manifest with these values to be fixed, in this order.
    pub fn new(count: u64, size: u64, fixed: Vec<(&str, Json)>) -> Result<Self, ManifestError> {
        let own = [
            ("format", Json::Count(FORMAT)),
            ("hamel", Json::Text(env!("CARGO_PKG_VERSION").into())),
            ("members", Json::Count(count.into())),
            ("members of a shard", Json::Count(size.into())),
        ];
        Manifest::read(&Json::object(own.into_iter().chain(fixed)).pretty())
    }

    /// Reads the file.
    pub fn read(text: &str) -> Result<Self, ManifestError> {
        let Value::Object(members) = parse(text)? else {
            return Err(ManifestError::NoObject);
        };
        if members
            .get("format")
            .and_then(Value::as_u64)
            .map(u128::from)
            != Some(FORMAT)
        {
            return Err(ManifestError::OtherFormat);
        }
        let number = |name: &'static str| {
            let number = members.get(name).and_then(Value::as_u64);
            let number = number.filter(|number| *number > 0);
            number.ok_or(ManifestError::NoCount(name))
        };
        Ok(Manifest {
            count: number("members")?,
            size: number("members of a shard")?,
            text: text.to_string(),
            members,
        })
    }

    /// Returns the number of shards.
    pub fn shards(&self) -> u64 {
        self.count.div_ceil(self.size)
    }

    /// Returns the members of a shard.
    pub fn range(&self, shard: u64) -> std::ops::Range<u64> {
        let first = shard * self.size;
        first..(first + self.size).min(self.count)
    }

    /// Returns a string of the manifest.
    pub fn word(&self, name: &str) -> Option<&str> {
        self.members.get(name)?.as_str()
    }

    /// Returns the differences from the manifest that exists.
    pub fn differences(&self, there: &Manifest) -> Vec<String> {
        let names = self.members.keys().chain(there.members.keys());
        let mut names: Vec<&String> = names.collect();
        names.sort();
        names.dedup();
        let mut all = Vec::new();
        for name in names {
            let (old, new) = (there.members.get(name), self.members.get(name));
            if old != new {
                all.push(describe_difference(name, old, new));
            }
        }
        all
    }
}

fn describe_difference(name: &str, old: Option<&Value>, new: Option<&Value>) -> String {
    if let (Some(Value::String(old)), Some(Value::String(new))) = (old, new)
        && old.len().max(new.len()) > MAX_INLINE_TEXT
        && old.lines().count().max(new.lines().count()) > 1
    {
        let (mut old, mut new) = (old.lines(), new.lines());
        let mut line = 0;
        loop {
            line += 1;
            match (old.next(), new.next()) {
                (Some(a), Some(b)) if a == b => {}
                (None, None) => return format!("{name}: ends of lines differ"),
                (a, b) => {
                    let display =
                        |line: Option<&str>| line.map_or("nothing".into(), |l| format!("`{l}`"));
                    return format!(
                        "{name}, line {line}: {} there, {} here",
                        display(a),
                        display(b)
                    );
                }
            }
        }
    }
    let display = |value: Option<&Value>| match value {
        None | Some(Value::Null) => "nothing".into(),
        Some(value) => value.to_string(),
    };
    format!("{name}: {} there, {} here", display(old), display(new))
}

#[cfg(test)]
mod tests {
    use super::Manifest;
    use crate::json::Json;

    fn manifest(seed: u128, text: &str) -> Manifest {
        let fixed = vec![
            ("seed", Json::Count(seed)),
            ("description", Json::Text(text.into())),
            ("step", Json::Number(1e-3)),
        ];
        Manifest::new(10, 3, fixed).expect("a manifest")
    }

    #[test]
    fn differences_are_told() {
        let long = format!("system S {{\n{}", "coord q;\n".repeat(10));
        let other = long.replacen("q", "p", 1);
        let (here, there) = (manifest(8, &other), manifest(7, &long));
        let again = Manifest::read(&there.text).expect("its own text");
        assert_eq!(there.differences(&again), Vec::<String>::new());
        let differences = here.differences(&there);
        assert_eq!(
            differences,
            [
                "description, line 2: `coord q;` there, `coord p;` here",
                "seed: 7 there, 8 here"
            ]
        );
    }

    #[test]
    fn shards_have_all_members() {
        let one = manifest(0, "");
        let ranges: Vec<_> = (0..one.shards()).map(|shard| one.range(shard)).collect();
        assert_eq!(ranges, [0..3, 3..6, 6..9, 9..10]);
        for (text, why) in [
            ("[]", "an object"),
            ("{\"format\": 2}", "another version"),
            (
                "{\"format\": 1, \"members\": 0, \"members of a shard\": 1}",
                "not a whole number",
            ),
            ("{\"format\": 1, \"format\": 1}", "twice"),
        ] {
            let error = Manifest::read(text).expect_err(text).to_string();
            assert!(error.contains(why), "{error}");
        }
    }
}

//! Writes JSON with members in insertion order, and short lists on one line.

use hamel_files::number::exact;

/// A JSON value to be written.
#[derive(Clone, Debug)]
pub enum Json {
    /// A number; written as `null` if it is not finite.
    Number(f64),
    /// A count.
    Count(u128),
    /// A text.
    Text(String),
    /// A truth value.
    Bool(bool),
    /// No given entries.
    Null,
    /// A list.
    List(Vec<Json>),
    /// Members in order.
    Object(Vec<(String, Json)>),
}

/// Maximal width of a list on one line.
const WIDTH: usize = 100;

impl Json {
    /// Returns an object with these members.
    pub fn object<'a>(members: impl IntoIterator<Item = (&'a str, Json)>) -> Json {
        Json::Object(
            members
                .into_iter()
                .map(|(name, value)| (name.to_string(), value))
                .collect(),
        )
    }

    /// Returns a list of numbers.
    pub fn vector(values: &[f64]) -> Json {
        Json::List(values.iter().map(|&value| Json::Number(value)).collect())
    }

    /// Returns a list of rows.
    pub fn matrix(rows: &[Vec<f64>]) -> Json {
        Json::List(rows.iter().map(|row| Json::vector(row)).collect())
    }

    /// Returns a list of texts.
    pub fn texts(texts: &[String]) -> Json {
        Json::List(texts.iter().map(|text| Json::Text(text.clone())).collect())
    }

    /// Indented text with a final line break.
    pub fn pretty(&self) -> String {
        let mut text = String::new();
        self.write(0, &mut text);
        text.push('\n');
        text
    }

    /// Text on one line, without a line break.
    pub fn line(&self) -> String {
        match self {
            Json::Number(value) if value.is_finite() => exact(*value),
            Json::Number(_) | Json::Null => "null".into(),
            Json::Count(count) => count.to_string(),
            Json::Bool(value) => value.to_string(),
            Json::Text(text) => serde_json::Value::from(text.as_str()).to_string(),
            Json::List(items) => {
                let items: Vec<String> = items.iter().map(Json::line).collect();
                format!("[{}]", items.join(", "))
            }
            Json::Object(members) => {
                let members: Vec<String> = members
                    .iter()
                    .map(|(name, value)| format!("{}: {}", quoted(name), value.line()))
                    .collect();
                format!("{{{}}}", members.join(", "))
            }
        }
    }

    fn write(&self, indent: usize, text: &mut String) {
        let parts: Vec<(String, &Json)> = match self {
            Json::List(items) if !items.is_empty() => {
                items.iter().map(|item| (String::new(), item)).collect()
            }
            Json::Object(members) if !members.is_empty() => members
                .iter()
                .map(|(name, value)| (format!("{}: ", quoted(name)), value))
                .collect(),
            _ => return text.push_str(&self.line()),
        };
        let line = self.line();
        let list = matches!(self, Json::List(_));
        // The outermost object always spans several lines.
        if indent + line.chars().count() <= WIDTH && (list || indent > 0) {
            return text.push_str(&line);
        }
        text.push(if list { '[' } else { '{' });
        let mut column = usize::MAX;
        for (index, (name, value)) in parts.iter().enumerate() {
            let single = !matches!(value, Json::List(_) | Json::Object(_));
            let width = if list && single {
                value.line().chars().count() + 2
            } else {
                usize::MAX
            };
            text.push_str(if index > 0 { "," } else { "" });
            if column.saturating_add(width) <= WIDTH {
                text.push(' ');
                column += width;
            } else {
                text.push('\n');
                text.push_str(&" ".repeat(indent + 2));
                column = width.saturating_add(indent + 2);
            }
            text.push_str(name);
            value.write(indent + 2, text);
        }
        text.push('\n');
        text.push_str(&" ".repeat(indent));
        text.push(if list { ']' } else { '}' });
    }
}

impl From<&serde_json::Value> for Json {
    fn from(value: &serde_json::Value) -> Self {
        match value {
            serde_json::Value::Array(items) => Json::List(items.iter().map(Json::from).collect()),
            serde_json::Value::Object(members) => Json::object(
                members
                    .iter()
                    .map(|(name, value)| (name.as_str(), value.into())),
            ),
            serde_json::Value::String(text) => Json::Text(text.clone()),
            other => other.as_f64().map_or(Json::Null, Json::Number),
        }
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::Json;

    #[test]
    fn numbers_fill_lines_and_rows_stand_apart() {
        let long = Json::vector(&[0.123456789; 12]);
        let rows = Json::matrix(&vec![vec![0.5; 3]; 9]);
        let value = Json::object([("a", long), ("b", rows), ("c", Json::Number(f64::NAN))]);
        let text = value.pretty();
        assert!(
            text.lines().all(|line| line.len() <= 104) && text.lines().count() == 18,
            "{text}"
        );
        let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(
            (&read["a"][11], &read["b"][8][2]),
            (&0.123456789.into(), &0.5.into())
        );
        assert!(read["c"].is_null());
    }
}

//! `hamel ops --advise`: compares the cost of ξ̇ in other velocity coordinates.

use crate::columns;
use crate::failure::Failure;
use crate::json::Json;
use hamel_codegen::derive::adviser::{VelocityChoice, advise};
use hamel_codegen::model::Model;
use hamel_codegen::program::count::Count;
use hamel_engine::Source;

/// Compares the choices and writes them as a table or as JSON.
pub fn write(source: &Source, model: &Model, as_json: bool) -> Result<String, Failure> {
    let choices = advise(model).map_err(|why| {
        Failure::failed(format!(
            "{}: there is nothing to compare: {why}",
            source.path
        ))
    })?;
    Ok(match as_json {
        true => json(model, &choices).pretty(),
        false => text(&choices),
    })
}

fn text(choices: &[VelocityChoice]) -> String {
    let numbers = |choice: &VelocityChoice| {
        let VelocityChoice { accel, rate, .. } = choice;
        let counts = [
            accel.flops(),
            accel.mul,
            accel.add,
            accel.div,
            accel.sincos,
            rate.flops(),
        ];
        counts.map(|count| count.to_string()).to_vec()
    };
    // Tables align the first column left: it is left empty here, so that all numbers are aligned right.
    let first = |row: Vec<String>| [vec![String::new()], row].concat();
    let heading = ["accel", "mul", "add", "div", "sincos", "rate"].map(String::from);
    let rows: Vec<Vec<String>> = std::iter::once(heading.to_vec())
        .chain(choices.iter().map(numbers))
        .map(first)
        .collect();
    let widths = columns::widths(&rows);
    let line = |row: &[String]| columns::line(row, &widths, "");
    let heading = line(&rows[0]);
    let indent = heading.chars().count() + 2;
    let mut text = format!("\x1b[1m{heading}\x1b[0m  velocities\n");
    for (choice, row) in choices.iter().zip(&rows[1..]) {
        text.push_str(&format!("{}  {}\n", line(row), choice.label));
        if !choice.as_written {
            for statement in &choice.statements {
                text.push_str(&format!("{:indent$}{statement}\n", ""));
            }
        }
    }
    text
}

fn json(model: &Model, choices: &[VelocityChoice]) -> Json {
    let counts = |count: &Count| {
        Json::object(
            [
                ("add", count.add),
                ("mul", count.mul),
                ("div", count.div),
                ("sqrt", count.sqrt),
                ("sincos", count.sincos),
                ("other", count.other),
                ("flops", count.flops()),
            ]
            .map(|(name, number)| (name, Json::Count(number as u128))),
        )
    };
    let choices = choices.iter().map(|choice| {
        Json::object([
            ("velocities", Json::Text(choice.label.clone())),
            (
                "as_written",
                Json::Text(if choice.as_written { "yes" } else { "no" }.into()),
            ),
            ("accel", counts(&choice.accel)),
            ("rate", counts(&choice.rate)),
            ("statements", Json::texts(&choice.statements)),
        ])
    });
    Json::object([
        ("system", Json::Text(model.name.clone())),
        ("choices", Json::List(choices.collect())),
    ])
}

#[cfg(test)]
mod tests {
    use super::text;
    use hamel_codegen::derive::adviser::VelocityChoice;
    use hamel_codegen::generate::from_text;
    use hamel_codegen::program::count::Count;

    #[test]
    fn counts_of_any_width_stand_apart() {
        let description = "system S { coord q; velocity w; rate q = w; kinetic w^2 / 2; }";
        let count = Count {
            add: 1_074_233,
            mul: 1_074_233_000,
            ..Count::default()
        };
        let choice = VelocityChoice {
            label: "angles".into(),
            statements: vec!["rate q = w;".into()],
            as_written: false,
            accel: count,
            rate: count,
            model: from_text(description).expect("sound").model,
        };
        let table = text(&[choice]).replace("\x1b[1m", "");
        let lines: Vec<&str> = table.lines().collect();
        let cells = |line: &str| line.split("  ").filter(|cell| !cell.is_empty()).count();
        assert_eq!((cells(lines[0]), cells(lines[1])), (7, 7), "{table}");
        // Statements are aligned below the labels.
        assert_eq!(lines[1].find("angles"), lines[2].find("rate q"), "{table}");
    }
}

//! `hamel ops --advise`: what ξ̇ costs in other velocity coordinates.

use crate::failure::{Failure, print};
use crate::json::Json;
use crate::source::Source;
use hamel_codegen::derive::adviser::{Choice, advise};
use hamel_codegen::model::Model;
use hamel_codegen::program::count::Count;

/// Compares and prints.
pub fn run(source: &Source, model: &Model, as_json: bool) -> Result<(), Failure> {
    let choices = advise(model).map_err(|why| {
        Failure::failed(format!(
            "{}: there is nothing to compare: {why}",
            source.path
        ))
    })?;
    print(&if as_json {
        json(model, &choices).pretty()
    } else {
        text(&choices)
    })
}

fn text(choices: &[Choice]) -> String {
    let mut text = format!(
        "\x1b[1m{:>6}{:>6}{:>6}{:>5}{:>8}{:>6}\x1b[0m  velocities\n",
        "accel", "mul", "add", "div", "sincos", "rate"
    );
    for choice in choices {
        let Choice { accel, rate, .. } = choice;
        text.push_str(&format!(
            "{:>6}{:>6}{:>6}{:>5}{:>8}{:>6}  {}\n",
            accel.flops(),
            accel.mul,
            accel.add,
            accel.div,
            accel.sincos,
            rate.flops(),
            choice.label
        ));
        if !choice.as_written {
            for statement in &choice.statements {
                text.push_str(&format!("{:39}{statement}\n", ""));
            }
        }
    }
    text
}

fn json(model: &Model, choices: &[Choice]) -> Json {
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

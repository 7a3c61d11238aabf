//! The tables of the free rigid body as printed in KR18.

use super::{index, printed, values};
use crate::derived::model;
use hamel_codegen::tables::Table;
use serde_json::Value;

fn triple(digits: &str) -> Vec<usize> {
    let digits = digits.chars();
    digits.map(|digit| digit as usize - '0' as usize).collect()
}

#[test]
fn gamma_of_the_free_body_is_that_of_the_paper() {
    // KR18 (39).
    let upper = [
        "261", "531", "342", "612", "153", "423", "564", "645", "456",
    ];
    let mut paper = Vec::new();
    for digits in upper {
        let index = triple(digits);
        paper.push((vec![index[1], index[0], index[2]], "-1".to_string()));
        paper.push((index, "1".to_string()));
    }
    paper.sort();
    let gamma = |name: &str| values(model(name).generated(), Table::Gamma);
    assert_eq!(gamma("free_body"), paper);
    for entry in &mut paper {
        entry.1 = if entry.1 == "1" {
            "-1".into()
        } else {
            "1".into()
        };
    }
    // In world axes, the structure constants of the rotations have the opposite sign, and those with the velocity
    // vanish.
    paper.retain(|(index, _)| index.iter().all(|&i| i > 3));
    assert_eq!(gamma("free_body_world"), paper);
}

#[test]
fn connection_of_the_free_body_is_that_of_the_paper() {
    // KR18 (45): value, indices ijk, and whether it is negated.
    let paper = [
        ("m", "135 216 324", "315 126 234"),
        ("m*s[1]", "254 364 515 616", "524 634 155 166"),
        ("m*s[2]", "145 365 424 626", "415 635 244 266"),
        ("m*s[3]", "146 256 434 535", "416 526 344 355"),
        ("(Theta[1,1] - Theta[2,2] - Theta[3,3])/2", "564", "654"),
        ("(Theta[2,2] - Theta[1,1] - Theta[3,3])/2", "645", "465"),
        ("(Theta[3,3] - Theta[1,1] - Theta[2,2])/2", "456", "546"),
        ("Theta[1,2]", "565 644", "655 464"),
        ("Theta[1,3]", "454 566", "544 656"),
        ("Theta[2,3]", "455 646", "545 466"),
    ];
    let list = |digits: &str| {
        let mut list: Vec<Vec<usize>> = digits.split(' ').map(triple).collect();
        list.sort();
        list
    };
    let mut paper: Vec<_> = paper
        .iter()
        .map(|(value, plus, minus)| (value.to_string(), list(plus), list(minus)))
        .collect();
    paper.sort();
    let printed = printed(model("free_body").generated(), Table::Connection);
    assert_eq!(printed["entries"].as_array().map(Vec::len), Some(48));
    let groups = printed["groups"].as_array().expect("a list").iter();
    let indices = |list: &Value| -> Vec<Vec<usize>> {
        list.as_array().expect("a list").iter().map(index).collect()
    };
    let mut ours: Vec<_> = groups
        .map(|group| {
            let value = group["value"].as_str().expect("a text").to_string();
            (value, indices(&group["plus"]), indices(&group["minus"]))
        })
        .collect();
    ours.sort();
    assert_eq!(ours, paper);
}

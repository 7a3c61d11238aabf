//! The tables of the free rigid body as KR18 prints them.

use super::{fixture, listing, values};
use crate::tables::Table;
use crate::tables::print::Notation;

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
    assert_eq!(values(&listing(fixture("free_body"), Table::Gamma)), paper);
    for entry in &mut paper {
        entry.1 = if entry.1 == "1" {
            "-1".into()
        } else {
            "1".into()
        };
    }
    // In world axes spin commutes with the opposite sign, and not with the velocity.
    paper.retain(|(index, _)| index.iter().all(|&i| i > 3));
    assert_eq!(
        values(&listing(fixture("free_body_world"), Table::Gamma)),
        paper
    );
}

#[test]
fn connection_of_the_free_body_is_that_of_the_paper() {
    // KR18 (45): value, indices ijk, negative of it.
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
    let listing = listing(fixture("free_body"), Table::Connection);
    assert_eq!(listing.entries.len(), 48);
    let groups = listing.groups.iter();
    let mut ours: Vec<_> = groups
        .map(|g| {
            (
                Notation::Text.term(&g.value),
                g.plus.clone(),
                g.minus.clone(),
            )
        })
        .collect();
    ours.sort();
    assert_eq!(ours, paper);
}

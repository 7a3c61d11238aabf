//! `--plot`: draws the kept results over the varied entries.

use super::folder::{Finished, Folder};
use super::shard::{Columns, numbers};
use crate::failure::{self, Failure};
use hamel_files::number::group_thousands;
use hamel_report::plot::{Scatter, scatter};
use std::path::Path;

/// Largest number of members drawn, evenly spread over all.
const MAX_POINTS: u64 = 4000;
/// Largest numbers of causes and results drawn; the title gives the totals.
const MAX_CAUSES: usize = 3;
const MAX_RESULTS: usize = 4;

/// Draws the finished members of a folder.
pub fn run(
    place: &Path,
    name: &str,
    columns: &Columns,
    folder: &Folder,
    there: &Finished,
) -> Result<(), Failure> {
    let causes: Vec<&String> = columns.varied.iter().take(MAX_CAUSES).collect();
    let mut read: Vec<Vec<f64>> = vec![Vec::new(); columns.varied.len() + columns.kept.len()];
    for shard in &there.shards {
        let path = folder.place(*shard);
        let all = numbers(&path, read.len());
        let all =
            all.map_err(|why| Failure::failed(format!("cannot read {}: {why}", path.display())))?;
        read.iter_mut()
            .zip(all)
            .for_each(|(to, from)| to.extend(from));
    }
    let step = there.members.div_ceil(MAX_POINTS).max(1) as usize;
    let column = |index: usize| -> Vec<f64> { read[index].iter().copied().step_by(step).collect() };
    let across = causes.iter().enumerate();
    let across = across.map(|(index, name)| ((*name).clone(), column(index)));
    let results = columns.kept.iter().enumerate();
    let results = results.map(|(index, name)| (name.clone(), column(columns.varied.len() + index)));
    let results = results.filter(|(_, values)| differ(values));
    let drawn = there.members.div_ceil(step as u64);
    let mut subtitle = format!("{} members", group_thousands(there.members));
    if drawn < there.members {
        subtitle = format!("{} of {subtitle}", group_thousands(drawn));
    }
    let picture = Scatter {
        title: name.into(),
        subtitle,
        across: across.collect(),
        up: results.take(MAX_RESULTS).collect(),
    };
    let figure = scatter(&picture).map_err(|why| Failure::failed(why.to_string()))?;
    failure::write(place, &figure.standalone())
}

/// Returns whether a result varies: the end time does not if all members reach it.
fn differ(values: &[f64]) -> bool {
    let mut finite = values.iter().filter(|value| value.is_finite());
    let first = finite.next();
    finite.any(|value| Some(value) != first)
}

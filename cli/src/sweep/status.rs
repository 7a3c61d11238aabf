//! `hamel sweep --status`: shows the progress of a sweep.

use super::folder::{find_finished, read_manifest};
use crate::columns::aligned;
use crate::failure::{Failure, print};
use hamel_files::number::group_thousands;
use std::path::Path;

/// Largest number of ranges of missing shards listed.
const MAX_LISTED_RANGES: usize = 8;

/// Prints the finished and the missing parts of a folder.
pub fn run(path: &Path) -> Result<(), Failure> {
    let Some(manifest) = read_manifest(path)? else {
        return Err(Failure::usage(format!(
            "{} is not a sweep folder: `_sweep.json` is missing",
            path.display()
        )));
    };
    let there = find_finished(path, &manifest)?;
    let row = |name: &str, value: String| vec![name.to_string(), value];
    let of = |done: u64, all: u64| format!("{} of {}", group_thousands(done), group_thousands(all));
    let mut rows = vec![
        row("shards", of(there.shards.len() as u64, manifest.shards())),
        row("members", of(there.members, manifest.count)),
        row("failed", group_thousands(there.failed)),
    ];
    let missing = missing(&there.shards, manifest.shards());
    if !missing.is_empty() {
        let listed: Vec<&str> = missing
            .iter()
            .take(MAX_LISTED_RANGES)
            .map(String::as_str)
            .collect();
        let more = if missing.len() > MAX_LISTED_RANGES {
            ", …"
        } else {
            ""
        };
        rows.push(row(
            "missing",
            format!("shards {}{more}", listed.join(", ")),
        ));
    }
    let heading = |name: &str| manifest.word(name).unwrap_or("").to_string();
    print(&format!(
        "\x1b[1m{}\x1b[0m  {}\n{}",
        path.display(),
        heading("vary"),
        aligned(&rows, "  ")
    ))
}

/// Returns the missing shards, as ranges.
fn missing(there: &[u64], all: u64) -> Vec<String> {
    let mut ranges = Vec::new();
    let mut next = 0;
    for shard in there.iter().copied().chain([all]) {
        match shard - next {
            0 => {}
            1 => ranges.push(format!("{next}")),
            _ => ranges.push(format!("{next} to {}", shard - 1)),
        }
        next = shard + 1;
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::missing;

    #[test]
    fn what_is_missing_is_said_as_ranges() {
        assert_eq!(missing(&[0, 1, 4, 6], 10), ["2 to 3", "5", "7 to 9"]);
        assert_eq!(missing(&[], 2), ["0 to 1"]);
        assert!(missing(&[0, 1], 2).is_empty());
    }
}

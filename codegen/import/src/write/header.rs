//! Writes the header of a description: its source, and the numbers that were changed.

use super::Writer;
use super::draft::plain;
use crate::options::Mimic;
use crate::plan::Mobility;
use crate::problem::{Problem, place};
use crate::robot::Cleaned;

/// Describes the changed numbers in the order of the file, one sentence for each spelling.
pub(super) fn cleaned(xml: &str, list: &[Cleaned]) -> Vec<String> {
    let mut kinds: Vec<(&Cleaned, usize)> = Vec::new();
    for change in list {
        let same = |(known, _): &&mut (&Cleaned, usize)| {
            known.written == change.written && known.read == change.read
        };
        match kinds.iter_mut().find(same) {
            Some((_, count)) => *count += 1,
            None => kinds.push((change, 1)),
        }
    }
    kinds
        .into_iter()
        .map(|(change, count)| {
            let (line, _) = place(xml, change.range.start);
            let (written, read) = (&change.written, &change.read);
            match count {
                1 => format!("{written} is read as {read} (line {line})"),
                _ => format!("{written} is read as {read} ({count} times, first in line {line})"),
            }
        })
        .collect()
}

impl Writer<'_> {
    /// Returns the documentation of the system.
    pub(super) fn docs(&self) -> Vec<String> {
        let options = self.options;
        let robot = plain(&self.robot.name);
        let base = if options.floating {
            "floating"
        } else {
            "fixed"
        };
        let count = self.free().count();
        let plural = if count == 1 { "" } else { "s" };
        let mut command = format!("hamel import {}", plain(&options.file));
        if options.floating {
            command.push_str(" --floating");
        }
        for (joint, value) in &options.locks {
            let lock = format!("{}={}", plain(joint), plain(value));
            match lock.contains(' ') {
                true => command.push_str(&format!(" --lock '{lock}'")),
                false => command.push_str(&format!(" --lock {lock}")),
            }
        }
        if options.params {
            command.push_str(" --params");
        }
        if options.mimic == Mimic::Free {
            command.push_str(" --mimic free");
        }
        if let Some(name) = &options.name {
            command.push_str(&format!(" --name {}", plain(name)));
        }
        if options.tolerance != crate::TOLERANCE {
            command.push_str(&format!(" --rounding {:e}", options.tolerance));
        }
        vec![
            format!("The robot `{robot}`, {base} base, {count} moving joint{plural}."),
            String::new(),
            format!("Written by `{command}`."),
        ]
    }

    /// Returns the comments above the system: changed numbers, warnings, and names that differ from those in the URDF.
    pub(super) fn notes(&self, cleaned: &[String], warnings: &[Problem]) -> Vec<String> {
        let mut notes = Vec::new();
        if !cleaned.is_empty() {
            let tolerance = self.options.tolerance;
            notes.push(String::new());
            notes.push(format!(
                "Corrected as rounding errors, within {tolerance:e}:"
            ));
            notes.extend(cleaned.iter().map(|change| format!("- {change}")));
        }
        if !warnings.is_empty() {
            notes.push(String::new());
            notes.push("Warnings, each with its line in the URDF:".into());
            let line = |warning: &Problem| format!("- {}: {}", warning.line, warning.message);
            notes.extend(warnings.iter().map(line));
        }
        let robot = self.robot;
        let joints = robot.joints.iter().map(|joint| &joint.name.name);
        let joints = joints.zip(&self.names.joints);
        let links = robot.links.iter().map(|link| &link.name.name);
        let links = links.zip(&self.names.links);
        let loops = robot.loops.iter().map(|closing| &closing.name.name);
        let loops = loops.zip(&self.names.loops);
        let pairs = joints.chain(links).chain(loops);
        let mut pairs = pairs.filter(|(written, name)| written != name).peekable();
        if pairs.peek().is_some() {
            notes.push(String::new());
            notes.push("Names that are none here, or are taken:".into());
            notes.extend(pairs.map(|(written, name)| format!("- `{written}` is `{name}`")));
        }
        notes
    }

    /// Writes masses, centres of mass and inertias as parameters, which a program may change.
    pub(super) fn parameters(&mut self) {
        if !self.options.params {
            return;
        }
        for link in self.bodies() {
            self.parameters_of(link);
        }
        self.draft.blank();
    }

    /// Returns the moving links with mass, in the order of the tree.
    pub(super) fn bodies(&self) -> Vec<usize> {
        let moving = self.moving();
        let order = self.tree.joints.iter().map(|edge| edge.child);
        std::iter::once(self.tree.root)
            .chain(order)
            .filter(|&link| {
                let inertial = self.robot.links[link].inertial.as_ref();
                moving[link] && inertial.is_some_and(|inertial| !inertial.is_zero())
            })
            .collect()
    }

    /// Whether a joint has a coordinate of its own that other joints follow.
    pub(super) fn is_followed(&self, joint: usize) -> bool {
        self.plan.followed[joint] && self.plan.motions[joint] == Mobility::Free
    }
}

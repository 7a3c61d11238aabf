//! Writes the header of a description: where it comes from and which numbers were changed.

use super::Writer;
use super::page::plain;
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
    pub(super) fn header(&mut self, cleaned: &[String], warnings: &[Problem]) {
        let options = self.options;
        let robot = plain(&self.robot.name);
        let base = if options.floating {
            "floating"
        } else {
            "fixed"
        };
        let count = self.free().count();
        let plural = if count == 1 { "" } else { "s" };
        self.page.top(&format!(
            "/// The robot `{robot}`, {base} base, {count} moving joint{plural}."
        ));
        self.page.top("///");
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
        self.page.top(&format!("/// Written by `{command}`."));
        if !cleaned.is_empty() {
            self.page.top("//");
            let tolerance = options.tolerance;
            self.page.top(&format!(
                "// Corrected as rounding errors, within {tolerance:e}:"
            ));
            for change in cleaned {
                self.page.top(&format!("// - {change}"));
            }
        }
        if !warnings.is_empty() {
            self.page.top("//");
            self.page
                .top("// Warnings, each with its line in the URDF:");
            for warning in warnings {
                let (line, message) = (warning.line, plain(&warning.message));
                self.page.top(&format!("// - {line}: {message}"));
            }
        }
        let pairs: Vec<(String, String)> = {
            let robot = self.robot;
            let links = robot.links.iter().zip(&self.names.links);
            let links = links.map(|(link, name)| (link.name.name.clone(), name.clone()));
            let joints = robot.joints.iter().zip(&self.names.joints);
            let joints = joints.map(|(joint, name)| (joint.name.name.clone(), name.clone()));
            let loops = robot.loops.iter().zip(&self.names.loops);
            let loops = loops.map(|(closing, name)| (closing.name.name.clone(), name.clone()));
            let all = joints.chain(links).chain(loops);
            all.filter(|(a, b)| a != b).collect()
        };
        if !pairs.is_empty() {
            self.page.top("//");
            self.page
                .top("// Names that are not valid here, or are taken:");
            for (written, name) in pairs {
                self.page
                    .top(&format!("// - `{}` is `{name}`", plain(&written)));
            }
        }
        let system = self.names.system.clone();
        let range = &self.robot.range;
        self.page.begin(range, &format!("pub system {system} {{"));
    }

    /// Writes masses, centres of mass and inertias as parameters, which a program may change.
    pub(super) fn parameters(&mut self) {
        if !self.options.params {
            return;
        }
        for link in self.bodies() {
            self.parameters_of(link);
        }
        self.page.blank();
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

//! How the closed list of what may stand in a URDF file is written: elements and attributes that are read, and those that are
//! no part of the equations of motion. Whatever is not on it is named in a warning.

/// The role of an element in the equations of motion.
pub(super) enum Element {
    /// What stands in it is on the list, too.
    Read(&'static Level),
    /// No part of the equations, with all that is in it.
    Apart,
    /// Changes the motion unless it holds one of these words; what to do then.
    Unless(&'static [&'static str], &'static str),
}

/// Attributes and elements of an element.
pub(super) struct Level {
    /// Names of attributes.
    pub(super) attributes: &'static [&'static str],
    /// Elements by name; a `*` at the end stands for any ending.
    pub(super) elements: &'static [(&'static [&'static str], Element)],
    /// What to do about attributes and elements that are not on the list.
    pub(super) help: &'static str,
}

impl Level {
    /// The element of a name.
    pub(super) fn find(&self, name: &str) -> Option<&'static Element> {
        let same = |listed: &&str| match listed.strip_suffix('*') {
            Some(start) => name.starts_with(start),
            None => *listed == name,
        };
        let mut elements = self.elements.iter();
        elements
            .find(|(names, _)| names.iter().any(&same))
            .map(|(_, element)| element)
    }

    /// Names of elements that are read, and of the others.
    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        let names = self.elements.iter().flat_map(|(names, _)| names.iter());
        names.copied().filter(|name| !name.ends_with('*'))
    }
}

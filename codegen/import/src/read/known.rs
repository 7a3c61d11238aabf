//! Types for the closed list of elements and attributes that a URDF file may contain: those that are read, and those
//! that do not affect the equations of motion. Anything that is not on the list causes a warning.

/// The role of an element in the equations of motion.
pub(super) enum Element {
    /// It is read; the level lists its contents.
    Read(&'static Level),
    /// It does not affect the equations, and neither do its contents.
    Apart,
    /// It changes the motion unless its value is one of these words; the text says what to do about it.
    Unless(&'static [&'static str], &'static str),
}

/// Attributes and child elements of an element.
pub(super) struct Level {
    /// Names of attributes.
    pub(super) attributes: &'static [&'static str],
    /// Child elements by name; a `*` at the end of a name matches any ending.
    pub(super) elements: &'static [(&'static [&'static str], Element)],
    /// Advice for attributes and elements that are not on the list.
    pub(super) help: &'static str,
}

impl Level {
    /// Finds an element by name.
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

    /// Returns the names of all child elements on the list, without patterns.
    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        let names = self.elements.iter().flat_map(|(names, _)| names.iter());
        names.copied().filter(|name| !name.ends_with('*'))
    }
}

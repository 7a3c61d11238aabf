//! Lines of the description, each with the place in the URDF that it is made from.

use std::ops::Range;

/// Lines up to this width.
pub(super) const WIDTH: usize = 110;

/// Names and paths as a comment quotes them: as they are, without what would end its line.
pub(super) fn plain(text: &str) -> String {
    text.replace(|c: char| c.is_control(), " ")
}

/// The text so far.
#[derive(Default)]
pub(super) struct Page {
    pub(super) text: String,
    pub(super) origins: Vec<Option<Range<usize>>>,
}

impl Page {
    /// A line at the left margin.
    pub(super) fn top(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
        self.origins.push(None);
    }

    /// The line that begins the system, of the element `<robot>`.
    pub(super) fn begin(&mut self, origin: &Range<usize>, text: &str) {
        self.top(text);
        if let Some(last) = self.origins.last_mut() {
            *last = Some(origin.clone());
        }
    }

    /// A comment in the braces of the system, which may quote names of the file.
    pub(super) fn comment(&mut self, origin: &Range<usize>, text: &str) {
        self.line(Some(origin), &format!("// {}", plain(text)));
    }

    /// A statement in the braces of the system.
    pub(super) fn line(&mut self, origin: Option<&Range<usize>>, text: &str) {
        self.text.push_str("    ");
        self.text.push_str(text);
        self.text.push('\n');
        self.origins.push(origin.cloned());
    }

    /// An empty line, unless there is one.
    pub(super) fn blank(&mut self) {
        if !self.text.ends_with("\n\n") && !self.text.ends_with("{\n") {
            self.text.push('\n');
            self.origins.push(None);
        }
    }

    /// The end of the system.
    pub(super) fn close(&mut self) {
        self.top("}");
    }

    /// `word a, b, c;`, over several lines where one is too long.
    pub(super) fn list(&mut self, word: &str, items: &[String]) {
        let Some((last, rest)) = items.split_last() else {
            return;
        };
        let mut line = word.to_string();
        let pieces = rest.iter().map(|item| format!(" {item},"));
        for piece in pieces.chain(std::iter::once(format!(" {last};"))) {
            if line.len() + piece.len() > WIDTH {
                self.line(None, &line);
                line = "   ".into();
            }
            line.push_str(&piece);
        }
        self.line(None, &line);
    }
}

//! Lines of the description, each with the range of the URDF that it was made from.

use std::ops::Range;

/// Largest width of a line.
pub(super) const WIDTH: usize = 110;

/// Prepares a name or path for a comment: control characters, which could end the line, become blanks.
pub(super) fn plain(text: &str) -> String {
    text.replace(|c: char| c.is_control(), " ")
}

/// The text written so far.
#[derive(Default)]
pub(super) struct Page {
    pub(super) text: String,
    pub(super) origins: Vec<Option<Range<usize>>>,
}

impl Page {
    /// Writes a line at the left margin.
    pub(super) fn top(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
        self.origins.push(None);
    }

    /// Writes the line that begins the system, with the place of `<robot>`.
    pub(super) fn begin(&mut self, origin: &Range<usize>, text: &str) {
        self.top(text);
        if let Some(last) = self.origins.last_mut() {
            *last = Some(origin.clone());
        }
    }

    /// Writes a comment inside the system, which may quote names of the file.
    pub(super) fn comment(&mut self, origin: &Range<usize>, text: &str) {
        self.line(Some(origin), &format!("// {}", plain(text)));
    }

    /// Writes a statement inside the system.
    pub(super) fn line(&mut self, origin: Option<&Range<usize>>, text: &str) {
        self.text.push_str("    ");
        self.text.push_str(text);
        self.text.push('\n');
        self.origins.push(origin.cloned());
    }

    /// Writes an empty line, unless there is one already.
    pub(super) fn blank(&mut self) {
        if !self.text.ends_with("\n\n") && !self.text.ends_with("{\n") {
            self.text.push('\n');
            self.origins.push(None);
        }
    }

    /// Writes the end of the system.
    pub(super) fn close(&mut self) {
        self.top("}");
    }

    /// Writes `word a, b, c;`, over several lines if it is too long for one.
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

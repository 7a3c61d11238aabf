//! The statements written so far, each with the part of the URDF that it was made from.

use hamel_language::syntax::ast::visit::{Visit, places, visit};
use hamel_language::syntax::ast::{
    Expr, Ident, Item, ItemKind, Origins, Remark, Remarks, Span, Target,
};
use hamel_language::syntax::print;
use std::ops::Range;

/// Prepares a name or path for documentation: control characters, which could end the line, become blanks.
pub(super) fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// The statements written so far.
pub(super) struct Draft {
    pub(super) items: Vec<Item>,
    pub(super) remarks: Remarks,
    pub(super) origins: Origins,
}

impl Draft {
    /// Creates a description without statements, of a robot in this file.
    pub(super) fn of(xml: &str) -> Draft {
        Draft {
            items: Vec::new(),
            remarks: Remarks::default(),
            origins: Origins::behind(xml.len()),
        }
    }

    /// Adds a statement, with the range of the URDF that it was made from.
    pub(super) fn statement(&mut self, origin: &Range<usize>, kind: ItemKind) {
        let span = Span::NOWHERE;
        let mut item = Item { kind, span };
        let lines = print::statement(&item);
        let line: Vec<&str> = lines.lines().map(str::trim).collect();
        let span = self.origins.import(origin.clone(), line.join(" "));
        visit(&mut item, &mut Place(span));
        self.items.push(item);
    }

    /// Adds a comment.
    pub(super) fn comment(&mut self, text: impl Into<String>) {
        let remark = Remark::Comment(text.into());
        self.remarks.add(self.items.len(), remark);
    }

    /// Adds an empty line, unless there is one already or nothing stands above it.
    pub(super) fn blank(&mut self) {
        let index = self.items.len();
        let needed = match self.remarks.above(index) {
            [] => index > 0,
            [.., last] => *last != Remark::Blank,
        };
        if needed {
            self.remarks.add(index, Remark::Blank);
        }
    }
}

/// Gives all parts of a statement the same place.
struct Place(Span);

impl Visit for Place {
    fn declares(&mut self, name: &mut Ident, _: bool) {
        name.span = self.0;
    }

    fn uses(&mut self, name: &mut Ident) {
        name.span = self.0;
    }

    fn target(&mut self, target: &mut Target) {
        target.name.span = self.0;
        target
            .field
            .iter_mut()
            .for_each(|field| field.span = self.0);
    }

    fn expr(&mut self, expr: &mut Expr) {
        places(expr, &mut |span| *span = self.0);
    }

    fn place(&mut self, span: &mut Span) {
        *span = self.0;
    }
}

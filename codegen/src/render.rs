//! Presentation of errors and warnings: underlined source in a terminal, or compiler errors.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, TokenStream, TokenTree};

use crate::diagnostics::Diagnostic;
use crate::syntax::Places;

/// Returns the errors as calls of `compile_error!`, each placed on its region of the macro's input.
pub fn to_compile_errors(errors: &[Diagnostic], places: &Places) -> TokenStream {
    let errors = errors.iter();
    errors
        .flat_map(|error| compile_error(error, places))
        .collect()
}

/// Returns compiler warnings for code that is legal but looks like a mistake. Each warning is the use of a deprecated
/// constant, with the message as the reason for the deprecation, at the place of the warning. A macro has no other way
/// to warn.
pub fn to_compile_warnings(list: &[Diagnostic], places: &Places) -> TokenStream {
    let one = |warning: &Diagnostic| {
        let (first, _) = places.ends(warning.span);
        let note = match &warning.help {
            Some(help) => format!("{}\nhelp: {help}", warning.message),
            None => warning.message.clone(),
        };
        let name = Ident::new("LOOKS_LIKE_A_MISTAKE", first);
        quote::quote! {
            const _: () = {
                #[deprecated(note = #note)]
                const #name: () = ();
                #name
            };
        }
    };
    list.iter().map(one).collect()
}

/// Builds `::core::compile_error! { "message" }`. The compiler underlines from the span of its first token to that of
/// its last.
fn compile_error(error: &Diagnostic, places: &Places) -> [TokenTree; 8] {
    let mut message = error.message.clone();
    let mut span = error.span;
    // An error in an included file is shown at the statement that includes the file.
    while let Some((text, range)) = error.texts.find(span) {
        let (line, column) = text.line(range.start);
        message = match span.range() == error.span.range() {
            true => format!("{}:{line}:{column}: {message}", text.name),
            false => format!("{message}\nincluded at {}:{line}:{column}", text.name),
        };
        span = text.by;
    }
    let (first, last) = places.ends(span);
    let text = match &error.help {
        Some(help) => format!("{message}\nhelp: {help}"),
        None => message,
    };
    let punct = |c: char, spacing: Spacing| {
        let mut punct = Punct::new(c, spacing);
        punct.set_span(first);
        TokenTree::Punct(punct)
    };
    let word = |name: &str| TokenTree::Ident(Ident::new(name, first));
    let mut literal = Literal::string(&text);
    literal.set_span(last);
    let mut group = Group::new(Delimiter::Brace, TokenTree::Literal(literal).into());
    group.set_span(last);
    [
        punct(':', Spacing::Joint),
        punct(':', Spacing::Alone),
        word("core"),
        punct(':', Spacing::Joint),
        punct(':', Spacing::Alone),
        word("compile_error"),
        punct('!', Spacing::Alone),
        TokenTree::Group(group),
    ]
}

#[cfg(feature = "files")]
pub use text::{Level, Note, notes, render, span_bytes, warnings};

#[cfg(feature = "files")]
mod text {
    use std::borrow::Cow;
    use std::ops::Range;
    use std::path::Path;

    use annotate_snippets::renderer::DecorStyle;
    use annotate_snippets::{AnnotationKind, Group, Origin, Renderer, Snippet};

    use crate::diagnostics::Diagnostic;
    use crate::syntax::ast::Span;

    /// Renders the errors in the order of the text, each with its source underlined, and their number.
    ///
    /// `path` is the name shown for the file, `source` the parsed text; `color` adds terminal colours.
    pub fn render(errors: &[Diagnostic], path: &str, source: &str, color: bool) -> String {
        let mut rendered = listed(errors, Level::Error, path, source, color);
        let plural = if errors.len() == 1 { "" } else { "s" };
        rendered.push_str(&format!("{} error{plural}\n", errors.len()));
        rendered
    }

    /// Renders the warnings in the order of the text, each with its source underlined. Empty if there are none.
    pub fn warnings(list: &[Diagnostic], path: &str, source: &str, color: bool) -> String {
        listed(list, Level::Warning, path, source, color)
    }

    fn listed(list: &[Diagnostic], level: Level, path: &str, source: &str, color: bool) -> String {
        let renderer = renderer(color);
        let mut placed: Vec<&Diagnostic> = list.iter().collect();
        placed.sort_by_key(|error| {
            error
                .span
                .range()
                .map_or((0, 0), |range| (range.start, range.end))
        });

        let mut rendered = String::new();
        for error in placed {
            rendered.push_str(&renderer.render(&[group(error, level, path, source)]));
            rendered.push_str("\n\n");
        }
        rendered
    }

    fn renderer(color: bool) -> Renderer {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.decor_style(DecorStyle::Ascii)
    }

    /// Severity of a note.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Level {
        /// The text is wrong.
        Error,
        /// The text is legal but looks like a mistake.
        Warning,
    }

    impl Level {
        fn title(self) -> annotate_snippets::Level<'static> {
            match self {
                Level::Error => annotate_snippets::Level::ERROR,
                Level::Warning => annotate_snippets::Level::WARNING,
            }
        }
    }

    /// An error or a warning about a text that is not a description.
    #[derive(Clone, Debug)]
    pub struct Note {
        /// Byte range of the note in the text.
        pub range: Range<usize>,
        /// The message.
        pub message: String,
        /// Suggested fixes, one sentence each.
        pub help: Vec<String>,
    }

    /// Renders the notes in the order of the text, each with its source underlined; for errors, also their number.
    pub fn notes(list: &[Note], level: Level, path: &str, source: &str, color: bool) -> String {
        let renderer = renderer(color);
        let mut sorted: Vec<&Note> = list.iter().collect();
        sorted.sort_by_key(|note| (note.range.start, note.range.end));
        let mut rendered = String::new();
        for note in sorted {
            let places = vec![(AnnotationKind::Primary, note.range.clone(), "")];
            let help = note.help.iter();
            let help = help.map(|help| annotate_snippets::Level::HELP.message(help.as_str()));
            let group = level
                .title()
                .primary_title(note.message.as_str())
                .element(snippet(places, path, source))
                .elements(help);
            rendered.push_str(&renderer.render(&[group]));
            rendered.push_str("\n\n");
        }
        if level == Level::Error {
            let plural = if list.len() == 1 { "" } else { "s" };
            rendered.push_str(&format!("{} error{plural}\n", list.len()));
        }
        rendered
    }

    /// Finds a region in the description or in an included text. Returns the path of that text, the text, and the byte
    /// range.
    fn found<'a>(
        span: Span,
        error: &'a Diagnostic,
        path: &'a str,
        source: &'a str,
    ) -> Option<(Cow<'a, str>, &'a str, Range<usize>)> {
        if let Some((text, range)) = error.texts.find(span) {
            let range = within(range, &text.text);
            return Some((beside(path, &text.name), &text.text, range));
        }
        Some((path.into(), source, place(span, source)?))
    }

    /// Resolves a file name relative to the folder of the description's path.
    fn beside<'a>(path: &str, name: &'a str) -> Cow<'a, str> {
        let folder = Path::new(path).parent();
        match folder.filter(|folder| !folder.as_os_str().is_empty()) {
            Some(folder) => folder.join(name).display().to_string().into(),
            None => name.into(),
        }
    }

    fn group<'a>(error: &'a Diagnostic, level: Level, path: &'a str, source: &'a str) -> Group<'a> {
        let title = level.title().primary_title(error.message.as_str());
        let mut group = Group::with_title(title);
        let mut messages = Vec::new();
        let primary = found(error.span, error, path, source);
        let notes = error.notes.iter().map(|(span, label)| {
            let place = primary.as_ref().and(found(*span, error, path, source));
            (AnnotationKind::Context, place, label.as_str())
        });
        let none = primary.is_none();
        let primary = primary.clone().map(Some).into_iter();
        let primary = primary.map(|place| (AnnotationKind::Primary, place, ""));
        // One snippet per text, starting with the text of the error.
        let mut snippets: Vec<(Cow<'a, str>, &str, Vec<_>)> = Vec::new();
        for (kind, place, label) in primary.chain(notes) {
            let Some((name, text, range)) = place else {
                messages.push(annotate_snippets::Level::NOTE.message(label));
                continue;
            };
            match snippets.iter_mut().find(|(known, ..)| *known == name) {
                Some((_, _, places)) => places.push((kind, range, label)),
                None => snippets.push((name, text, vec![(kind, range, label)])),
            }
        }
        if none {
            group = group.element(Origin::path(path).line(1).char_column(1));
        }
        for (name, text, places) in snippets {
            group = group.element(snippet(places, name, text));
        }
        if let Some(help) = &error.help {
            messages.push(annotate_snippets::Level::HELP.message(help.as_str()));
        }
        if let Some(statement) = error.texts.statement() {
            let help = format!("the description made from it contains `{statement}`");
            messages.push(annotate_snippets::Level::HELP.message(help));
        }
        group.elements(messages)
    }

    /// Returns the lines from the first place to the last, with the places underlined.
    fn snippet<'a>(
        places: Vec<(AnnotationKind, Range<usize>, &'a str)>,
        path: impl Into<Cow<'a, str>>,
        source: &'a str,
    ) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let start = places
            .iter()
            .map(|(_, range, _)| range.start)
            .min()
            .unwrap_or(0);
        let end = places
            .iter()
            .map(|(_, range, _)| range.end)
            .max()
            .unwrap_or(0);
        let mark = if source.starts_with('\u{feff}') {
            '\u{feff}'.len_utf8()
        } else {
            0
        };
        let first = source[..start]
            .rfind('\n')
            .map_or(mark.min(start), |newline| newline + 1);
        let last = source[end..]
            .find('\n')
            .map_or(source.len(), |newline| end + newline);
        let last = if source[end..last].ends_with('\r') {
            last - 1
        } else {
            last
        };
        let line = source[..first].matches('\n').count() + 1;
        let annotations = places.into_iter().map(|(kind, range, label)| {
            let annotation = kind.span(range.start - first..range.end - first);
            if label.is_empty() {
                annotation
            } else {
                annotation.label(label)
            }
        });
        Snippet::source(&source[first..last])
            .line_start(line)
            .path(path.into())
            .annotations(annotations)
    }

    /// Returns the byte range of a region in a text.
    pub fn span_bytes(span: Span, source: &str) -> Option<Range<usize>> {
        place(span, source)
    }

    /// Returns the byte range of a region, or `None` if the region has no place in the text.
    fn place(span: Span, source: &str) -> Option<Range<usize>> {
        let range = span.range()?;
        (range.start <= source.len()).then(|| within(range, source))
    }

    /// Clamps a range to the text and widens it to character boundaries.
    fn within(range: Range<usize>, source: &str) -> Range<usize> {
        let mut start = range.start.min(source.len());
        while !source.is_char_boundary(start) {
            start -= 1;
        }
        let mut end = range.end.min(source.len()).max(start);
        while !source.is_char_boundary(end) {
            end += 1;
        }
        start..end
    }
}

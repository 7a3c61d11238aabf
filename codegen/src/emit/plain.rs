//! The part of Rust that most lines of the generated text are written in, and its parser.
//!
//! ```text
//! statement  let PATTERN = SUM;   OPERAND = SUM;   OPERAND;   if !SUM { return RESULT::Err(PATH(WHAT)); }
//! value      SUM   [ENTRY, …]   RESULT::Ok([ENTRY, …])            entries are sums, or rows of them
//! WHAT       nothing, NUMBER or "NAME"
//! attribute  #[PATH]   #[PATH(PATH, …, name = "text")]
//! SUM        OPERAND (+ - * /) OPERAND …
//! OPERAND    - & before a name, a path, a number, () or (SUM), and behind it [NUMBER] .name .0 ? (SUM, …)
//! ```
//!
//! Every text has to be Rust before it leaves the generator. `syn` reads what is not written in this
//! language; for the rest it would take longer than all stages before.

use super::names::is_keyword;

/// Whether a text is one statement of the language.
pub fn is_statement(text: &str) -> bool {
    let mut reader = Reader::new(text);
    reader.statement() && reader.ends()
}

/// Whether a text is a sum.
pub fn is_sum(text: &str) -> bool {
    let mut reader = Reader::new(text);
    reader.sum() && reader.ends()
}

/// Whether a text is a list that stands as the value of a function.
pub fn is_value(text: &str) -> bool {
    let mut reader = Reader::new(text);
    let whole = match reader.result("Ok") {
        true => reader.take(b'(') && reader.list(true) && reader.take(b')'),
        false => reader.list(true),
    };
    whole && reader.ends()
}

/// Whether a text is an attribute of the language.
pub fn is_attribute(text: &str) -> bool {
    let mut reader = Reader::new(text);
    reader.attribute() && reader.ends()
}

/// A text, and how far it is read.
struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Self {
        Reader { text, at: 0 }
    }

    /// The byte that comes next, whatever it is; 0 at the end.
    fn byte(&self) -> u8 {
        self.text.as_bytes().get(self.at).copied().unwrap_or(0)
    }

    /// The first byte of the next token; 0 at the end.
    fn next(&mut self) -> u8 {
        while self.byte().is_ascii_whitespace() {
            self.at += 1;
        }
        self.byte()
    }

    fn ends(&mut self) -> bool {
        self.next();
        self.at == self.text.len()
    }

    /// Reads a token of one byte.
    fn take(&mut self, token: u8) -> bool {
        let found = self.next() == token;
        self.at += usize::from(found);
        found
    }

    /// Reads `::`.
    fn take_colons(&mut self) -> bool {
        self.next();
        let found = self.text.as_bytes()[self.at..].starts_with(b"::");
        self.at += 2 * usize::from(found);
        found
    }

    /// Reads as many bytes as belong together.
    fn run(&mut self, belongs: impl Fn(u8) -> bool) -> &'a str {
        let start = self.at;
        while belongs(self.byte()) {
            self.at += 1;
        }
        &self.text[start..self.at]
    }

    /// A keyword, a name, or nothing; nothing is read where it does not begin with a letter.
    fn next_word(&mut self) -> &'a str {
        let first = self.next();
        match first.is_ascii_alphabetic() || first == b'_' {
            true => self.run(|byte| byte.is_ascii_alphanumeric() || byte == b'_'),
            false => "",
        }
    }

    /// Reads this very word.
    fn word(&mut self, word: &str) -> bool {
        let before = self.at;
        let found = self.next_word() == word;
        if !found {
            self.at = before;
        }
        found
    }

    /// Reads a variant of `Result` with its whole path, which says the same wherever the text stands.
    fn result(&mut self, variant: &str) -> bool {
        let before = self.at;
        let path = ["core", "result", "Result", variant];
        let found = path
            .iter()
            .all(|word| self.take_colons() && self.word(word));
        if !found {
            self.at = before;
        }
        found
    }

    /// Reads a name that is no keyword.
    fn name(&mut self) -> bool {
        let word = self.next_word();
        !word.is_empty() && word != "_" && !is_keyword(word)
    }

    /// Reads digits, with nothing in front of them.
    fn digits(&mut self) -> bool {
        !self.run(|byte| byte.is_ascii_digit()).is_empty()
    }

    /// Reads digits alone.
    fn integer(&mut self) -> bool {
        self.next();
        self.digits()
    }

    /// Reads `1`, `1.5`, `1e300` or `1.5e-300`.
    fn number(&mut self) -> bool {
        if !self.integer() {
            return false;
        }
        if self.byte() == b'.' {
            self.at += 1;
            if !self.digits() {
                return false;
            }
        }
        if self.byte() == b'e' {
            self.at += 1;
            self.at += usize::from(self.byte() == b'-');
            return self.digits();
        }
        !(self.byte().is_ascii_alphanumeric() || self.byte() == b'_')
    }

    fn statement(&mut self) -> bool {
        if self.word("let") {
            return self.pattern() && self.take(b'=') && self.sum() && self.take(b';');
        }
        if self.word("if") {
            return self.take(b'!') && self.sum() && self.leaves();
        }
        // A place like `*out` and `out[1][2]` that is given a value, or a call.
        self.take(b'*');
        self.operand() && (!self.take(b'=') || self.sum()) && self.take(b';')
    }

    /// `{ return Err(…); }`
    fn leaves(&mut self) -> bool {
        let returns =
            self.take(b'{') && self.word("return") && self.result("Err") && self.take(b'(');
        let error = returns && self.path();
        let of = self.take(b'(') && self.what() && self.take(b')');
        error && of && self.take(b')') && self.take(b';') && self.take(b'}')
    }

    /// Nothing, a number, or a name in quotes.
    fn what(&mut self) -> bool {
        if self.next() == b')' {
            return true;
        }
        self.quoted() || self.integer()
    }

    /// A text in quotes, with nothing in it that would have to be escaped.
    fn quoted(&mut self) -> bool {
        self.take(b'"')
            && !self
                .run(|byte| !matches!(byte, b'"' | b'\\' | 0))
                .is_empty()
            && self.take(b'"')
    }

    fn attribute(&mut self) -> bool {
        if !(self.take(b'#') && self.take(b'[') && self.path()) {
            return false;
        }
        if self.take(b'(') {
            loop {
                if !self.path() || self.take(b'=') && !self.quoted() {
                    return false;
                }
                if !self.take(b',') {
                    break;
                }
            }
            if !self.take(b')') {
                return false;
            }
        }
        self.take(b']')
    }

    /// `a`, `mut a`, `_` or `(a, _)`.
    fn pattern(&mut self) -> bool {
        if self.take(b'(') {
            return self.binding() && self.take(b',') && self.binding() && self.take(b')');
        }
        self.binding()
    }

    fn binding(&mut self) -> bool {
        if self.word("_") {
            return true;
        }
        self.word("mut");
        self.name()
    }

    fn sum(&mut self) -> bool {
        loop {
            if !self.operand() {
                return false;
            }
            if !matches!(self.next(), b'+' | b'-' | b'*' | b'/') {
                return true;
            }
            self.at += 1;
        }
    }

    fn operand(&mut self) -> bool {
        let _ = self.take(b'-') || self.take(b'&');
        let whole = match self.next() {
            b'(' => self.take(b'(') && (self.take(b')') || self.sum() && self.take(b')')),
            b'0'..=b'9' => self.number(),
            _ => self.word("self") || self.path(),
        };
        whole && self.behind()
    }

    /// `a`, `S::from_f64`, `::core::f64::consts::PI`.
    fn path(&mut self) -> bool {
        self.take_colons();
        let mut name = self.name();
        while name && self.take_colons() {
            name = self.name();
        }
        name
    }

    /// Indices, fields, calls, and what hands errors on.
    fn behind(&mut self) -> bool {
        loop {
            let right = if self.take(b'[') {
                self.integer() && self.take(b']')
            } else if self.take(b'.') {
                self.integer() || self.name()
            } else if self.take(b'(') {
                self.arguments()
            } else if self.take(b'?') {
                true
            } else {
                return true;
            };
            if !right {
                return false;
            }
        }
    }

    fn arguments(&mut self) -> bool {
        while !self.take(b')') {
            if !self.sum() {
                return false;
            }
            if !self.take(b',') {
                return self.take(b')');
            }
        }
        true
    }

    /// A list of sums and, on the outside, of rows.
    fn list(&mut self, outside: bool) -> bool {
        if !self.take(b'[') {
            return false;
        }
        while !self.take(b']') {
            let row = outside && self.next() == b'[';
            if !(if row { self.list(false) } else { self.sum() }) {
                return false;
            }
            if !self.take(b',') {
                return self.take(b']');
            }
        }
        true
    }
}

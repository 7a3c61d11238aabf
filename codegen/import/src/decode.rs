//! Decodes the bytes of a file: UTF-8, UTF-16 with or without a byte order mark, or the encoding that an XML
//! declaration names.

use std::fmt;

/// Byte order mark at the start of a Unicode text.
const MARK: char = '\u{feff}';
/// Number of bytes in which an XML declaration is looked for.
const DECLARATION: usize = 200;
/// Windows-1252 for the bytes 0x80 to 0x9f, where it differs from ISO-8859-1; bytes that it leaves undefined keep
/// their meaning in ISO-8859-1.
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];
/// Bytes at which ISO-8859-15 differs from ISO-8859-1.
const LATIN_9: [(u8, char); 8] = [
    (0xa4, '€'),
    (0xa6, 'Š'),
    (0xa8, 'š'),
    (0xb4, 'Ž'),
    (0xb8, 'ž'),
    (0xbc, 'Œ'),
    (0xbd, 'œ'),
    (0xbe, 'Ÿ'),
];

/// Why bytes could not be decoded as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Undecoded {
    /// A byte sequence that is invalid in the encoding.
    Byte {
        /// Offset of the first invalid byte, from 0.
        place: usize,
        /// Name of the encoding.
        encoding: &'static str,
    },
    /// The XML declaration names an encoding that is not supported.
    Encoding(String),
}

impl fmt::Display for Undecoded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Undecoded::Byte { place, encoding } => {
                write!(f, "byte {place} is not {encoding}; save it as UTF-8")
            }
            Undecoded::Encoding(name) => {
                write!(f, "the encoding `{name}` is not read; save it as UTF-8")
            }
        }
    }
}

impl std::error::Error for Undecoded {}

/// Decodes the bytes of a file as UTF-8, as UTF-16, or as the XML declaration says.
///
/// ```
/// let utf16: Vec<u8> = "\u{feff}<robot/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
/// assert_eq!(hamel_import::decode(utf16).unwrap(), "<robot/>");
/// ```
///
/// # Errors
/// Fails if a byte is invalid in the encoding, or if the declaration names an encoding that is not supported.
pub fn decode(bytes: Vec<u8>) -> Result<String, Undecoded> {
    match bytes.as_slice() {
        [0xff, 0xfe, ..] | [b'<', 0, ..] => return wide(&bytes, u16::from_le_bytes),
        [0xfe, 0xff, ..] | [0, b'<', ..] => return wide(&bytes, u16::from_be_bytes),
        _ => {}
    }
    let name = declared(&bytes).map(str::to_ascii_lowercase);
    match name.as_deref().unwrap_or("utf-8") {
        // A declaration of UTF-16 in a file of single bytes is out of date: somebody re-encoded the file.
        "utf-8" | "utf8" | "us-ascii" | "ascii" | "utf-16" => unicode(bytes),
        "iso-8859-1" | "iso8859-1" | "latin1" | "latin-1" => {
            Ok(bytes.into_iter().map(char::from).collect())
        }
        "windows-1252" | "cp1252" => Ok(bytes.into_iter().map(windows).collect()),
        "iso-8859-15" | "iso8859-15" | "latin9" | "latin-9" => {
            Ok(bytes.into_iter().map(latin_9).collect())
        }
        name => Err(Undecoded::Encoding(name.to_string())),
    }
}

fn windows(byte: u8) -> char {
    let place = usize::from(byte).checked_sub(0x80);
    let other = place.and_then(|place| WINDOWS.get(place));
    other.copied().unwrap_or(char::from(byte))
}

fn latin_9(byte: u8) -> char {
    let other = LATIN_9.iter().find(|(place, _)| *place == byte);
    other.map_or(char::from(byte), |(_, sign)| *sign)
}

fn unicode(bytes: Vec<u8>) -> Result<String, Undecoded> {
    let text = String::from_utf8(bytes).map_err(|error| Undecoded::Byte {
        place: error.utf8_error().valid_up_to(),
        encoding: "UTF-8",
    })?;
    Ok(match text.strip_prefix(MARK) {
        Some(rest) if rest.trim_start().starts_with('<') => rest.to_string(),
        _ => text,
    })
}

fn wide(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Undecoded> {
    let no_sign = |place: usize| Undecoded::Byte {
        place,
        encoding: "UTF-16",
    };
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut text = String::new();
    let mut place = 0;
    for sign in char::decode_utf16(pairs.iter().map(|pair| unit(*pair))) {
        let sign = sign.map_err(|_| no_sign(place))?;
        place += 2 * sign.len_utf16();
        text.push(sign);
    }
    match rest {
        [] => Ok(text.strip_prefix(MARK).map(str::to_string).unwrap_or(text)),
        _ => Err(no_sign(place)),
    }
}

/// Returns the encoding that an XML declaration names.
fn declared(bytes: &[u8]) -> Option<&str> {
    let start = bytes.get(..bytes.len().min(DECLARATION))?;
    let end = start.windows(2).position(|pair| pair == b"?>")?;
    let declaration = std::str::from_utf8(start.get(..end)?).ok()?;
    let declaration = declaration.trim_start().strip_prefix("<?xml")?;
    let (_, value) = declaration.split_once("encoding")?;
    let value = value.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value.get(1..)?.split(quote).next()
}

#[cfg(test)]
mod tests {
    use super::{Undecoded, decode};

    /// The same text decodes alike from every supported encoding.
    #[test]
    fn encodings() {
        let text = "<?xml version=\"1.0\"?>\n<robot name=\"é 𝛼\"/>";
        let units: Vec<u16> = text.encode_utf16().collect();
        let little = |mark: &[u8]| {
            let bytes = units.iter().flat_map(|unit| unit.to_le_bytes());
            mark.iter().copied().chain(bytes).collect::<Vec<u8>>()
        };
        let big = |mark: &[u8]| {
            let bytes = units.iter().flat_map(|unit| unit.to_be_bytes());
            mark.iter().copied().chain(bytes).collect::<Vec<u8>>()
        };
        for bytes in [
            text.as_bytes().to_vec(),
            format!("\u{feff}{text}").into_bytes(),
            little(&[0xff, 0xfe]),
            little(&[]),
            big(&[0xfe, 0xff]),
            big(&[]),
        ] {
            assert_eq!(decode(bytes).as_deref(), Ok(text));
        }
        for (name, byte, sign) in [
            ("ISO-8859-1", 0xe9, 'é'),
            ("latin1", 0xa4, '¤'),
            ("windows-1252", 0x80, '€'),
            ("Windows-1252", 0xe9, 'é'),
            ("ISO-8859-15", 0xa4, '€'),
        ] {
            let head = format!("<?xml version='1.0' encoding = '{name}' ?><robot name='");
            let mut bytes = head.clone().into_bytes();
            bytes.push(byte);
            bytes.extend(b"'/>");
            assert_eq!(decode(bytes), Ok(format!("{head}{sign}'/>")), "{name}");
        }
    }

    #[test]
    fn bytes_that_are_no_text() {
        let place = |place, encoding| Err(Undecoded::Byte { place, encoding });
        assert_eq!(decode(b"<a\xff/>".to_vec()), place(2, "UTF-8"));
        assert_eq!(decode(b"\xff\xfe<\0a".to_vec()), place(4, "UTF-16"));
        assert_eq!(decode(b"\xff\xfe<\0\0\xd8>\0".to_vec()), place(4, "UTF-16"));
        let other = decode(b"<?xml version='1.0' encoding='Shift_JIS'?><a/>".to_vec());
        assert_eq!(other, Err(Undecoded::Encoding("shift_jis".into())));
    }

    /// A byte order mark is kept if the text is not XML: whoever reads the text handles it.
    #[test]
    fn descriptions_keep_their_mark() {
        let text = "\u{feff}system S {}";
        assert_eq!(decode(text.as_bytes().to_vec()).as_deref(), Ok(text));
    }
}

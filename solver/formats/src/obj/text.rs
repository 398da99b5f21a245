//! The lines and words of an OBJ file, whatever editor or exporter wrote them.

use std::borrow::Cow;

use super::error::ObjError;

/// A line of the file, with those that continue it.
pub(super) struct Line<'a> {
    /// Number of its first line in the file, from 1.
    pub number: usize,
    pub text: Cow<'a, [u8]>,
}

/// The lines of a file: ended by LF, CRLF or CR, a byte order mark skipped, and joined where a
/// backslash ends a line of data. Names and comments may end with one; they go on nowhere.
pub(super) struct Lines<'a> {
    lines: std::iter::Enumerate<std::slice::Split<'a, u8, IsEnd>>,
}

/// True if a byte ends a line.
type IsEnd = fn(&u8) -> bool;

impl<'a> Lines<'a> {
    pub fn of(bytes: &'a [u8]) -> Result<Self, ObjError> {
        if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
            let reason = "the file is UTF-16; save it as UTF-8".to_owned();
            return Err(ObjError { line: 1, reason });
        }
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let ends: IsEnd =
            if bytes.contains(&b'\n') { |byte| *byte == b'\n' } else { |byte| *byte == b'\r' };
        Ok(Self { lines: bytes.split(ends).enumerate() })
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let (index, first) = self.lines.next()?;
        let mut text = Cow::Borrowed(first.trim_ascii());
        let data = [b"v".as_slice(), b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p"];
        if text.ends_with(b"\\") && data.contains(&Values::of(&text).keyword()) {
            while text.ends_with(b"\\") {
                let joined = text.to_mut();
                joined.pop();
                joined.push(b' ');
                match self.lines.next() {
                    Some((_, next)) => joined.extend_from_slice(next.trim_ascii()),
                    None => break,
                }
            }
        }
        Some(Line { number: index + 1, text })
    }
}

/// The words of a line; a comment at its end is none.
pub(super) struct Values<'a> {
    text: &'a [u8],
}

impl<'a> Values<'a> {
    pub fn of(text: &'a [u8]) -> Self {
        Self { text }
    }

    /// The first word; empty on an empty line.
    pub fn keyword(&mut self) -> &'a [u8] {
        self.next().unwrap_or_default()
    }

    /// All that is left, as a name; what is not UTF-8 is taken for Latin-1.
    pub fn rest(&self) -> String {
        let rest = self.text.trim_ascii();
        match std::str::from_utf8(rest) {
            Ok(name) => name.to_owned(),
            Err(_) => rest.iter().map(|byte| char::from(*byte)).collect(),
        }
    }

    /// Number of words left.
    pub fn left(&self) -> usize {
        Self { text: self.text }.count()
    }

    /// The next `N` numbers of `what`.
    pub fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], String> {
        let mut numbers = [0.0; N];
        for (index, number) in numbers.iter_mut().enumerate() {
            let word = self.next().ok_or_else(|| {
                format!("{what} has {N} numbers, but here are {index}; export the mesh again")
            })?;
            let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
            *number = parsed.ok_or_else(|| {
                let shown = String::from_utf8_lossy(word);
                format!("{shown:?} is not a number; write {what} as numbers with a decimal point")
            })?;
        }
        Ok(numbers)
    }
}

impl<'a> Iterator for Values<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let text = self.text.trim_ascii_start();
        if text.first().is_none_or(|byte| *byte == b'#') {
            self.text = &[];
            return None;
        }
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        self.text = rest;
        Some(word)
    }
}

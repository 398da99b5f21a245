//! Changes inputs: bytes, words of a text, and the checksums that a format puts over its content.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Numbers at which arithmetic turns over.
const EDGES: [u64; 14] = [
    0,
    1,
    0x7F,
    0x80,
    0xFF,
    0x7FFF,
    0x8000,
    0xFFFF,
    0x7FFF_FFFF,
    0x8000_0000,
    0xFFFF_FFFF,
    0x7FFF_FFFF_FFFF_FFFF,
    0x8000_0000_0000_0000,
    0xFFFF_FFFF_FFFF_FFFF,
];

/// Numbers as texts have them, between bars.
const NUMBERS: &str = "0|-1|1|2|3|-0.0|0.5|1e-320|1e300|-1e300|1e999|nan|inf|65535|\
    65536|4294967295|4294967296|9223372036854775807|-9223372036854775808|99999999999999999999999999";

/// Levels of nesting or repeats, beyond what a stack holds.
const MANY: usize = 20_000;

/// How inputs of a format are changed.
#[derive(Clone, Copy)]
pub struct Mutator {
    /// Words that the format knows, between bars; none for binary formats.
    pub words: &'static str,
    /// Makes checksums right again.
    pub repair: Option<fn(&mut [u8])>,
}

impl Mutator {
    /// One of the `seeds`, or of what was `kept` as often, changed; the same for the same `run` and
    /// `index`.
    pub fn changed(&self, seeds: &[Vec<u8>], kept: &[Vec<u8>], run: u64, index: u64) -> Vec<u8> {
        let mut random = Pcg64Mcg::seed_from_u64(run.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ index);
        let pick = |random: &mut Pcg64Mcg| {
            let from = if kept.is_empty() || random.random() { seeds } else { kept };
            &from[random.random_range(0..from.len())]
        };
        let mut bytes = pick(&mut random).clone();
        let changes = 1 << random.random_range(0..3);
        for _ in 0..random.random_range(1..=changes) {
            if !self.words.is_empty() && random.random_range(0..4) > 0 {
                let other = pick(&mut random);
                bytes = self.words_changed(&bytes, other, &mut random);
            } else {
                bytes_changed(&mut bytes, pick(&mut random), &mut random);
            }
        }
        if let Some(repair) = self.repair.filter(|_| random.random_range(0..8) > 0) {
            repair(&mut bytes);
        }
        bytes
    }

    fn words_changed(&self, bytes: &[u8], other: &[u8], random: &mut Pcg64Mcg) -> Vec<u8> {
        let mut tokens = tokens(bytes);
        if tokens.is_empty() {
            return other.to_vec();
        }
        let (from, word);
        let at = random.random_range(0..tokens.len());
        let end = (at + random.random_range(1..12)).min(tokens.len());
        match random.random_range(0..10) {
            0 => drop(tokens.drain(at..end)),
            1 => {
                let copied = tokens[at..end].to_vec();
                let to = random.random_range(0..=tokens.len());
                tokens.splice(to..to, copied);
            }
            2 => {
                let to = random.random_range(0..tokens.len());
                tokens.swap(at, to);
            }
            3 => {
                from = self::tokens(other);
                if !from.is_empty() {
                    let first = random.random_range(0..from.len());
                    let last = (first + random.random_range(1..12)).min(from.len());
                    tokens.splice(at..end, from[first..last].iter().copied());
                }
            }
            4 | 5 => tokens[at] = one_of(self.words, random),
            6 if random.random_range(0..200) == 0 => {
                word = tokens[at].repeat(MANY);
                tokens[at] = &word;
            }
            _ => {
                // A number for a number, if there is one further on.
                let number = |token: &&[u8]| token.first().is_some_and(|b| b.is_ascii_digit());
                let at = tokens[at..].iter().position(number).map_or(at, |found| at + found);
                tokens[at] = one_of(NUMBERS, random);
            }
        }
        tokens.concat()
    }
}

/// One of the words between bars.
fn one_of(words: &'static str, random: &mut Pcg64Mcg) -> &'static [u8] {
    let count = words.split('|').count();
    words.split('|').nth(random.random_range(0..count)).unwrap_or_default().as_bytes()
}

/// Runs of letters and digits, runs of spaces, and single bytes of all other kinds.
fn tokens(bytes: &[u8]) -> Vec<&[u8]> {
    let kind = |byte: &u8| match byte {
        b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'.' | b'-' => 1,
        b' ' | b'\t' => 2,
        _ => 0,
    };
    bytes.chunk_by(|a, b| kind(a) == kind(b) && kind(a) != 0).collect()
}

fn bytes_changed(bytes: &mut Vec<u8>, other: &[u8], random: &mut Pcg64Mcg) {
    if bytes.is_empty() {
        bytes.extend_from_slice(other);
        return;
    }
    // Headers decide most.
    let reach = if random.random_range(0..2) == 0 { bytes.len().min(600) } else { bytes.len() };
    let at = random.random_range(0..reach);
    let end = (at + (1 << random.random_range(0..8))).min(bytes.len());
    match random.random_range(0..9) {
        0 | 1 => bytes[at] ^= 1 << random.random_range(0..8),
        2 => bytes[at] = random.random(),
        3 => bytes[at] = bytes[at].wrapping_add_signed(random.random_range(-4..=4)),
        4 | 5 => {
            let edge = EDGES[random.random_range(0..EDGES.len())];
            let edge = edge.wrapping_add_signed(random.random_range(-1..=1));
            let width = 1 << random.random_range(0..4);
            let mut value = edge.to_le_bytes()[..width].to_vec();
            if random.random_range(0..2) == 0 {
                value.reverse();
            }
            for (target, byte) in bytes[at..].iter_mut().zip(value) {
                *target = byte;
            }
        }
        6 => drop(bytes.drain(at..end)),
        7 => {
            let copied = bytes[at..end].to_vec();
            let to = random.random_range(0..=bytes.len());
            bytes.splice(to..to, copied);
        }
        _ if random.random_range(0..4) == 0 => bytes.truncate(at),
        _ => {
            let first = random.random_range(0..=other.len());
            let last = (first + (1 << random.random_range(0..8))).min(other.len());
            bytes.splice(at..end, other[first..last].iter().copied());
        }
    }
}

/// Puts the right CRC behind every chunk of a PNG.
pub fn repair_png(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let Some(content) = bytes.get(at + 4..at + 8 + length) else { return };
        let crc = content.iter().fold(u32::MAX, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
                crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 }
            })
        });
        let Some(place) = bytes.get_mut(at + 8 + length..at + 12 + length) else { return };
        place.copy_from_slice(&(!crc).to_be_bytes());
        at += 12 + length;
    }
}

//! The choice of the part and the channels of an EXR file.

use exr::meta::header::Header;

/// A channel: its part and its number in the part.
pub(super) type Place = (usize, usize);

/// The reason why a channel has no unique place.
#[derive(Debug, PartialEq)]
pub(super) enum NoPlace {
    /// There is none of the name.
    Missing { channel: String, present: String },
    /// There are several; what is wrong, and the fix.
    Several(String),
}

/// Names in a message; a file may have hundreds.
const SHOWN: usize = 24;

/// Locates the channels `names`. R, G and B together may also be the one colour layer or part
/// of the file; another channel is named as it is, or as `part.channel`.
pub(super) fn locate(headers: &[Header], names: &[&str]) -> Result<Vec<Place>, NoPlace> {
    let rgb = ["R", "G", "B"];
    let triple = if rgb.iter().all(|name| names.contains(name)) { colour(headers)? } else { None };
    let place = |name: &&str| {
        let part = triple.as_ref().zip(rgb.iter().position(|channel| channel == name));
        match part {
            Some((triple, channel)) => Ok(triple[channel]),
            None => named(headers, name),
        }
    };
    names.iter().map(place).collect()
}

/// All names by which channels can be asked for, in the file's order.
pub(super) fn names(headers: &[Header]) -> Vec<String> {
    let mut names = Vec::new();
    for part in 0..headers.len() {
        for channel in channels(&headers[part]) {
            let unique = headers.len() == 1 || named(headers, &channel).is_ok();
            names.push(if unique { channel } else { qualified(headers, part, &channel) });
        }
    }
    let rgb = ["R", "G", "B"];
    if !names.iter().any(|name| name == "R") && matches!(colour(headers), Ok(Some(_))) {
        names.extend(rgb.map(str::to_owned));
    }
    names
}

fn channels(header: &Header) -> impl Iterator<Item = String> {
    header.channels.list.iter().map(|channel| channel.name.to_string())
}

fn part_name(headers: &[Header], part: usize) -> String {
    let name = headers[part].own_attributes.layer_name.as_ref().map(ToString::to_string);
    name.filter(|name| !name.is_empty()).unwrap_or_else(|| format!("part {}", part + 1))
}

fn qualified(headers: &[Header], part: usize, channel: &str) -> String {
    if headers.len() == 1 {
        return channel.to_owned();
    }
    format!("{}.{channel}", part_name(headers, part))
}

fn find(headers: &[Header], part: usize, name: &str) -> Option<Place> {
    channels(&headers[part]).position(|channel| channel == name).map(|channel| (part, channel))
}

fn named(headers: &[Header], name: &str) -> Result<Place, NoPlace> {
    let parts = 0..headers.len();
    let plain: Vec<Place> = parts.clone().filter_map(|part| find(headers, part, name)).collect();
    match plain[..] {
        [place] => return Ok(place),
        [] => {}
        _ => {
            let parts = plain.iter().map(|(part, _)| part_name(headers, *part));
            return Err(NoPlace::Several(format!(
                "channel {name:?} is in the parts {}; keep one of them",
                listed(parts.collect())
            )));
        }
    }
    let inside = |part: usize| {
        let channel = name.strip_prefix(&part_name(headers, part))?.strip_prefix('.')?;
        find(headers, part, channel)
    };
    parts.clone().find_map(inside).ok_or_else(|| NoPlace::Missing {
        channel: name.to_owned(),
        present: listed(
            parts
                .flat_map(|part| {
                    channels(&headers[part]).map(move |channel| qualified(headers, part, &channel))
                })
                .collect(),
        ),
    })
}

/// The one colour of the file: R, G, B without a layer's name, else the only layer that has them.
fn colour(headers: &[Header]) -> Result<Option<[Place; 3]>, NoPlace> {
    let (mut plain, mut layered) = (Vec::new(), Vec::new());
    for part in 0..headers.len() {
        for channel in channels(&headers[part]) {
            let Some(layer) = channel.strip_suffix('R') else { continue };
            if !layer.is_empty() && !layer.ends_with('.') {
                continue;
            }
            let place = |colour: &str| find(headers, part, &format!("{layer}{colour}"));
            let (Some(r), Some(g), Some(b)) = (place("R"), place("G"), place("B")) else {
                continue;
            };
            if layer.is_empty() {
                plain.push((part_name(headers, part), [r, g, b]));
            } else {
                layered.push((qualified(headers, part, layer.trim_end_matches('.')), [r, g, b]));
            }
        }
    }
    let found = if plain.is_empty() { layered } else { plain };
    match &found[..] {
        [] => Ok(None),
        [(_, triple)] => Ok(Some(*triple)),
        several => Err(NoPlace::Several(format!(
            "has {} colour layers: {}; save the one that is meant as R, G, B",
            several.len(),
            listed(several.iter().map(|(name, _)| name.clone()).collect())
        ))),
    }
}

fn listed(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(SHOWN);
    names.truncate(SHOWN);
    // A name may hold a line's end; a message is one line.
    let text = names.join(", ").replace(char::is_control, " ");
    if more > 0 { format!("{text} and {more} more") } else { text }
}

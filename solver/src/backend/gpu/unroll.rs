//! Unrolling of loops before WGSL is compiled.
//!
//! Some drivers do not unroll loops, and then arrays with a loop's index are in memory. `#for j in 0..W` up to `#end`,
//! each on its own line, is repeated for every value of j; with `reversed` at the end of the line, from the last to the
//! first. Bounds are numbers or names of constants.

/// `source` without loops of this kind.
pub(super) fn unrolled(source: &str, constants: &[(&str, u32)]) -> String {
    let mut out = String::new();
    expand(&source.lines().map(str::to_owned).collect::<Vec<_>>(), constants, &mut out);
    out
}

fn expand(lines: &[String], constants: &[(&str, u32)], out: &mut String) {
    let mut at = 0;
    while at < lines.len() {
        let Some(head) = lines[at].trim_start().strip_prefix("#for ") else {
            out.push_str(&lines[at]);
            out.push('\n');
            at += 1;
            continue;
        };
        let mut depth = 1;
        let first = at + 1;
        at = first;
        while depth > 0 && at < lines.len() {
            let line = lines[at].trim_start();
            depth += usize::from(line.starts_with("#for "));
            depth -= usize::from(line == "#end");
            at += 1;
        }
        let body = &lines[first..at - 1];
        let words: Vec<&str> = head.split_whitespace().collect();
        let (from, to) = words[2].split_once("..").unwrap_or(("0", "0"));
        let mut values: Vec<u32> = (value(from, constants)..value(to, constants)).collect();
        if words.len() > 3 {
            values.reverse();
        }
        for value in values {
            let with = |line: &String| replaced(line, words[0], &format!("{value}u"));
            // A separate block scopes its variables.
            out.push_str("{\n");
            expand(&body.iter().map(with).collect::<Vec<_>>(), constants, out);
            out.push_str("}\n");
        }
    }
}

/// A number, or a constant.
fn value(bound: &str, constants: &[(&str, u32)]) -> u32 {
    let named = constants.iter().find(|(name, _)| *name == bound).map(|(_, value)| *value);
    named.or_else(|| bound.parse().ok()).unwrap_or_default()
}

/// `line` with every word `name` replaced.
fn replaced(line: &str, name: &str, by: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    for c in line.chars().chain(['\n']) {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        out.push_str(if word == name { by } else { &word });
        word.clear();
        out.push(c);
    }
    out.pop();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_are_written_out_inside_each_other() {
        let source =
            "a\n#for j in 0..W\n#for k in 1..3 reversed\ns[j] += jk * h[k];\n#end\n#end\nb\n";
        let expected = "a{{s[0u] += jk * h[2u];}{s[0u] += jk * h[1u];}}\
                        {{s[1u] += jk * h[2u];}{s[1u] += jk * h[1u];}}b";
        assert_eq!(unrolled(source, &[("W", 2)]).replace('\n', ""), expected);
        assert_eq!(unrolled("#for l in 1..H\nx\n#end\n", &[("H", 1)]), "");
    }
}

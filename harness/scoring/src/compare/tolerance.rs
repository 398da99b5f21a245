//! The tolerances of scores.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::CompareError;
use super::calibration::Calibration;

/// The rules that hold unless a file says otherwise.
const BUILT_IN: &str = include_str!("../../../../scenes/tolerances.toml");

/// Limits on changes of rows: the measured ones of a row, else those of the first rule whose pattern
/// matches.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerances {
    rules: Vec<Rule>,
    calibration: Option<Calibration>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: u32,
    #[serde(default, rename = "rule")]
    rules: Vec<Rule>,
    calibration: Option<Calibration>,
}

/// Allowed change of the rows that a pattern names.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// Row ids, `<case>/<solver>/<subject>[/light]/<metric>@<region>:<scale>`; `*` stands for any
    /// text.
    pub rows: String,
    /// Allowed change in the metric's unit.
    #[serde(default)]
    pub absolute: f64,
    /// Allowed change as a share of the baseline's value; both allowances add.
    #[serde(default)]
    pub relative: f64,
    /// True if a change for the better is a regression too (calibration constants).
    #[serde(default)]
    pub either_way: bool,
    /// The reason of the tolerance.
    pub reason: String,
}

impl Tolerances {
    /// The rules of `scenes/tolerances.toml` as they were when the program was built.
    pub fn built_in() -> Result<Self, CompareError> {
        Self::parse(Path::new("scenes/tolerances.toml"), BUILT_IN)
    }

    /// Reads a file of rules, or what `unshade calibrate` wrote.
    pub fn read(path: &Path) -> Result<Self, CompareError> {
        let text = fs::read_to_string(path).map_err(|error| CompareError::io(path, error))?;
        Self::parse(path, &text)
    }

    /// The built-in rules with a measured spread.
    pub fn calibrated(calibration: Calibration) -> Result<Self, CompareError> {
        Ok(Self { calibration: Some(calibration), ..Self::built_in()? })
    }

    /// The rule for a row.
    pub fn rule(&self, id: &str) -> Result<&Rule, CompareError> {
        let found = self.rules.iter().find(|rule| matches(&rule.rows, id));
        found.ok_or_else(|| CompareError::NoRule(CompareError::line(id)))
    }

    /// The measured spread, if there is one.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.calibration.as_ref()
    }

    fn parse(path: &Path, text: &str) -> Result<Self, CompareError> {
        let File { format, rules, calibration } =
            toml::from_str(text).map_err(|error| CompareError::text(path, error.message()))?;
        let wrong = |reason: String| Err(CompareError::text(path, reason));
        match (format, &calibration) {
            (1, None) | (2, Some(_)) => {}
            (1, Some(_)) => {
                return wrong("has format 1, and a calibration has format 2".to_owned());
            }
            (2, None) => return wrong("has format 2, and no [calibration]".to_owned()),
            _ => return wrong(format!("has format {format}, this version reads 1 and 2")),
        }
        let is_amount = |amount: f64| amount.is_finite() && amount >= 0.0;
        if let Some(rule) =
            rules.iter().find(|rule| !is_amount(rule.absolute) || !is_amount(rule.relative))
        {
            return wrong(format!(
                "the rule for {:?} has a negative or infinite allowance",
                rule.rows
            ));
        }
        if let Some(fault) = calibration.as_ref().and_then(Calibration::fault) {
            return wrong(fault);
        }
        // A calibration's other rows, and whether a change for the better is wanted, are the rules'.
        let rules = if format == 2 && rules.is_empty() { Self::built_in()?.rules } else { rules };
        Ok(Self { rules, calibration })
    }
}

impl Rule {
    /// The largest distance of a value from the baseline's that is tolerated.
    pub fn allowed(&self, baseline: f64) -> f64 {
        self.absolute + self.relative * baseline.abs()
    }
}

/// Returns whether `text` has the form of `pattern`, in which `*` stands for any text.
pub(super) fn matches(pattern: &str, text: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == text,
        Some((head, rest)) => text.strip_prefix(head).is_some_and(|tail| {
            (0..=tail.len()).any(|i| tail.is_char_boundary(i) && matches(rest, &tail[i..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_text() {
        assert!(matches("*/psnr_*:global", "a/b/psnr_srgb@mask-e5:global"));
        assert!(!matches("*/psnr_*:global", "a/b/psnr_srgb@mask-e5:none"));
        assert!(matches("*", "") && matches("a*", "a") && !matches("a", "ab"));
    }

    #[test]
    fn every_metric_has_a_rule_of_its_own() {
        let rules = Tolerances::built_in().unwrap();
        for metric in crate::metrics::METRICS {
            let rule = rules.rule(&format!("case/method/subject/{}@region:global", metric.id));
            assert_ne!(
                rule.unwrap().rows,
                "*",
                "{}: write one in scenes/tolerances.toml",
                metric.id
            );
        }
    }

    #[test]
    fn the_first_rule_that_matches_decides_and_bad_rules_are_refused() {
        let parse = |text: &str| Tolerances::parse(Path::new("t.toml"), text);
        let rules = parse(
            "format = 1\n[[rule]]\nrows = \"*/ssim@*\"\nabsolute = 0.1\nreason = \"a\"\n\
             [[rule]]\nrows = \"x*\"\nrelative = 0.5\nreason = \"b\"\n",
        )
        .unwrap();
        assert_eq!(rules.rule("x/ssim@r:none").unwrap().reason, "a");
        assert_eq!(rules.rule("x/flip@r:none").unwrap().allowed(-4.0), 2.0);
        let error = rules.rule("y").unwrap_err().to_string();
        assert!(error.contains("matches y"), "{error}");
        for bad in ["absolut = 1.0", "absolute = -1.0", "absolute = nan"] {
            let text = format!("format = 1\n[[rule]]\nrows = \"*\"\n{bad}\nreason = \"\"\n");
            let error = parse(&text).unwrap_err().to_string();
            assert!(error.starts_with("t.toml") && !error.contains('\n'), "{error}");
        }
    }
}

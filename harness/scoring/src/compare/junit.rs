//! A comparison as JUnit XML.

use std::collections::BTreeMap;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::CompareError;
use super::verdict::{Comparison, Judged, Verdict};

/// The places at which the suite states its cases: a file, and its line from 1.
pub type Places = BTreeMap<String, (String, usize)>;

impl Comparison {
    /// A suite per case and solver, a test per score; no times, so that equal comparisons give equal
    /// text. What the runs cannot tell is skipped. `places` are those of cases.
    pub fn junit(&self, places: &Places) -> Result<String, CompareError> {
        let mut report = Report::new(format!("unshade compare {}", self.suite));
        let mut suites: Vec<TestSuite> = Vec::new();
        let mut rows: Vec<&Judged> = self.rows.iter().collect();
        rows.sort_by(|a, b| a.id.cmp(&b.id));
        for row in rows {
            let cut = row.id.match_indices('/').nth(1).map_or(0, |(at, _)| at);
            let (method, name) = (&row.id[..cut], row.id[cut..].trim_start_matches('/'));
            let mut status = match row.verdict {
                Verdict::Worse | Verdict::Missing => {
                    TestCaseStatus::non_success(NonSuccessKind::Failure)
                }
                Verdict::CannotTell => TestCaseStatus::skipped(),
                _ => TestCaseStatus::success(),
            };
            let text = row.explained();
            let success = matches!(status, TestCaseStatus::Success { .. });
            if !success {
                status.set_type(row.verdict.word());
                status.set_message(text.clone());
            }
            let mut case = TestCase::new(name, status);
            case.set_classname(method);
            if let Some((file, line)) = method.split('/').next().and_then(|id| places.get(id)) {
                case.extra.insert("file".into(), file.as_str().into());
                case.extra.insert("line".into(), line.to_string().into());
            }
            if success {
                case.set_system_out(format!("{}: {text}", row.verdict.word()));
            }
            if suites.last().is_none_or(|suite| suite.name.as_str() != method) {
                suites.push(TestSuite::new(method));
            }
            suites.iter_mut().last().map(|suite| suite.add_test_case(case));
        }
        report.add_test_suites(suites);
        Ok(report.to_string()?)
    }
}

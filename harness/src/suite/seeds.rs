//! A suite whose random numbers differ and nothing else: of the renderer and of the methods, or of these alone; or
//! whose numbers are the same, and their last digits differ.

use toml::{Table, Value};

use super::cases::Case;
use super::file::Suite;
use super::scene::SceneError;

/// Random numbers that differ from one run to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Vary {
    /// Those of the renderer and of the methods.
    Both,
    /// Those of the methods: captures are made once and kept.
    Method,
    /// None: our solver rounds otherwise, as after a change of the program that changes nothing; captures are kept.
    Rounding,
}

impl Vary {
    /// Whether captures are made once.
    pub fn keeps_captures(self) -> bool {
        self != Self::Both
    }
}

impl Suite {
    /// This suite with other random numbers: `round` is added to every seed that its scenes (with
    /// [`Vary::Both`]), our solver's configurations and competitors state; programs find it in the variable `UNSHADE_SEED`.
    ///
    /// Photographs are what they are, and baselines draw no numbers. With [`Vary::Rounding`] every seed stays, and
    /// our solver's pictures differ in their last digits.
    pub fn reseeded(&self, round: u32, vary: Vary) -> Result<Self, SceneError> {
        let mut suite = self.clone();
        // Seeds far apart from those that anybody writes.
        let add = 7919 * i64::from(round);
        let added = |seed: Option<&Value>| seed.and_then(Value::as_integer).unwrap_or(0) + add;
        let rendered = |case: &&mut Case| vary == Vary::Both && case.photographed.is_none();
        for case in suite.cases.iter_mut().filter(rendered) {
            let render = case.scene.table.get("render").and_then(Value::as_table);
            let seed = added(render.and_then(|render| render.get("seed")));
            let changes = table("render", Value::Table(table("seed", Value::Integer(seed))));
            case.scene = case.scene.clone().with_changes(&changes);
        }
        for method in &mut suite.methods {
            let id = method.id.clone();
            let wrong = |(key, reason)| SceneError::in_table(&self.path, &id, key, reason);
            method.kind.reseed(add, vary).map_err(wrong)?;
        }
        Ok(suite)
    }
}

fn table(key: &str, value: Value) -> Table {
    Table::from_iter([(key.to_owned(), value)])
}

#[cfg(test)]
mod tests {
    use super::super::method::MethodKind;
    use super::*;

    #[test]
    fn rounding_moves_no_seed() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/suites/ci.toml");
        let suite = Suite::open(path.as_ref()).unwrap();
        let config = |suite: &Suite| match &suite.methods[0].kind {
            MethodKind::Solver(solver) => solver::Config::from_toml(&solver.config).unwrap(),
            _ => panic!("the first method is not our solver"),
        };
        let given = config(&suite);
        let rounded = config(&suite.reseeded(2, Vary::Rounding).unwrap());
        assert_eq!((rounded.seed(), rounded.rounding_seed()), (given.seed(), 2 * 7919));
        let other = config(&suite.reseeded(2, Vary::Method).unwrap());
        assert_eq!((other.seed(), other.rounding_seed()), (given.seed() + 2 * 7919, 0));
    }
}

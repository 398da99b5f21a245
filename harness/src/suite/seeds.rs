//! A suite whose random numbers differ and nothing else: of the renderer and of the methods, or of these alone.

use toml::{Table, Value};

use super::cases::Case;
use super::file::Suite;
use super::method::MethodKind;
use super::scene::SceneError;

/// Environment variable that hands a program of one's own the seed.
const VARIABLE: &str = "UNSHADE_SEED";

/// Random numbers that differ from one run to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Vary {
    /// Those of the renderer and of the methods.
    Both,
    /// Those of the methods: captures are made once and kept.
    Method,
}

impl Suite {
    /// This suite with other random numbers: `round` is added to every seed that its scenes (with
    /// [`Vary::Both`]), our solver's configurations and competitors state; programs find it in the variable `UNSHADE_SEED`.
    ///
    /// Photographs are what they are, and baselines draw no numbers.
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
            match &mut method.kind {
                MethodKind::Fields { config, .. } => {
                    let unreadable = |error: String| {
                        SceneError::in_table(&self.path, &method.id, "config", error)
                    };
                    let seed = solver::Config::from_toml(config)
                        .map_err(|error| unreadable(error.to_string()))?
                        .seed;
                    let mut values: Table = config
                        .parse()
                        .map_err(|error: toml::de::Error| unreadable(error.to_string()))?;
                    let seed = Value::Integer((seed as i64).wrapping_add(add));
                    values.insert("seed".to_owned(), seed);
                    *config =
                        toml::to_string(&values).map_err(|error| unreadable(error.to_string()))?;
                }
                MethodKind::Program(program) => {
                    program.environment.insert(VARIABLE.to_owned(), add.to_string());
                }
                MethodKind::Competitor { competitor, settings } if competitor.has_seed() => {
                    let unreadable = |error: serde_json::Error| {
                        SceneError::in_table(&self.path, &method.id, "set", error.to_string())
                    };
                    let mut values: serde_json::Value =
                        serde_json::from_str(settings).map_err(unreadable)?;
                    values["seed"] = (values["seed"].as_i64().unwrap_or(0) + add).into();
                    *settings = values.to_string();
                }
                _ => {}
            }
        }
        Ok(suite)
    }
}

fn table(key: &str, value: Value) -> Table {
    Table::from_iter([(key.to_owned(), value)])
}

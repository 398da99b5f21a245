//! One `[[method]]` table with several values: a method for each combination of them, and for each seed.

use std::path::Path;

use toml::{Table, Value};

use super::cases;
use super::scene::{self, SceneError};

/// A method's table, with the name that its seeds share and its seed, if it has several seeds.
pub(super) type Replicate = (Option<(String, u64)>, Table);

/// The table once for each combination of the values of `sweep`, under the name `<name>-<key><value>`, and once for
/// each of its `seeds`, under the name `<name>-seed<seed>`; as it is without either.
pub(super) fn replicates(path: &Path, table: &Table) -> Result<Vec<Replicate>, SceneError> {
    let mut table = table.clone();
    let (sweep, listed) = (table.remove("sweep"), table.remove("seeds"));
    let name = text(&table, "name").to_owned();
    let refused = |key: &str, reason: String| SceneError::in_table(path, &name, key, reason);
    let mut axes = Vec::new();
    if let Some(Value::Table(sweep)) = &sweep {
        axes_of(sweep, &mut Vec::new(), &mut axes).map_err(|reason| refused("sweep", reason))?;
    }
    let seeds = listed.map(|listed| {
        let reason = "must be a list of whole numbers from 0, each once".to_owned();
        cases::seeds(&listed).ok_or_else(|| refused("seeds", reason))
    });
    let seeds = seeds.transpose()?;
    let set = table.get("set").and_then(Value::as_table).cloned().unwrap_or_default();
    if let Some((keys, _)) = axes.iter().find(|(keys, _)| states(&set, keys)) {
        return Err(refused("sweep", format!("set has {} too; remove one", keys.join("."))));
    }
    if seeds.is_some() && set.contains_key("seed") {
        return Err(refused("seeds", "set has a seed too; remove one".to_owned()));
    }
    let mut methods = vec![table];
    for (keys, values) in &axes {
        let each = |one: &Table| -> Vec<Table> {
            values.iter().map(|value| with_value(one, keys, value)).collect()
        };
        methods = methods.iter().flat_map(each).collect();
    }
    let Some(seeds) = seeds else {
        return Ok(methods.into_iter().map(|method| (None, method)).collect());
    };
    let of_seed = |(method, seed): (&Table, u64)| {
        let value = Value::Integer(seed.cast_signed());
        let mut one = with_value(method, &["seed".to_owned()], &value);
        one.insert("title".to_owned(), format!("{}, seed {seed}", title(method)).into());
        (Some((text(method, "name").to_owned(), seed)), one)
    };
    let pairs = methods.iter().flat_map(|method| seeds.iter().map(move |seed| (method, *seed)));
    Ok(pairs.map(of_seed).collect())
}

/// The lists of a `sweep` table, each with the keys that lead to it.
fn axes_of<'t>(
    sweep: &'t Table,
    above: &mut Vec<String>,
    axes: &mut Vec<(Vec<String>, &'t [Value])>,
) -> Result<(), String> {
    for (key, value) in sweep {
        above.push(key.clone());
        match value {
            Value::Table(table) => axes_of(table, above, axes)?,
            Value::Array(values) if !values.is_empty() => axes.push((above.clone(), values)),
            _ => {
                let key = above.join(".");
                return Err(format!("{key} must be a list of values; write one value in set"));
            }
        }
        above.pop();
    }
    Ok(())
}

/// Whether a table has a value at the end of these keys.
fn states(table: &Table, keys: &[String]) -> bool {
    match keys {
        [] => true,
        [key, rest @ ..] => match table.get(key) {
            Some(Value::Table(inner)) => states(inner, rest),
            value => value.is_some(),
        },
    }
}

/// The method with one more value in `set`, named for it.
fn with_value(method: &Table, keys: &[String], value: &Value) -> Table {
    let name = text(method, "name");
    let key = keys.last().map_or("", String::as_str);
    let shown = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let in_name: String = shown.chars().map(plain).collect();
    let above = ["set"].into_iter().chain(keys.iter().map(String::as_str));
    let change = above.rev().fold(value.clone(), |inner, key| {
        Value::Table(Table::from_iter([(key.to_owned(), inner)]))
    });
    let mut one = method.clone();
    change.as_table().into_iter().for_each(|change| scene::overlay(&mut one, change));
    if !["command", "python", "config"].iter().any(|key| one.contains_key(*key)) {
        // Its new name is not that of a preset.
        one.insert("config".to_owned(), name.into());
    }
    one.insert("name".to_owned(), format!("{name}-{key}{in_name}").into());
    one.insert("title".to_owned(), format!("{}, {key} = {shown}", title(method)).into());
    one
}

fn text<'t>(table: &'t Table, key: &str) -> &'t str {
    table.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn title(method: &Table) -> &str {
    method.get("title").and_then(Value::as_str).unwrap_or_else(|| text(method, "name"))
}

//! Parts of a row's id: method, subject, light, metric.

use super::CompareError;
use crate::metrics::Metric;

/// `<case>/<method>/<subject>[/<light>]/<metric>@<region>[.<label>]:<scale>`, taken apart.
#[derive(Clone, Copy, Debug)]
pub struct RowId<'a> {
    /// A face in a light in a variant.
    pub case: &'a str,
    /// The method that made the maps.
    pub method: &'a str,
    /// Subject, such as `diffuse_albedo` or `relit`.
    pub subject: &'a str,
    /// The light that it is relit in.
    pub light: Option<&'a str>,
    /// The metric.
    pub metric: &'static Metric,
    /// `<region>[.<label>]:<scale>`.
    pub place: &'a str,
}

impl<'a> RowId<'a> {
    /// Takes an id apart.
    pub fn parse(id: &'a str) -> Result<Self, CompareError> {
        let (head, place) = id.split_once('@').unwrap_or((id, ""));
        let (head, name) = head.rsplit_once('/').unwrap_or(("", head));
        let metric = Metric::find(name)
            .map_err(|source| CompareError::Metric { id: CompareError::line(id), source })?;
        let mut parts = head.splitn(4, '/');
        let mut next = || parts.next().unwrap_or_default();
        let (case, method, subject) = (next(), next(), next());
        Ok(Self { case, method, subject, light: parts.next(), metric, place })
    }

    /// Returns whether the score has no factor on the albedo, or has none to have.
    pub fn is_unscaled(&self) -> bool {
        self.place.ends_with(":none")
    }

    /// Returns whether it is of the whole region and not of a part of the face.
    pub fn is_whole(&self) -> bool {
        !self.place.contains('.')
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_of_maps_and_of_pictures_are_taken_apart() {
        let id = RowId::parse("ada-studio/unshade/relit/flash/flip_mean@mask-e5:global").unwrap();
        assert_eq!((id.case, id.method, id.subject), ("ada-studio", "unshade", "relit"));
        assert_eq!((id.light, id.metric.id), (Some("flash"), "flip_mean"));
        assert!(id.is_whole() && !id.is_unscaled());
        let id = RowId::parse("a/b/diffuse_albedo/psnr_lin@coverage-e5.brow:none").unwrap();
        assert_eq!((id.light, id.subject), (None, "diffuse_albedo"));
        assert!(!id.is_whole() && id.is_unscaled());
        assert!(RowId::parse("a/b/c/loveliness@x:none").is_err());
    }
}

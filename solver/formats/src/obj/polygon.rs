//! Polygons cut into triangles.

use earcut::Earcut;

/// Sine of the angle at a corner below which it lies on the line between its neighbours, in space
/// or in the chart: files round to four digits or more.
const STRAIGHT: f64 = 1e-4;
/// Corners of a polygon that no fan can cut; ear clipping grows with a power of them.
const MAX_CORNERS: usize = 1024;
/// Share of a polygon's area by which its triangles may miss it.
const AREA_TOLERANCE: f64 = 1e-3;

/// A corner of a polygon.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub position: [f64; 3],
    pub uv: Option<[f64; 2]>,
}

/// Cuts polygons; its memory is used again for the next one.
#[derive(Default)]
pub(super) struct Cutter {
    clipper: Earcut<f64>,
    ears: Vec<u32>,
}

impl Cutter {
    /// Triangles of a polygon of `count` corners, as indices of its corners and in its winding: a
    /// fan around the first corner where that is sound, else by clipping ears of the polygon seen
    /// along its normal. Corners in a line with their neighbours end no sliver.
    pub fn cut(
        &mut self,
        count: usize,
        place: impl Fn(usize) -> Place,
    ) -> Result<Vec<[usize; 3]>, String> {
        let fan = || (2..count).map(|i| [0, i - 1, i]).collect::<Vec<_>>();
        if count == 3 {
            return Ok(fan());
        }
        let places: Vec<Place> = (0..count).map(place).collect();
        let Some(flat) = flattened(&places) else { return Ok(fan()) };
        // A polygon may be folded to nothing in the chart; no cut fixes that.
        let chart: Option<Vec<[f64; 2]>> = places.iter().map(|place| place.uv).collect();
        let chart = chart.filter(|chart| area(chart) != 0.0);
        let sound = |[a, b, c]: [usize; 3]| {
            let in_chart = |chart: &[[f64; 2]]| sine(chart[a], chart[b], chart[c]).abs() > STRAIGHT;
            sine(flat[a], flat[b], flat[c]) > STRAIGHT && chart.as_deref().is_none_or(in_chart)
        };
        if fan().into_iter().all(sound) {
            return Ok(fan());
        }
        if count > MAX_CORNERS {
            return Err(format!(
                "the face has {count} corners and is not convex; cut it into triangles"
            ));
        }
        let bent = bent(&flat, chart.as_deref());
        let mut triangles = self.clipped(&bent, &flat);
        for (index, first) in bent.iter().enumerate() {
            between(&mut triangles, *first, bent[(index + 1) % bent.len()], count);
        }
        if covers(&triangles, &flat) {
            // A corner that is there twice.
            triangles.retain(|[a, b, c]| cross(flat[*a], flat[*b], flat[*c]) != 0.0);
            return Ok(triangles);
        }
        let all: Vec<usize> = (0..count).collect();
        triangles = self.clipped(&all, &flat);
        match covers(&triangles, &flat) {
            true => Ok(triangles),
            // A twisted quadrilateral has no better cut.
            false if count == 4 => Ok(fan()),
            false => {
                Err(format!("the face of {count} corners crosses itself; cut it into triangles"))
            }
        }
    }

    /// Ears of the polygon of the `kept` corners, counter-clockwise as it is.
    fn clipped(&mut self, kept: &[usize], flat: &[[f64; 2]]) -> Vec<[usize; 3]> {
        self.clipper.earcut(kept.iter().map(|corner| flat[*corner]), &[], &mut self.ears);
        let ears = self.ears.chunks_exact(3).map(|ear| {
            let [a, b, c] = [ear[0], ear[1], ear[2]].map(|index| kept[index as usize]);
            if cross(flat[a], flat[b], flat[c]) < 0.0 { [a, c, b] } else { [a, b, c] }
        });
        ears.filter(|[a, b, c]| cross(flat[*a], flat[*b], flat[*c]) != 0.0).collect()
    }
}

/// The corners at which the polygon turns, in space and in the chart.
fn bent(flat: &[[f64; 2]], chart: Option<&[[f64; 2]]>) -> Vec<usize> {
    let count = flat.len();
    let mut kept: Vec<usize> = Vec::with_capacity(count);
    for corner in 0..count {
        let before = kept.last().copied().unwrap_or(count - 1);
        let straight = |points: &[[f64; 2]]| {
            let [a, b, c] = [before, corner, (corner + 1) % count].map(|index| points[index]);
            let ahead = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
            ahead >= 0.0 && cross(a, b, c).abs() <= STRAIGHT * length(a, b) * length(b, c)
        };
        if !straight(flat) && !chart.is_some_and(straight) {
            kept.push(corner);
        }
    }
    kept
}

/// Splits the triangle at the edge from `first` to `last` at the corners left out between them.
fn between(triangles: &mut Vec<[usize; 3]>, first: usize, last: usize, count: usize) {
    let chain: Vec<usize> = std::iter::successors(Some(first), |corner| {
        (*corner != last).then_some((corner + 1) % count)
    })
    .collect();
    if chain.len() < 3 {
        return;
    }
    let rotations = |[a, b, c]: [usize; 3]| [[a, b, c], [b, c, a], [c, a, b]];
    let found = triangles.iter().enumerate().find_map(|(index, triangle)| {
        let edge = rotations(*triangle).into_iter().find(|t| t[0] == first && t[1] == last);
        edge.map(|[_, _, apex]| (index, apex))
    });
    if let Some((index, apex)) = found {
        triangles.remove(index);
        triangles.extend(chain.windows(2).map(|pair| [pair[0], pair[1], apex]));
    }
}

/// The polygon seen along its normal (Newell's), counter-clockwise; `None` without area.
fn flattened(places: &[Place]) -> Option<Vec<[f64; 2]>> {
    let mut normal = [0.0; 3];
    for (index, place) in places.iter().enumerate() {
        let (a, b) = (place.position, places[(index + 1) % places.len()].position);
        for (axis, value) in normal.iter_mut().enumerate() {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            *value += (a[i] - b[i]) * (a[j] + b[j]);
        }
    }
    // Without the axis that the normal is nearest to: no rounding where the others are exact.
    let axis =
        (0..3).fold(0, |best, i| if normal[i].abs() > normal[best].abs() { i } else { best });
    if !normal.iter().all(|value| value.is_finite()) || normal[axis] == 0.0 {
        return None;
    }
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (i, j) = if normal[axis] > 0.0 { (i, j) } else { (j, i) };
    Some(places.iter().map(|place| [place.position[i], place.position[j]]).collect())
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The least sine of a triangle's angles, with the sign of its winding; 0 without area.
fn sine(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let mut sides = [length(a, b), length(b, c), length(c, a)];
    sides.sort_by(f64::total_cmp);
    // The smallest angle lies between the two longest sides.
    let product = sides[1] * sides[2];
    if product > 0.0 { cross(a, b, c) / product } else { 0.0 }
}

fn area(points: &[[f64; 2]]) -> f64 {
    let next = |index: usize| points[(index + 1) % points.len()];
    points.iter().enumerate().map(|(i, p)| cross(points[0], *p, next(i))).sum::<f64>() / 2.0
}

/// Returns whether the triangles have the polygon's area, so that none is turned over or overlaps.
fn covers(triangles: &[[usize; 3]], flat: &[[f64; 2]]) -> bool {
    let polygon = area(flat);
    let sum: f64 =
        triangles.iter().map(|[a, b, c]| cross(flat[*a], flat[*b], flat[*c]).abs() / 2.0).sum();
    polygon > 0.0 && (sum - polygon).abs() <= AREA_TOLERANCE * polygon
}

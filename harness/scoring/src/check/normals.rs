//! Normal maps: their coding, their lengths, their space and how they lie.

use formats::picture::Picture;
use glam::{Mat3, Vec3};

use super::axes::{best_frame, mean_cosine};
use super::finding::Finding;
use super::reduced::{Reduced, SIDE, median};
use super::symmetry::Symmetry;
use super::witness::Witness;

/// Length below which a vector has no direction.
const ZERO: f32 = 1e-3;
/// The tolerated error of the length of a unit vector, and the fraction of texels that may be worse:
/// halves and bilinear resizing stay within.
const LENGTH_OFF: f32 = 0.1;
const WORSE_FRACTION: f64 = 0.01;
/// Length of the mean of the normals from which they point one way: a face's reach .5, a tangent
/// space's .95.
const ONE_WAY: f64 = 0.9;
/// [`ONE_WAY`] where no mesh says how much the true ones vary.
const ONE_WAY_ALONE: f64 = 0.95;
/// Mean cosine to the mesh that another frame must gain, and reach, to be named; right maps have .98.
const GAIN: f64 = 0.05;
const EXPLAINS: f64 = 0.85;
/// Mean cosine to the mesh below which no noise explains a map.
const UNLIKE: f64 = 0.5;
/// Mean z below which normals of a face that looks along +z point inwards.
const INWARDS: f64 = -0.2;

/// Reference that normals are compared with.
#[derive(Clone, Copy)]
pub(super) enum Reference<'a> {
    /// The mesh of a capture.
    Capture(&'a Witness),
    /// No mesh: where the maps say that they have data, at the size of comparisons.
    Coverage(Option<&'a [bool]>),
}

/// The encoding of a map's vectors.
#[derive(Clone, Copy, PartialEq)]
enum Coding {
    Plain,
    /// n / 2 + 1/2.
    Unit,
    /// 127.5 (n + 1).
    Bytes,
}

impl Coding {
    fn decode(self, value: f32) -> f32 {
        match self {
            Self::Plain => value,
            Self::Unit => 2.0 * value - 1.0,
            Self::Bytes => value / 127.5 - 1.0,
        }
    }
}

/// The faults of one map of three channels; `covered` are the texels that count.
pub(super) fn check(
    file: &str,
    map: &Picture,
    covered: &[bool],
    reference: Reference,
    findings: &mut Vec<Finding>,
) {
    let vectors = || {
        let texels = map.data.chunks_exact(3).zip(covered).filter(|(_, covered)| **covered);
        texels.map(|(v, _)| Vec3::from_slice(v)).filter(|v| v.is_finite())
    };
    let total = vectors().count();
    if total == 0 {
        return;
    }
    let fraction = |count: usize| count as f64 / total as f64;
    let zero = vectors().filter(|v| v.length() < ZERO).count();
    if zero > 0 {
        let percent = 100.0 * fraction(zero);
        let message = format!("has {zero} covered texels ({percent:.1} %) of zero length");
        let fix = "write unit vectors there, or 0 into coverage.png";
        let finding = if zero == total { Finding::error } else { Finding::warning };
        let evidence = [("texels", zero as f64), ("share", fraction(zero))];
        findings.push(finding("zero-length", file, message, fix).with(evidence));
    }
    if zero == total {
        return;
    }
    let long = || vectors().filter(|v| v.length() >= ZERO);
    let coding = coding_of(&long().collect::<Vec<_>>());
    if coding == Coding::Plain {
        let off = long().filter(|v| (v.length() - 1.0).abs() > LENGTH_OFF).count();
        if fraction(off) > WORSE_FRACTION {
            let middle = median(long().map(Vec3::length)).unwrap_or(0.0);
            let percent = 100.0 * fraction(off);
            let message = format!(
                "has {percent:.1} % of its vectors off unit length (median length {middle:.3})"
            );
            let fix = "normalise them before writing";
            let evidence = [("share", fraction(off)), ("median_length", middle)];
            findings.push(Finding::warning("not-unit", file, message, fix).with(evidence));
        }
    } else {
        let median_of = |coding: Coding| {
            median(long().map(move |v| v.to_array().map(|v| coding.decode(v))).map(length))
        };
        let (plain, decoded) = (median_of(Coding::Plain), median_of(coding));
        let (plain, decoded) = (plain.unwrap_or(0.0), decoded.unwrap_or(0.0));
        let (id, formula, fix) = if coding == Coding::Unit {
            ("coded-0-1", "n / 2 + 1/2", "write n itself: 2 x - 1 of what it holds")
        } else {
            ("coded-0-255", "127.5 (n + 1)", "write n itself: x / 127.5 - 1 of what it holds")
        };
        let message =
            format!("is coded as {formula}: its median length is {plain:.2}, decoded {decoded:.2}");
        let evidence = [("median_length", plain), ("median_length_decoded", decoded)];
        findings.push(Finding::warning(id, file, message, fix).with(evidence));
    }
    let reduced = Reduced::of(&Picture {
        data: map.data.iter().map(|value| coding.decode(*value)).collect(),
        ..*map
    });
    let normals = Normals::of(&reduced);
    findings.extend(match reference {
        Reference::Capture(witness) => normals.against_mesh(file, witness),
        Reference::Coverage(covered) => normals.alone(file, covered),
    });
}

fn length(vector: [f32; 3]) -> f32 {
    Vec3::from_array(vector).length()
}

/// Coded vectors are never negative, and of unit length only when decoded.
fn coding_of(vectors: &[Vec3]) -> Coding {
    let minimum = vectors.iter().map(|v| v.min_element()).fold(f32::INFINITY, f32::min);
    let near_unit = |coding: Coding| {
        let lengths = vectors.iter().map(|v| length(v.to_array().map(|v| coding.decode(v))));
        median(lengths).is_some_and(|length| (length - 1.0).abs() < 0.1)
    };
    // The median is not enough: some coded vectors have unit length as they are.
    let spread = |coding: Coding| {
        let off = vectors.iter().map(|v| length(v.to_array().map(|v| coding.decode(v))) - 1.0);
        off.map(|off| f64::from(off.abs())).sum::<f64>() / vectors.len().max(1) as f64
    };
    let coded = [Coding::Unit, Coding::Bytes].into_iter().find(|coding| {
        minimum > -0.02 && near_unit(*coding) && spread(*coding) < 0.5 * spread(Coding::Plain)
    });
    coded.unwrap_or(Coding::Plain)
}

/// Unit normals at the size at which they are compared; zero where there are none.
struct Normals(Vec<Vec3>);

impl Normals {
    fn of(map: &Reduced) -> Self {
        let unit = |texel: usize| {
            let normal = Vec3::from_slice(map.texel(texel)).normalize_or_zero();
            if map.valid[texel] { normal } else { Vec3::ZERO }
        };
        Self((0..SIDE * SIDE).map(unit).collect())
    }

    fn mean(&self, counted: impl Fn(usize) -> bool) -> Vec3 {
        let texels = (0..SIDE * SIDE).filter(|t| counted(*t) && self.0[*t] != Vec3::ZERO);
        let (count, sum) = texels.fold((0, Vec3::ZERO), |(n, sum), t| (n + 1, sum + self.0[t]));
        sum / (count.max(1) as f32)
    }

    /// The fault that can be told without a mesh: faces look along +z, and bend.
    fn alone(&self, file: &str, covered: Option<&[bool]>) -> Option<Finding> {
        let mean = self.mean(|texel| covered.is_none_or(|covered| covered[texel]));
        if f64::from(mean.length()) > ONE_WAY_ALONE && f64::from(mean.z) > ONE_WAY {
            return Some(tangent_space(file, mean, None));
        }
        // The back of a head points elsewhere: without a coverage it may be most of the chart.
        let inwards = covered.is_some() && f64::from(mean.z) < INWARDS;
        inwards.then(|| {
            let z = mean.z;
            let message = format!("points inwards: its mean z is {z:.2}, and faces look along +z");
            let fix = "negate it, or check its axes with --capture";
            Finding::warning("negated", file, message, fix).with([("mean_z", f64::from(z))])
        })
    }

    fn against_mesh(&self, file: &str, witness: &Witness) -> Option<Finding> {
        let counted = |t: usize| witness.seen[t];
        let mesh = Normals(witness.normals.clone());
        let (mean, mesh_mean) = (self.mean(counted), mesh.mean(counted));
        let curved = f64::from(mesh_mean.length()) < ONE_WAY - GAIN;
        if curved && f64::from(mean.length()) > ONE_WAY && f64::from(mean.z) > ONE_WAY - GAIN {
            return Some(tangent_space(file, mean, Some(mesh_mean)));
        }
        let moments = Symmetry::ALL.map(|symmetry| {
            (symmetry, moment(&symmetry.undone(&self.0, SIDE), &witness.normals, &witness.seen))
        });
        let as_it_is = mean_cosine(moments[0].1, Mat3::IDENTITY);
        let frame = best_frame(moments[0].1, &witness.cameras)?;
        let lies =
            moments.map(|(symmetry, moment)| (symmetry, mean_cosine(moment, Mat3::IDENTITY)));
        let &(symmetry, lying) = lies.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (id, wrong, fix, cosine) = if lying > frame.cosine {
            let (id, wrong, fix) = symmetry.words();
            (id, wrong.to_owned(), fix.to_owned(), lying)
        } else {
            (frame.id, frame.wrong, frame.fix, frame.cosine)
        };
        if cosine < as_it_is + GAIN && as_it_is > UNLIKE {
            return None;
        }
        let evidence = [("cosine_as_it_is", as_it_is), ("cosine_undone", cosine)];
        let finding = if cosine > EXPLAINS.max(as_it_is + GAIN) {
            let message = format!(
                "{wrong}: its mean cosine to the mesh's normals is {as_it_is:.2} as it is, \
                 {cosine:.2} when that is undone"
            );
            Finding::warning(id, file, message, &fix)
        } else if as_it_is < EXPLAINS - GAIN {
            let message = format!(
                "does not fit the mesh: the mean cosine to its normals is {as_it_is:.2}, and no \
                 exchange of axes or rows brings it above {cosine:.2}"
            );
            let fix = "write unit vectors in the space of the capture's mesh.obj";
            Finding::warning("not-the-mesh", file, message, fix)
        } else {
            return None;
        };
        Some(finding.with(evidence))
    }
}

fn tangent_space(file: &str, mean: Vec3, mesh_mean: Option<Vec3>) -> Finding {
    let (z, length) = (f64::from(mean.z), f64::from(mean.length()));
    let mesh = mesh_mean.map_or(f64::NAN, |mean| f64::from(mean.length()));
    let beside = mesh_mean.map_or_else(
        || "a face's vary more".to_owned(),
        |mean| format!("that of the mesh's has length {:.2}", mean.length()),
    );
    let message = format!(
        "is in tangent space: the mean of its vectors has length {length:.2} and z {z:.2}, {beside}"
    );
    let fix = "turn it to object space by the mesh's tangent frames before writing";
    Finding::warning("tangent-space", file, message, fix).with([
        ("mean_length", length),
        ("mean_z", z),
        ("mesh_mean_length", mesh),
    ])
}

/// Mean of mesh normal times normal, transposed, where both are.
fn moment(normals: &[Vec3], mesh: &[Vec3], seen: &[bool]) -> Mat3 {
    let mut sum = Mat3::ZERO;
    let mut count = 0.0;
    for ((normal, mesh), _) in normals.iter().zip(mesh).zip(seen).filter(|(_, seen)| **seen) {
        if *normal != Vec3::ZERO {
            sum += Mat3::from_cols(*mesh * normal.x, *mesh * normal.y, *mesh * normal.z);
            count += 1.0;
        }
    }
    sum * (1.0_f32 / f32::max(count, 1.0))
}

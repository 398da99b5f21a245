//! k-means of points in three dimensions.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Rounds of Lloyd's algorithm from new centres, and from existing clusters.
const ROUNDS: [usize; 2] = [50, 3];

/// The cluster of every point. The first centre starts at the mean, each further one at the point that is farthest from
/// the others.
pub fn clusters(points: &[Vec3], count: usize) -> Vec<u8> {
    let mut all = centres(points, &vec![0; points.len()], 1);
    while all.len() < count {
        let farthest = |far: (usize, f32), (at, (_, d)): (usize, (u8, f32))| {
            if d > far.1 { (at, d) } else { far }
        };
        let (farthest, _) = nearest(points, &all).into_iter().enumerate().fold((0, 0.0), farthest);
        all.push(points[farthest]);
    }
    rounds(points, all, ROUNDS[0])
}

/// Improves existing clusters; a cluster may become empty.
pub fn lloyd(points: &[Vec3], clusters: Vec<u8>, count: usize) -> Vec<u8> {
    rounds(points, centres(points, &clusters, count), ROUNDS[1])
}

/// The mean of every cluster; far from all points for an empty one.
pub fn centres(points: &[Vec3], clusters: &[u8], count: usize) -> Vec<Vec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0_f64); count];
    for (point, cluster) in points.iter().zip(clusters) {
        let sum = &mut sums[*cluster as usize];
        *sum = (sum.0 + point.as_dvec3(), sum.1 + 1.0);
    }
    let mean = |(sum, number): (DVec3, f64)| {
        if number > 0.0 { (sum / number).as_vec3() } else { Vec3::splat(-FAR) }
    };
    sums.into_iter().map(mean).collect()
}

/// Farther than any two points.
const FAR: f32 = 1e6;

fn rounds(points: &[Vec3], mut all: Vec<Vec3>, rounds: usize) -> Vec<u8> {
    let assigned =
        |all: &[Vec3]| nearest(points, all).into_iter().map(|(cluster, _)| cluster).collect();
    for _ in 0..rounds {
        let clusters: Vec<u8> = assigned(&all);
        all = centres(points, &clusters, all.len());
    }
    assigned(&all)
}

/// The nearest centre of every point, and its squared distance.
fn nearest(points: &[Vec3], centres: &[Vec3]) -> Vec<(u8, f32)> {
    let nearest = |point: &Vec3| {
        centres.iter().zip(0_u8..).fold((0, f32::INFINITY), |best, (centre, cluster)| {
            let distance = point.distance_squared(*centre);
            if distance < best.1 { (cluster, distance) } else { best }
        })
    };
    points.par_iter().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_groups_are_three_clusters() {
        let heaps = [Vec3::ZERO, Vec3::new(4.0, 0.0, 1.0), Vec3::new(0.0, 5.0, -1.0)];
        let points: Vec<Vec3> = (0..60)
            .map(|i| heaps[i % 3] + 0.3 * Vec3::new((i as f32).sin(), (i as f32).cos(), 0.0))
            .collect();
        let found = clusters(&points, 3);
        for (i, cluster) in found.iter().enumerate() {
            assert_eq!(*cluster, found[i % 3]);
        }
        assert_eq!(found[..3].iter().collect::<std::collections::BTreeSet<_>>().len(), 3);
        let again = lloyd(&points, found.clone(), 3);
        assert_eq!(again, found);
    }

    #[test]
    fn an_empty_cluster_stays_empty() {
        let points = [Vec3::ZERO, Vec3::X];
        assert_eq!(lloyd(&points, vec![0, 2], 3), [0, 2]);
    }
}

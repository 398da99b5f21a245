//! Connected parts of regions.

/// Labels every texel with the connected part of its region, named by the part's first texel.
pub fn parts(region: &[Option<u8>], side: usize) -> Vec<usize> {
    let mut part: Vec<usize> = (0..region.len()).collect();
    for first in 0..region.len() {
        if region[first].is_none() || part[first] != first {
            continue;
        }
        let mut open = vec![first];
        while let Some(at) = open.pop() {
            let beside = [
                (at % side > 0).then(|| at - 1),
                (at % side + 1 < side).then_some(at + 1),
                at.checked_sub(side),
                (at + side < region.len()).then_some(at + side),
            ];
            for next in beside.into_iter().flatten() {
                if next > first && part[next] == next && region[next] == region[first] {
                    part[next] = first;
                    open.push(next);
                }
            }
        }
    }
    part
}

// Samples per block of planes; see model/planes.rs.
const BLOCK: u32 = 256u;

// Index of a sample's value in planes of `rows` rows.
fn place(sample: u32, row: u32, rows: u32) -> u32 {
    return ((sample / BLOCK) * rows + row) * BLOCK + sample % BLOCK;
}

// Grids have two axes, because an axis is limited to 65535 workgroups.
fn linear(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}

//! Matrices from a light to texels or samples, their products and their adjoint.

use super::device::Device;
use super::pass::{Pass, THREADS};
use crate::transport::{CHANNELS, Parts};

/// Rows that one thread adds up.
const CHUNK: usize = 256;

/// Rows of `cells` weights.
pub(super) struct Matrix {
    pub rows: usize,
    cells: usize,
    weights: wgpu::Buffer,
}

impl Matrix {
    pub fn new(device: &Device, cells: usize, weights: &[f32]) -> Self {
        Self {
            rows: weights.len() / cells.max(1),
            cells,
            weights: device.filled("matrix", weights),
        }
    }

    fn size(&self) -> usize {
        self.rows * self.cells
    }

    /// R, G, B of every row in a light.
    pub fn product(&self, device: &Device, light: &wgpu::Buffer, out: &wgpu::Buffer) -> Pass {
        let source = include_str!("wgsl/transport.wgsl");
        let kernel = device.kernel("transport", source, &[], "urrw");
        let parameters = device.uniform(&[self.rows as u32, self.cells as u32]);
        let buffers = [&parameters, &self.weights, light, out];
        Pass::new(device, &kernel, &buffers, self.rows).doing(self.size(), 2 * CHANNELS, 1)
    }

    fn chunks(&self) -> usize {
        self.rows.div_ceil(CHUNK)
    }

    /// Partial gradients by the light, one per chunk of rows, from those by the rows; the first
    /// lies at `first`.
    fn adjoint(
        &self,
        device: &Device,
        [by_row, partial]: [&wgpu::Buffer; 2],
        first: usize,
    ) -> Pass {
        let constants = [("ROWS", CHUNK as u32)];
        let source = include_str!("wgsl/adjoint.wgsl");
        let kernel = device.kernel("adjoint", source, &constants, "urrw");
        let parameters = device.uniform(&[self.rows, self.cells, first].map(|word| word as u32));
        let buffers = [&parameters, &self.weights, by_row, partial];
        let groups = self.chunks() * self.cells.div_ceil(THREADS);
        Pass::new(device, &kernel, &buffers, groups).doing(self.size(), 2 * CHANNELS, 1)
    }
}

/// The gradient by the logarithm of a light: by all rows of some matrices of as many cells.
pub(super) fn by_light(
    device: &Device,
    matrices: &[(&Matrix, &wgpu::Buffer)],
    light: &wgpu::Buffer,
    gradient: &wgpu::Buffer,
) -> Vec<Pass> {
    let count = CHANNELS * matrices.first().map_or(0, |(matrix, _)| matrix.cells);
    let chunks: usize = matrices.iter().map(|(matrix, _)| matrix.chunks()).sum();
    let partial = device.floats("partial sums", chunks * count);
    let mut passes = vec![];
    let mut first = 0;
    for (matrix, by_row) in matrices {
        passes.push(matrix.adjoint(device, [by_row, &partial], first));
        first += matrix.chunks();
    }
    let kernel = device.kernel("by light", include_str!("wgsl/by_light.wgsl"), &[], "urrw");
    let parameters = device.uniform(&[count as u32, chunks as u32]);
    passes.push(Pass::over(device, &kernel, &[&parameters, &partial, light, gradient], count));
    passes
}

/// From a light to the shading of texels, and what is made with it.
pub(super) struct Shading {
    pub matrix: Matrix,
    texels: usize,
    /// Row of each texel; `start` and `texel` are the texels of each row.
    row: wgpu::Buffer,
    start: wgpu::Buffer,
    texel: wgpu::Buffer,
    pub light: wgpu::Buffer,
    shading: wgpu::Buffer,
    pub by_row: wgpu::Buffer,
}

impl Shading {
    pub fn new(device: &Device, parts: &Parts) -> Self {
        let matrix = Matrix::new(device, parts.cells, parts.matrix);
        let rows = matrix.rows;
        let mut start = vec![0u32; rows + 1];
        parts.row.iter().for_each(|row| start[*row as usize + 1] += 1);
        (0..rows).for_each(|row| start[row + 1] += start[row]);
        let mut texel: Vec<u32> = (0..parts.row.len() as u32).collect();
        texel.sort_by_key(|texel| (parts.row[*texel as usize], *texel));
        Self {
            texels: parts.row.len(),
            row: device.filled("rows", parts.row),
            start: device.filled("first texels", &start),
            texel: device.filled("texels", &texel),
            light: device.floats("light", CHANNELS * parts.cells),
            shading: device.floats("shading", CHANNELS * rows),
            by_row: device.floats("by shading", CHANNELS * rows),
            matrix,
        }
    }

    /// The light, and the shading of every row.
    pub fn passes(&self, device: &Device, log: &wgpu::Buffer) -> Vec<Pass> {
        let count = CHANNELS * self.matrix.cells;
        let kernel = device.kernel("light", include_str!("wgsl/light.wgsl"), &[], "urw");
        let parameters = device.uniform(&[count as u32]);
        let light = Pass::over(device, &kernel, &[&parameters, log, &self.light], count);
        vec![light, self.matrix.product(device, &self.light, &self.shading)]
    }

    /// A texture times the shading.
    pub fn lit(&self, device: &Device, from: &wgpu::Buffer, to: &wgpu::Buffer, add: bool) -> Pass {
        let constants = [("ADD", u32::from(add))];
        let kernel = device.kernel("lit", include_str!("wgsl/lit.wgsl"), &constants, "urrrw");
        let count = CHANNELS * self.texels;
        let parameters = device.uniform(&[count as u32]);
        let buffers = [&parameters, &self.row, &self.shading, from, to];
        Pass::over(device, &kernel, &buffers, count)
    }

    /// The gradient by the shading of every row; `textures` are that by the diffuse layer, and the albedo.
    pub fn by_shading(&self, device: &Device, textures: [&wgpu::Buffer; 2]) -> Pass {
        let rows = self.matrix.rows;
        let kernel = device.kernel("by shading", include_str!("wgsl/rows.wgsl"), &[], "urrrrw");
        let parameters = device.uniform(&[rows as u32]);
        let [by_layer, albedo] = textures;
        let buffers = [&parameters, &self.start, &self.texel, by_layer, albedo, &self.by_row];
        Pass::over(device, &kernel, &buffers, rows)
    }
}

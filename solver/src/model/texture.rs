//! Square textures of interleaved channels, row 0 at v = 1.

use rayon::prelude::*;

use crate::parallel::from_parts;

/// Resamples a texture to another size, bilinearly between texel centres.
pub fn resample(texture: &[f32], size: usize, channels: usize, to: usize) -> Vec<f32> {
    let ratio = size as f32 / to as f32;
    let axis = |at: usize| {
        let place = ((at as f32 + 0.5) * ratio - 0.5).clamp(0.0, (size - 1) as f32);
        let first = (place as usize).min(size.saturating_sub(2));
        (first, (first + 1).min(size - 1), place - first as f32)
    };
    let mut out = vec![0.0; to * to * channels];
    out.par_chunks_mut(to * channels).enumerate().for_each(|(y, line)| {
        let (y0, y1, fy) = axis(y);
        for (x, texel) in line.chunks_exact_mut(channels).enumerate() {
            let (x0, x1, fx) = axis(x);
            for (c, value) in texel.iter_mut().enumerate() {
                let at = |x: usize, y: usize| texture[(y * size + x) * channels + c];
                let row = |y: usize| at(x0, y) + fx * (at(x1, y) - at(x0, y));
                *value = row(y0) + fy * (row(y1) - row(y0));
            }
        }
    });
    out
}

/// Resamples a texture to another size; to a smaller one by averages of 2 x 2 texels, since a larger step would skip
/// texels.
pub fn shrunk(texture: &[f32], size: usize, channels: usize, to: usize) -> Vec<f32> {
    let (mut texture, mut size) = (texture.to_vec(), size);
    while size != to {
        let next = if size > to { (size / 2).max(to) } else { to };
        texture = resample(&texture, size, channels, next);
        size = next;
    }
    texture
}

/// Texels per task.
const CHUNK: usize = 1 << 12;

/// Interleaves the channels of several textures, given as `(texture, its channels)`, `C` in total.
pub fn interleave<const C: usize>(parts: &[(&[f32], usize)]) -> Vec<f32> {
    let texels = parts.first().map_or(0, |(texture, channels)| texture.len() / channels);
    let fill = |task: usize, out: &mut [f32]| {
        let (out, _) = out.as_chunks_mut::<C>();
        let mut first = 0;
        for (texture, channels) in parts {
            let source = &texture[task * CHUNK * channels..];
            for (texel, source) in out.iter_mut().zip(source.chunks_exact(*channels)) {
                texel[first..first + channels].copy_from_slice(source);
            }
            first += channels;
        }
    };
    from_parts(texels * C, C * CHUNK, fill).0
}

/// The inverse of [`interleave`]: `D` channels from `first` on, of `C`.
pub fn part<const C: usize, const D: usize>(texture: &[f32], first: usize) -> Vec<f32> {
    let (texels, _) = texture.as_chunks::<C>();
    let fill = |task: usize, out: &mut [f32]| {
        for (out, texel) in out.as_chunks_mut::<D>().0.iter_mut().zip(&texels[task * CHUNK..]) {
            out.copy_from_slice(&texel[first..first + D]);
        }
    };
    from_parts(texels.len() * D, D * CHUNK, fill).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upsampling_keeps_a_ramp_and_downsampling_its_mean() {
        let ramp: Vec<f32> = (0..64).map(|t| (t % 8) as f32).collect();
        let large = resample(&ramp, 8, 1, 32);
        assert!((large[16 * 32 + 14] - ((14.5 / 4.0) - 0.5)).abs() < 1e-5);
        assert_eq!((large[0], large[31]), (0.0, 7.0));
        let small = resample(&ramp, 8, 1, 4);
        assert!((small[0] - 0.5).abs() < 1e-6 && (small[3] - 6.5).abs() < 1e-6);
    }

    #[test]
    fn interleaving_keeps_the_order() {
        let (a, b) = ([1.0, 2.0, 3.0, 4.0], [5.0, 6.0]);
        let both = interleave::<3>(&[(&a, 2), (&b, 1)]);
        assert_eq!(both, [1.0, 2.0, 5.0, 3.0, 4.0, 6.0]);
        assert_eq!(part::<3, 2>(&both, 0), a);
        assert_eq!(part::<3, 1>(&both, 2), b);
    }
}

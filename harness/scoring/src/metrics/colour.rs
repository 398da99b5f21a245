//! Colour: the sRGB curve, CIE L*a*b* for D65, CIEDE2000, individual typology angle.

/// Linear Rec.709 to XYZ, IEC 61966-2-1:1999 (the standard's four digits).
const XYZ: [[f64; 3]; 3] =
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];

/// Chromaticity of D65 as the standard states it.
const D65: [f64; 2] = [0.3127, 0.3290];

/// Luminances below this are raised to it before their logarithm is taken.
const DARKEST: f64 = 1e-3;

/// The sRGB value of a linear one, clipped to [0, 1] (IEC 61966-2-1).
pub fn srgb(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Relative luminance of a linear Rec.709 colour; of a single channel, its value.
pub fn luminance(mut channels: impl Iterator<Item = f64>) -> f64 {
    match (channels.next(), channels.next(), channels.next()) {
        (Some(r), Some(g), Some(b)) => XYZ[1][0] * r + XYZ[1][1] * g + XYZ[1][2] * b,
        (first, ..) => first.unwrap_or(0.0),
    }
}

/// The logarithm of a luminance that may be zero.
pub(super) fn log(luminance: f64) -> f64 {
    luminance.max(DARKEST).ln()
}

/// CIE L*, a*, b* (D65) of a linear Rec.709 colour clipped to [0, 1].
pub fn lab(rgb: [f64; 3]) -> [f64; 3] {
    let rgb = rgb.map(|v| v.clamp(0.0, 1.0));
    let white = [D65[0] / D65[1], 1.0, (1.0 - D65[0] - D65[1]) / D65[1]];
    let [fx, fy, fz] = [0, 1, 2].map(|row| {
        let t = XYZ[row].iter().zip(rgb).map(|(m, v)| m * v).sum::<f64>() / white[row];
        if t > (6.0_f64 / 29.0).powi(3) { t.cbrt() } else { t * 841.0 / 108.0 + 4.0 / 29.0 }
    });
    [116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)]
}

/// Individual typology angle of an L*a*b* colour, degrees (Chardon et al. 1991): high for
/// light skin, negative for dark.
pub fn typology_angle([lightness, _, b]: [f64; 3]) -> f64 {
    (lightness - 50.0).atan2(b).to_degrees()
}

/// CIEDE2000 colour difference with unit weights (Sharma, Wu, Dalal 2005, equations 2 to 22).
pub fn ciede2000(first: [f64; 3], second: [f64; 3]) -> f64 {
    let power7 = |chroma: f64| (chroma.powi(7) / (chroma.powi(7) + 25.0_f64.powi(7))).sqrt();
    let mean_chroma = (first[1].hypot(first[2]) + second[1].hypot(second[2])) / 2.0;
    let stretch = 1.5 - 0.5 * power7(mean_chroma);
    let polar = |[lightness, a, b]: [f64; 3]| {
        let a = a * stretch;
        let hue =
            if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
        (lightness, a.hypot(b), hue)
    };
    let ((l1, c1, h1), (l2, c2, h2)) = (polar(first), polar(second));
    let grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let mean_hue = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => sum / 2.0,
        sum if sum < 360.0 => (sum + 360.0) / 2.0,
        sum => (sum - 360.0) / 2.0,
    };
    let (mean_l, mean_c) = ((l1 + l2) / 2.0, (c1 + c2) / 2.0);
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cosine(mean_hue - 30.0)
        + 0.24 * cosine(2.0 * mean_hue)
        + 0.32 * cosine(3.0 * mean_hue + 6.0)
        - 0.20 * cosine(4.0 * mean_hue - 63.0);
    let rotation = 60.0 * (-((mean_hue - 275.0) / 25.0).powi(2)).exp();
    let offset_squared = (mean_l - 50.0).powi(2);
    let dl = (l2 - l1) / (1.0 + 0.015 * offset_squared / (20.0 + offset_squared).sqrt());
    let dc = (c2 - c1) / (1.0 + 0.045 * mean_c);
    let dh = 2.0 * (c1 * c2).sqrt() * (turn / 2.0).to_radians().sin() / (1.0 + 0.015 * mean_c * t);
    let cross = -2.0 * power7(mean_c) * rotation.to_radians().sin();
    (dl * dl + dc * dc + dh * dh + cross * dc * dh).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_the_published_test_data_at_their_turning_points() {
        // Sharma et al., table 1: pairs 1, 4, 7, 9, 11, 16, 17, 25, 34.
        let pairs = [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
            ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
            ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
        ];
        for (first, second, expected) in pairs {
            for found in [ciede2000(first, second), ciede2000(second, first)] {
                assert!((found - expected).abs() < 5e-5, "{first:?} {second:?}: {found}");
            }
        }
    }

    #[test]
    fn the_curve_is_continuous_and_clips() {
        assert!((srgb(0.003_130_8) - srgb(0.003_130_8 + 1e-12)).abs() < 1e-7);
        assert!((srgb(1.0) - 1.0).abs() < 1e-15);
        assert_eq!([srgb(-1.0), srgb(7.0)], [0.0, srgb(1.0)]);
    }

    #[test]
    fn white_is_neutral() {
        let [lightness, a, b] = lab([1.0; 3]);
        assert!((lightness - 100.0).abs() < 1e-9 && a.abs() < 0.01 && b.abs() < 0.02);
    }
}

//! Free-standing moduli of the paper's shapes by quadrature: `E = H (z* - z) / (w theta')`, largest 12.6 MPa.

use std::f64::consts::PI;

pub const LENGTH_MM: f64 = 100.0;
const LARGEST_MPA: f64 = 12.6;
/// Gauss and Legendre's five points on [0, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.046910077030668, 0.118463442528095),
    (0.230765344947158, 0.239314335249683),
    (0.5, 0.284444444444444),
    (0.769234655052842, 0.239314335249683),
    (0.953089922969332, 0.118463442528095),
];

/// Inclination in rad and its first two derivatives with respect to `xi = s / L`, from degrees, highest power first.
fn polynomial(coefficients_deg: &[f64], xi: f64) -> [f64; 3] {
    let [mut value, mut slope, mut bend] = [0.0; 3];
    for c in coefficients_deg {
        bend = bend * xi + 2.0 * slope;
        slope = slope * xi + value;
        value = value * xi + c.to_radians();
    }
    [value, slope, bend]
}

/// Moduli at `count` even stations of a strip whose inclination is a polynomial of `xi`.
pub fn inclination_polynomial(coefficients_deg: &[f64], spokes: usize, hub_share: f64, count: usize) -> Vec<f64> {
    let theta = |xi: f64| polynomial(coefficients_deg, xi);
    let integral = |from: f64, to: f64| {
        GAUSS.iter().fold([0.0; 2], |[x, z], (p, w)| {
            let angle = theta(from + (to - from) * p)[0];
            [x + w * (to - from) * angle.cos(), z + w * (to - from) * angle.sin()]
        })
    };
    let xi = |i: usize| i as f64 / (count - 1) as f64;
    let mut points = vec![[0.0; 2]];
    for i in 1..count {
        let [x, z] = integral(xi(i - 1), xi(i));
        points.push([points[i - 1][0] + x, points[i - 1][1] + z]);
    }
    let end = points[count - 1];
    let width = |x: f64| 2.0 * (PI / spokes as f64).tan() * (hub_share + end[0] - x);
    let inflection = (1..count).find(|&i| theta(xi(i - 1))[1] * theta(xi(i))[1] <= 0.0).map(|i| {
        let [mut low, mut high] = [xi(i - 1), xi(i)];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if theta(low)[1] * theta(middle)[1] <= 0.0 { high = middle } else { low = middle }
        }
        (low, points[i - 1][1] + integral(xi(i - 1), low)[1])
    });
    let curvature_width = |i: usize| width(points[i][0]) * theta(xi(i))[1];
    let height = match inflection {
        Some((_, z)) => z,
        None => curvature_width(0) * end[1] / (curvature_width(0) - curvature_width(count - 1)),
    };
    let moduli = (0..count).map(|i| match inflection {
        // 0/0: the ratio of the derivatives.
        Some((at, _)) if (xi(i) - at).abs() < 1e-6 => {
            let [angle, _, bend] = theta(at);
            -angle.sin() / (width(points[i][0]) * bend)
        }
        _ => (height - points[i][1]) / curvature_width(i),
    });
    scaled(moduli.collect())
}

/// Moduli at `count` even stations of a quarter ellipse, horizontal over vertical semi-axis `aspect`, hub radius 0.1 L.
pub fn hemi_ellipsoid(aspect: f64, spokes: usize, count: usize) -> Vec<f64> {
    let speed = |q: f64| aspect.mul_add(aspect * q.sin().powi(2), q.cos().powi(2)).sqrt();
    let steps = 2000;
    let step = 0.5 * PI / steps as f64;
    let total: f64 = (0..steps).flat_map(|i| GAUSS.map(|(p, w)| w * step * speed((i as f64 + p) * step))).sum();
    // Arc length in units of the strip: dq/dxi = total / speed(q), by Runge and Kutta.
    let substeps = 8;
    let h = 1.0 / ((count - 1) * substeps) as f64;
    let rate = |q: f64| total / speed(q);
    let mut q = vec![0.0_f64];
    for _ in 1..count {
        let mut now = q[q.len() - 1];
        for _ in 0..substeps {
            let a = rate(now);
            let b = rate(now + 0.5 * h * a);
            let c = rate(now + 0.5 * h * b);
            let d = rate(now + h * c);
            now += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        q.push(now);
    }
    let curvature_width = |q: f64| {
        let radius = 0.1 + aspect / total * q.cos();
        -2.0 * (PI / spokes as f64).tan() * radius * aspect * total / speed(q).powi(3)
    };
    let height = |q: f64| q.sin() / total;
    let ends = [curvature_width(0.0), curvature_width(0.5 * PI)];
    let neutral = ends[0] * height(0.5 * PI) / (ends[0] - ends[1]);
    scaled(q.iter().map(|&q| (neutral - height(q)) / curvature_width(q)).collect())
}

fn scaled(ratio: Vec<f64>) -> Vec<f64> {
    let sign = ratio[0].signum();
    let largest = ratio.iter().map(|e| sign * e).fold(0.0, f64::max);
    ratio.iter().map(|e| sign * LARGEST_MPA * e / largest).collect()
}

//! Several tensile tests of one material: means, scatter, and the material they give.

use std::path::Path;

use serde::Serialize;

use super::TensileFigures;
use crate::input::InputError;
use crate::materials::Material;

/// Digits of the material's values: more than any test has.
const DIGITS: usize = 6;

/// Mean and scatter of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Statistic {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample, by `n - 1`; of a single value `None`.
    pub standard_deviation: Option<f64>,
    /// Values.
    pub count: usize,
}

impl Statistic {
    /// Mean and standard deviation of some values; `None` without any.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let standard_deviation = (count > 1).then(|| (squares / (count as f64 - 1.0)).sqrt());
        (count > 0).then_some(Self { mean, standard_deviation, count })
    }

    /// Standard deviation over the mean, percent.
    #[must_use]
    pub fn variation_percent(&self) -> Option<f64> {
        self.standard_deviation.map(|s| 100.0 * s / self.mean)
    }
}

/// Tests of one material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TensileSample {
    /// What each says.
    pub specimens: Vec<TensileFigures>,
    /// Young's modulus, MPa.
    pub modulus_mpa: Statistic,
    /// 0.2 % offset yield strength of those that have one, MPa.
    pub yield_strength_mpa: Option<Statistic>,
    /// Strain there.
    pub yield_strain: Option<Statistic>,
    /// Largest stress, MPa.
    pub strength_mpa: Statistic,
    /// Strain at break.
    pub break_strain: Statistic,
    /// The smallest strain at break.
    pub least_break_strain: f64,
}

impl TensileSample {
    /// Gathers the figures of tests; `None` without any.
    #[must_use]
    pub fn new(specimens: Vec<TensileFigures>) -> Option<Self> {
        let of = |pick: &dyn Fn(&TensileFigures) -> Option<f64>| {
            Statistic::of(&specimens.iter().filter_map(pick).collect::<Vec<f64>>())
        };
        Some(Self {
            modulus_mpa: of(&|s| Some(s.modulus_mpa))?,
            yield_strength_mpa: of(&|s| s.yield_point.map(|y| y.strength_mpa)),
            yield_strain: of(&|s| s.yield_point.map(|y| y.strain)),
            strength_mpa: of(&|s| Some(s.strength_mpa))?,
            break_strain: of(&|s| Some(s.break_strain))?,
            least_break_strain: specimens.iter().fold(f64::INFINITY, |m, s| m.min(s.break_strain)),
            specimens,
        })
    }

    /// Whether every test has a yield point; a mean over some of them would be that of the weaker ones.
    #[must_use]
    pub fn all_yield(&self) -> bool {
        self.specimens.iter().all(|s| s.yield_point.is_some())
    }

    /// The material: mean modulus and its scatter, mean yield where every test has one, and the smallest strain at break.
    ///
    /// # Errors
    /// [`InputError`] for values that no custom material may have.
    pub fn material(&self, name: &str, poisson: f64) -> Result<Material, InputError> {
        let of_yield = |s: Option<Statistic>| s.filter(|_| self.all_yield()).map(|s| rounded(s.mean));
        let material = Material {
            modulus_scatter_percent: self.modulus_mpa.variation_percent().map(rounded),
            yield_strength_mpa: of_yield(self.yield_strength_mpa),
            yield_strain: of_yield(self.yield_strain),
            max_strain: Some(rounded(self.least_break_strain)),
            ..Material::new(name, rounded(self.modulus_mpa.mean), poisson)
        };
        material.validate()?;
        Ok(material)
    }
}

/// A material as a table of a design file, with the tests it comes from as a comment.
///
/// # Errors
/// None in practice: a material is a table of texts and numbers.
pub fn to_toml(material: &Material, sample: &TensileSample) -> Result<String, toml::ser::Error> {
    #[derive(Serialize)]
    struct Materials<'a> {
        custom: [&'a Material; 1],
    }
    #[derive(Serialize)]
    struct Document<'a> {
        materials: Materials<'a>,
    }
    let table = toml::to_string(&Document { materials: Materials { custom: [material] } })?;
    // Names without folders, which say nothing elsewhere; a control character would end the comment.
    let name = |s: &TensileFigures| {
        let file = Path::new(&s.file).file_name().map_or_else(String::new, |f| f.to_string_lossy().into_owned());
        file.replace(|c: char| c.is_control(), "?")
    };
    let files: Vec<String> = sample.specimens.iter().map(name).collect();
    Ok(format!("# From {} tensile test(s): {}\n{table}", files.len(), files.join(", ")))
}

fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::tensile::{Specimen, evaluate, parse_curve};

    fn sample(moduli: &[f64], end: f64) -> TensileSample {
        let of = |modulus: &f64| {
            let stress = |e: f64| modulus * e.min(0.01) + 0.05 * modulus * (e - 0.01).max(0.0);
            let row = |i: u32| {
                let e = 1e-4 * f64::from(i);
                format!("{e},{}\n", stress(e))
            };
            let rows: String = (0..=(end / 1e-4).round() as u32).map(row).collect();
            let curve = parse_curve(format!("strain,stress_mpa\n{rows}").as_bytes(), "a.csv", &Specimen::default());
            evaluate(&curve.unwrap(), None).unwrap()
        };
        TensileSample::new(moduli.iter().map(of).collect()).unwrap()
    }

    #[test]
    fn scatter_is_that_of_the_sample() {
        let three = sample(&[1900.0, 2000.0, 2100.0], 0.05);
        assert!((three.modulus_mpa.mean - 2000.0).abs() < 1e-6);
        assert!((three.modulus_mpa.standard_deviation.unwrap() - 100.0).abs() < 1e-6);
        assert!((three.modulus_mpa.variation_percent().unwrap() - 5.0).abs() < 1e-8);
        let made = three.material("my resin", 0.3).unwrap();
        assert_eq!((made.modulus_mpa, made.modulus_scatter_percent), (2000.0, Some(5.0)));
        // E 0.01 + 0.05 E (e - 0.01) = E (e - 0.002), whatever the modulus.
        assert_eq!(made.yield_strain, Some(rounded(0.01 + 0.002 / 0.95)));
        assert!((made.max_strain.unwrap() - 0.05).abs() < 1e-9);
        assert!((three.yield_strength_mpa.unwrap().variation_percent().unwrap() - 5.0).abs() < 1e-6);
        let one = sample(&[2000.0], 0.05);
        assert_eq!(one.modulus_mpa.standard_deviation, None);
        assert_eq!(one.material("x", 0.3).unwrap().modulus_scatter_percent, None);
        assert!(TensileSample::new(Vec::new()).is_none());
    }

    #[test]
    fn what_breaks_before_it_yields_has_no_yield() {
        let brittle = sample(&[1900.0, 2100.0], 0.009);
        let made = brittle.material("x", 0.3).unwrap();
        assert_eq!((made.yield_strength_mpa, made.yield_strain, made.max_strain), (None, None, Some(0.009)));
        let mixed = TensileSample::new(
            [sample(&[2000.0], 0.05), brittle].into_iter().flat_map(|s| s.specimens).collect::<Vec<_>>(),
        );
        let mixed = mixed.unwrap();
        assert!(!mixed.all_yield() && mixed.yield_strength_mpa.unwrap().count == 1);
        assert_eq!(mixed.material("x", 0.3).unwrap().yield_strain, None);
    }

    #[test]
    fn values_that_no_material_has_are_refused() {
        let plain = sample(&[2000.0], 0.05);
        for (name, poisson, key) in
            [("", 0.3, "name"), ("--", 0.3, "name"), ("x", 0.5, "poisson"), ("x", f64::NAN, "poisson")]
        {
            let error = plain.material(name, poisson).unwrap_err().to_string();
            assert!(error.contains(key), "{name} {poisson}: {error}");
        }
    }
}

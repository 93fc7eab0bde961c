//! Isotropic elasticity of small and of large strains.

use nalgebra::Matrix3;

use super::{COMPONENTS, PAIRS, Voigt};

/// How stress follows strain in large displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Law {
    /// St. Venant and Kirchhoff: Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress. Its stress
    /// falls once a fibre is shorter than `1/sqrt(3)` of its length, so it is for moderate strains.
    #[default]
    SaintVenantKirchhoff,
    /// Compressible neo-Hookean, `W = mu/2 (J^(-2/3) I_1 - 3) + K/2 (J - 1)^2`; the same in small strains.
    NeoHooke,
}

impl Law {
    /// Whether the enhanced modes of a brick depend on its displacements in a way that has to be iterated.
    #[must_use]
    pub fn needs_modes(self) -> bool {
        self != Self::SaintVenantKirchhoff
    }
}

/// An isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    /// Young's modulus, MPa.
    pub modulus: f64,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poisson: f64,
}

impl Isotropic {
    /// Lame's first constant `E nu / ((1 + nu)(1 - 2 nu))`, MPa.
    #[must_use]
    pub fn lambda(&self) -> f64 {
        self.modulus * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus `E / (2 (1 + nu))`, MPa.
    #[must_use]
    pub fn shear(&self) -> f64 {
        0.5 * self.modulus / (1.0 + self.poisson)
    }

    /// Bulk modulus `E / (3 (1 - 2 nu))`, MPa.
    #[must_use]
    pub fn bulk(&self) -> f64 {
        self.modulus / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// `C e`: Hooke's law.
    #[must_use]
    pub fn stress(&self, strain: &Voigt) -> Voigt {
        let (shear, trace) = (self.shear(), self.lambda() * (strain[0] + strain[1] + strain[2]));
        let normal = |k: usize| trace + 2.0 * shear * strain[k];
        [normal(0), normal(1), normal(2), shear * strain[3], shear * strain[4], shear * strain[5]]
    }

    /// `C^-1 s`: the strain under a stress.
    #[must_use]
    pub fn strain(&self, stress: &Voigt) -> Voigt {
        let (compliance, trace) = (1.0 / self.modulus, self.poisson * (stress[0] + stress[1] + stress[2]));
        let normal = |k: usize| compliance * ((1.0 + self.poisson) * stress[k] - trace);
        let doubled = 1.0 / self.shear();
        [normal(0), normal(1), normal(2), doubled * stress[3], doubled * stress[4], doubled * stress[5]]
    }

    /// Energy density, second Piola-Kirchhoff stress and its derivative by the Green-Lagrange strain, in MPa; `None` where
    /// the strain turns the material inside out.
    #[must_use]
    pub fn respond(&self, law: Law, strain: &Voigt) -> Option<Response> {
        match law {
            Law::SaintVenantKirchhoff => {
                let stress = self.stress(strain);
                let energy = 0.5 * dot(&stress, strain);
                let tangent = std::array::from_fn(|j| {
                    let mut unit = [0.0; COMPONENTS];
                    unit[j] = 1.0;
                    self.stress(&unit)
                });
                Some(Response { energy, stress, tangent })
            }
            Law::NeoHooke => self.neo_hooke(strain),
        }
    }

    /// With `C = 1 + 2 E`, `P = J^(-2/3)`, `c = C^-1` and `II_ijkl = (c_ik c_jl + c_il c_jk)/2`:
    ///
    /// ```text
    /// S  = mu P (1 - I_1/3 c) + K J (J - 1) c
    /// dS = mu P (-2/3 (1 x c + c x 1) + 2/9 I_1 c x c + 2/3 I_1 II) + K J (2 J - 1) c x c - 2 K J (J - 1) II
    /// ```
    fn neo_hooke(&self, strain: &Voigt) -> Option<Response> {
        let right = Matrix3::from_fn(|i, j| {
            let component = PAIRS.iter().position(|p| *p == [i.min(j), i.max(j)]).unwrap_or(0);
            if i == j { 1.0 + 2.0 * strain[component] } else { strain[component] }
        });
        let determinant = right.determinant();
        // A determinant of the product of two negative stretches is positive as well; the leading minors are not.
        let minor = right[(0, 0)] * right[(1, 1)] - right[(0, 1)] * right[(1, 0)];
        if !(determinant > 1e-9 && minor > 0.0 && right[(0, 0)] > 0.0) {
            return None;
        }
        let inverse = right.try_inverse()?;
        let (volume, first) = (determinant.sqrt(), right.trace());
        let (shear, bulk) = (self.shear() * volume.powf(-2.0 / 3.0), self.bulk());
        let unit = |k: usize| if k < 3 { 1.0 } else { 0.0 };
        let c: Voigt = PAIRS.map(|[i, j]| inverse[(i, j)]);
        let pressure = bulk * volume * (volume - 1.0);
        let stress = std::array::from_fn(|k| shear * (unit(k) - first / 3.0 * c[k]) + pressure * c[k]);
        let both = 2.0 / 3.0 * shear * first - 2.0 * pressure;
        let square = 2.0 / 9.0 * shear * first + bulk * volume * (2.0 * volume - 1.0);
        let tangent = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let ([i, j], [k, l]) = (PAIRS[a], PAIRS[b]);
                let fourth = 0.5 * (inverse[(i, k)] * inverse[(j, l)] + inverse[(i, l)] * inverse[(j, k)]);
                square * c[a] * c[b] - 2.0 / 3.0 * shear * (unit(a) * c[b] + c[a] * unit(b)) + both * fourth
            })
        });
        let energy = 0.5 * (shear * first - 3.0 * self.shear()) + 0.5 * bulk * (volume - 1.0).powi(2);
        Some(Response { energy, stress, tangent })
    }
}

/// What a material answers to a strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Energy a volume of the flat state, MPa.
    pub energy: f64,
    /// Second Piola-Kirchhoff stress, MPa.
    pub stress: Voigt,
    /// Its derivative by the Green-Lagrange strain, MPa.
    pub tangent: [Voigt; COMPONENTS],
}

pub(crate) fn dot(a: &Voigt, b: &Voigt) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: Isotropic = Isotropic { modulus: 12.6, poisson: 0.3 };

    #[test]
    fn strain_is_the_inverse_of_stress() {
        let strain = [0.1, -0.2, 0.05, 0.3, -0.1, 0.02];
        let back = MATERIAL.strain(&MATERIAL.stress(&strain));
        assert!(strain.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-15));
        // Uniaxial stress: the modulus along, minus nu times that across.
        let pulled = MATERIAL.strain(&[12.6, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((pulled[0] - 1.0).abs() < 1e-15 && (pulled[1] + 0.3).abs() < 1e-15);
    }

    #[test]
    fn stress_and_tangent_are_derivatives_of_the_energy_and_both_laws_agree_in_small_strains() {
        let strain = [0.15, -0.2, 0.05, 0.3, -0.12, 0.08];
        for law in [Law::SaintVenantKirchhoff, Law::NeoHooke] {
            let here = MATERIAL.respond(law, &strain).unwrap();
            for k in 0..COMPONENTS {
                let step = 1e-6;
                let at = |d: f64| {
                    let mut moved = strain;
                    moved[k] += d;
                    MATERIAL.respond(law, &moved).unwrap()
                };
                let (low, high) = (at(-step), at(step));
                let slope = (high.energy - low.energy) / (2.0 * step);
                assert!((slope - here.stress[k]).abs() < 1e-7, "{law:?} {k}: {slope} {}", here.stress[k]);
                for j in 0..COMPONENTS {
                    let slope = (high.stress[j] - low.stress[j]) / (2.0 * step);
                    assert!((slope - here.tangent[j][k]).abs() < 1e-6, "{law:?} {j} {k}");
                }
            }
        }
        let small = strain.map(|e| 1e-7 * e);
        let [a, b] =
            [Law::SaintVenantKirchhoff, Law::NeoHooke].map(|law| MATERIAL.respond(law, &small).unwrap().stress);
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-11), "{a:?} {b:?}");
    }

    #[test]
    fn a_strain_that_turns_the_material_inside_out_has_no_stress() {
        assert_eq!(MATERIAL.respond(Law::NeoHooke, &[-0.5, 0.0, 0.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(MATERIAL.respond(Law::NeoHooke, &[-0.7, -0.7, 0.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(MATERIAL.respond(Law::NeoHooke, &[f64::NAN; 6]), None);
    }
}

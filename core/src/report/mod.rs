//! Stub.
#![allow(missing_docs)]
use crate::{
    Design,
    modulus_field::ModulusField,
    output::{Provenance, Summary},
};
pub fn html(
    _d: &Design,
    _s: &Summary,
    _f: Option<&ModulusField>,
    p: &Provenance,
    _x: &[(String, String)],
) -> Result<String, std::fmt::Error> {
    Ok(p.line())
}
pub struct VerificationPicture {
    pub name: String,
    pub target: Vec<[f64; 2]>,
    pub prediction: Option<Vec<[f64; 2]>>,
    pub solver: Vec<[f64; 2]>,
    pub solver_name: String,
    pub max_error_percent: f64,
    pub rms_error_percent: f64,
    pub length_mm: f64,
}
pub fn verification_svg(_v: &VerificationPicture) -> String {
    "<svg/>".to_owned()
}

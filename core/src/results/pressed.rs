//! Indentation by CalculiX: the deck of one spoke under load is written, solved and read.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use super::ccx_dat::{NodePrint, Quantity, parse};
use super::ccx_elements::{ContactPrint, LargestStrain, contacts, largest_strains};
use crate::deck::{self, DeckError};
use crate::design::Design;
use crate::error::Error;
use crate::indentation::{
    Indentation, IndentationModel, LoadPoint, ModulusBand, PhaseStrain, Press, curve_warnings, rigidity, smooth_volume,
    tangent, work,
};
use crate::input::IndentationInput;
use crate::output::Provenance;
use crate::solver::ccx::{Ccx, Status};

/// Times at which the dome is closed and at which it has been pressed.
const CLOSED: f64 = 1.0;
const PRESSED: f64 = 2.0;

/// Presses a design's dome with CalculiX in `work`, where the deck and all that the solver writes stay.
///
/// # Errors
/// [`Error::Input`] for what is no dome or not as high, [`Error::Solver`], [`Error::Output`], [`Error::Cancelled`].
pub fn press(
    design: &Design,
    input: &IndentationInput,
    ccx: &Ccx,
    work: &Path,
    progress: &dyn Fn(Status) -> bool,
) -> Result<Indentation, Error> {
    Press::new(design, input)?;
    let path = work.join("graded_solid_indentation.inp");
    let file = File::create(&path).map_err(|e| Error::output(&path, &e))?;
    let mut out = BufWriter::new(file);
    deck::write_pressed_solid(design, input, &Provenance::of(design.input()), &mut out, &crate::progress::ignore)
        .map_err(|e| match e {
            DeckError::Io(error) => Error::output(&path, &error),
            DeckError::Cancelled => Error::Cancelled,
            DeckError::NotOffered { .. } => Error::Internal(e.to_string()),
        })?;
    out.flush().map_err(|e| Error::output(&path, &e))?;
    let run = ccx.run(&path, work, progress)?;
    let unread =
        |e: super::ResultError| Error::Solver(format!("{}: the solver's result cannot be read: {e}", path.display()));
    let read = Read {
        blocks: parse(&run.dat).map_err(unread)?,
        strains: largest_strains(&run.dat).map_err(unread)?,
        contacts: contacts(&run.dat).map_err(unread)?,
    };
    let (start_force, curve) = read.curve(design).ok_or_else(|| {
        Error::Solver(format!("{}: the solver did not print all that a curve is made of", path.display()))
    })?;
    Ok(summed(design, input, start_force, curve, read.penetration()))
}

/// What the solver printed.
struct Read {
    blocks: Vec<NodePrint>,
    strains: Vec<LargestStrain>,
    contacts: Vec<ContactPrint>,
}

impl Read {
    /// The first row of a set's quantity at a time.
    fn at(&self, time: f64, set: &str, quantity: Quantity) -> Option<[f64; 3]> {
        let is_it = |b: &&NodePrint| b.time == time && b.set == set && b.quantity == quantity;
        Some(self.blocks.iter().find(is_it)?.rows.first()?.1)
    }

    /// The force that pushes the hub down before pressing, N, and one point a time from the closed dome on.
    fn curve(&self, design: &Design) -> Option<(f64, Vec<LoadPoint>)> {
        let hub = self.blocks.iter().filter(|b| b.set == "RP-HUB" && b.quantity == Quantity::Displacement);
        let times: Vec<f64> = hub.map(|b| b.time).filter(|t| *t >= CLOSED - 1e-9).collect();
        if times.len() < 3 || times[0] > CLOSED + 1e-6 || times[times.len() - 1] < PRESSED - 1e-6 {
            return None;
        }
        let state = |time: f64| {
            let height = self.at(time, "RP-HUB", Quantity::Displacement)?[2];
            let lift = self.at(time, "RP-RIM", Quantity::Force)?[2];
            let energy = self.at(time, "SPOKE", Quantity::InternalEnergy)?[0];
            Some([height, lift, energy])
        };
        let start = state(times[0])?;
        let slices = design.input().decks.calculix_graded_elements[0];
        let points = times
            .into_iter()
            .map(|time| {
                let [height, lift, energy] = state(time)?;
                let plate = self.at(time, "PLATE", Quantity::TotalForce).map_or(0.0, |f| -f[2]);
                Some(LoadPoint {
                    depth_mm: start[0] - height,
                    force_n: lift - start[1],
                    contact_force_n: plate.max(0.0),
                    contact_length_mm: self.contact_length(time, design, slices),
                    strain_energy_nmm: energy - start[2],
                    largest_strain: self.strains.iter().find(|s| s.time == time)?.strain,
                    iterations: 0,
                })
            })
            .collect::<Option<Vec<LoadPoint>>>()?;
        Some((start[1], points))
    }

    /// How far from the hub end the spoke touches the plate, mm.
    fn contact_length(&self, time: f64, design: &Design, slices: usize) -> f64 {
        let [_, across, through] = design.input().decks.calculix_graded_elements;
        let touching = self.contacts.iter().filter(|c| c.time == time).flat_map(|c| &c.clearances);
        let slice = |element: u64| (element as usize - 1) / (across * through);
        let first = touching.filter(|(_, clearance)| *clearance < 0.0).map(|(element, _)| slice(*element)).min();
        // From the middle of the farthest element that touches.
        first.map_or(0.0, |i| design.input().strips.length_mm * (1.0 - (i as f64 + 0.5) / slices as f64))
    }

    /// Deepest penetration, mm.
    fn penetration(&self) -> f64 {
        self.contacts.iter().flat_map(|c| &c.clearances).fold(0.0, |deepest, (_, clearance)| deepest.max(-clearance))
    }
}

fn summed(
    design: &Design,
    input: &IndentationInput,
    start_force: f64,
    curve: Vec<LoadPoint>,
    penetration: f64,
) -> Indentation {
    let [volume, mean_modulus] = smooth_volume(design);
    let strain = curve.iter().fold(0.0_f64, |m, p| m.max(p.largest_strain));
    let largest = PhaseStrain::of_mixture(design, strain);
    let mut warnings = curve_warnings(&curve, None);
    warnings.extend(largest.warnings());
    let work = work(&curve);
    let band = ModulusBand::new(design, input);
    Indentation {
        model: IndentationModel::Calculix,
        indenter: input.indenter,
        bending: None,
        spokes: design.input().count(),
        start_force_n: start_force,
        tangent_n_mm: tangent(&curve),
        rigidity_n_mm: rigidity(&curve, design.input().strips.thickness_mm),
        work_nmm: work,
        strain_energy_nmm: curve.last().map_or(0.0, |p| p.strain_energy_nmm),
        specific_energy_nmm_mm3: work / volume,
        volume_mm3: volume,
        mean_modulus_mpa: mean_modulus,
        largest_strain: vec![largest],
        modulus_band_percent: band.percent,
        modulus_band_from: band.source,
        penetration_mm: penetration,
        curve,
        warnings,
    }
}

//! Scans: a meridian or points of a dome, without knowledge which material point is where.

use nalgebra::Vector3;

use super::curve::Curve;
use super::dome::{Dome, Face, Surface};
use super::placement::{AXIAL, FACETED, Fit, Freedom, Limits, PLANAR, Placement, ROUND, clipped_cost, median, refine};
use super::record::{Deviation, PlacementRecord, PointStatistics};
use super::table::Kind;
use super::{Compared, Job, MeasuredOptions, PlacementChoice, start};
use crate::error::Error;
use crate::input::InputError;
use crate::progress::{Cancelled, stops_at};

/// Points that the fit uses at most; the errors are those of all.
const FITTED: usize = 20_000;
/// Points further away are no part of the dome, as a share of the length.
const STRAY: f64 = 0.1;
/// Largest distance that tells surfaces apart, as a share of the length.
const CLIP: f64 = 0.03;
/// Points may lie so many spreads beyond an end of the meridian and still count; at least a share of the length.
const BEYOND: (f64, f64) = (4.0, 0.001);
/// Stations of the mean meridian at most, and points that each should have.
const STATIONS: usize = 100;
const POINTS_A_STATION: usize = 40;
/// Points of the picture.
const CLOUD: usize = 1000;

pub(super) fn compare(job: &Job<'_>, options: MeasuredOptions, cancelled: Cancelled<'_>) -> Result<Compared, Error> {
    let points: Vec<Vector3<f64>> = job.table.rows.iter().map(|p| Vector3::from(*p)).collect();
    let input = job.design.input();
    let half = 0.5 * input.strips.thickness_mm;
    let outside = match options.face {
        Face::Middle => 0.0,
        Face::Outer => half,
        Face::Inner => -half,
    };
    // The hub's edge is where the strip ends, so that a shape that is too short comes nearer to the axis.
    let dome = |line: &Curve, spokes: Option<usize>| {
        let reach = input.hub_radius() + line.end()[0];
        let profile = &job.design.profile().s;
        let stations = profile.iter().map(|s| (*s, line.position(*s))).map(|(s, [x, z])| [s, reach - x, z]);
        let curve = Curve::new(stations).ok_or_else(|| Error::Internal("a meridian without length".to_owned()))?;
        Ok::<_, Error>(Dome { curve, hub: job.table.kind == Kind::Points, spokes, outside })
    };
    let search = Search { job, points, options, cancelled };
    let target = dome(&job.target, None)?;
    let (fit, surface) = match job.table.kind {
        Kind::Points => search.points(&target)?,
        _ => (search.meridian(&target)?, None),
    };
    let spokes = (surface == Some(Surface::Spokes)).then(|| input.count());
    let target = Dome { spokes, ..target };
    let (deviation, mean) = search.deviation(&target, &fit)?;
    let rim = target.curve.points()[0][0];
    let midline = mean.iter().map(|[s, rho, z]| [*s, rim - rho, *z]).collect();
    let prediction = match &job.prediction {
        None => None,
        Some(line) => {
            let dome = dome(line, spokes)?;
            let fit = match options.placement {
                PlacementChoice::AsGiven => fit,
                _ => search.refined(&dome, fit.placement, search.freedom(spokes.is_some()))?,
            };
            Some(search.deviation(&dome, &fit)?.0)
        }
    };
    Ok(Compared { target: deviation, prediction, surface, midline })
}

struct Search<'a> {
    job: &'a Job<'a>,
    points: Vec<Vector3<f64>>,
    options: MeasuredOptions,
    cancelled: Cancelled<'a>,
}

impl Search<'_> {
    fn freedom(&self, spokes: bool) -> Freedom {
        match self.job.table.kind {
            Kind::Points if spokes => FACETED,
            Kind::Points => ROUND,
            // With both sides of the axis in it a meridian tells where the axis is.
            _ if self.points.iter().any(|p| p.x < 0.0) => PLANAR,
            _ => AXIAL,
        }
    }

    fn refined(&self, dome: &Dome, start: Placement, freedom: Freedom) -> Result<Fit, Error> {
        let some = start::spread_out(&self.points, FITTED);
        refine(dome, &some, start, freedom, Limits::FINE, self.cancelled).ok_or(Error::Cancelled)
    }

    /// A placement that stays what it is.
    fn as_given(&self, dome: &Dome) -> Result<Fit, Error> {
        let none = Limits { iterations: 0, scale: None };
        let some = start::spread_out(&self.points, FITTED);
        refine(dome, &some, Placement::IDENTITY, [false; 6], none, self.cancelled).ok_or(Error::Cancelled)
    }

    fn meridian(&self, dome: &Dome) -> Result<Fit, Error> {
        if self.options.placement == PlacementChoice::AsGiven {
            return self.as_given(dome);
        }
        // From where the heights agree on the average; the wider end may be the upper one only if it is so in the design.
        let [low, high] = dome.heights();
        let mut heights: Vec<f64> = self.points.iter().map(|p| p.z).collect();
        heights.sort_by(f64::total_cmp);
        let middle = 0.5 * (heights[0] + heights[heights.len() - 1]);
        let shift = Vector3::new(0.0, 0.0, 0.5 * (low + high) - middle);
        let start = Placement { shift, ..Placement::IDENTITY };
        let coarse = Limits { iterations: 50, scale: Some(self.job.length()) };
        let some = start::spread_out(&self.points, FITTED);
        let freedom = self.freedom(false);
        let near = refine(dome, &some, start, freedom, coarse, self.cancelled).ok_or(Error::Cancelled)?;
        self.refined(dome, near.placement, freedom)
    }

    /// The fits to the surfaces that may be asked for, from the best starts.
    fn found(&self, round: &Dome, faceted: &Dome) -> Result<Vec<(Fit, Surface)>, Error> {
        let (points, length) = (&self.points, self.job.length());
        let wants = |surface| self.options.surface.is_none_or(|s| s == surface);
        let on_round = start::round(round, points, length, self.cancelled).ok_or(Error::Cancelled)?;
        let mut starts = Vec::new();
        if wants(Surface::Spokes) {
            let found = start::faceted(faceted, points, &on_round.1, length, self.cancelled).ok_or(Error::Cancelled)?;
            starts.push((found, Surface::Spokes));
        }
        if wants(Surface::Revolution) {
            starts.push((on_round, Surface::Revolution));
        }
        if starts.iter().all(|(found, _)| start::is_poor(found, length)) {
            for (found, surface) in &mut starts {
                let dome = if *surface == Surface::Spokes { faceted } else { round };
                let other = start::beside(dome, points, length, self.cancelled).ok_or(Error::Cancelled)?;
                if other.0 < found.0 {
                    *found = other;
                }
            }
        }
        let mut fits = Vec::new();
        for ((_, start), surface) in starts {
            let (dome, freedom) = if surface == Surface::Spokes { (faceted, FACETED) } else { (round, ROUND) };
            fits.push((self.refined(dome, start, freedom)?, surface));
        }
        Ok(fits)
    }

    /// Places points of a dome; the surface is the one asked for, or the one they fit better.
    fn points(&self, round: &Dome) -> Result<(Fit, Option<Surface>), Error> {
        let length = self.job.length();
        let faceted = Dome { spokes: Some(self.job.design.input().count()), ..round.clone() };
        let mut fits = Vec::new();
        if self.options.placement == PlacementChoice::AsGiven {
            fits.push((self.as_given(round)?, Surface::Revolution));
            fits.push((self.as_given(&faceted)?, Surface::Spokes));
        } else {
            fits = self.found(round, &faceted)?;
        }
        if let Some(surface) = self.options.surface {
            fits.retain(|f| f.1 == surface);
        }
        let some = start::spread_out(&self.points, FITTED);
        let cost = |(fit, surface): &(Fit, Surface)| {
            let dome = if *surface == Surface::Spokes { &faceted } else { round };
            clipped_cost(dome, &some, &fit.placement, CLIP * length)
        };
        let best = fits.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        best.map(|(fit, surface)| (fit, Some(surface)))
            .ok_or_else(|| Error::Internal("no surface to compare with".to_owned()))
    }

    /// The distances from a dome, and the mean meridian `[s, rho, z]`.
    fn deviation(&self, dome: &Dome, fit: &Fit) -> Result<(Deviation, Vec<[f64; 3]>), Error> {
        let length = self.job.length();
        let beyond = (BEYOND.0 * fit.spread).max(BEYOND.1 * length);
        let mut statistics = PointStatistics {
            compared: 0,
            stray: 0,
            on_hub: 0,
            beyond_ends: 0,
            rms_mm: 0.0,
            p95_mm: 0.0,
            max_mm: 0.0,
            mean_mm: 0.0,
        };
        let stations = (self.points.len() / POINTS_A_STATION).clamp(10, STATIONS);
        let mut bins = vec![(Vec::new(), 0.0); stations];
        let mut distances = Vec::with_capacity(self.points.len());
        let mut cloud = Vec::new();
        let every = self.points.len().div_ceil(CLOUD).max(1);
        let rim = dome.curve.points()[0][0];
        for (i, point) in self.points.iter().enumerate() {
            if stops_at(i, self.cancelled) {
                return Err(Error::Cancelled);
            }
            let d = dome.distance(&fit.placement.apply(point));
            let Some(s) = d.s else {
                statistics.on_hub += usize::from(d.signed.abs() <= STRAY * length);
                statistics.stray += usize::from(d.signed.abs() > STRAY * length);
                continue;
            };
            if d.signed.abs() > STRAY * length {
                statistics.stray += 1;
                continue;
            }
            if d.beyond > beyond {
                statistics.beyond_ends += 1;
                continue;
            }
            let bin = ((s / length * stations as f64) as usize).min(stations - 1);
            bins[bin].0.push(d.signed);
            bins[bin].1 += s;
            distances.push(d.signed);
            if i % every == 0 {
                let ([rho, z], out) = (dome.curve.position(s), dome.curve.normal(s).map(|c| -c));
                cloud.push([rim - rho - d.signed * out[0], z + d.signed * out[1]]);
            }
        }
        let count = distances.len();
        if count < 3 {
            let problem = format!("only {count} of {} points lie on the dome", self.points.len());
            let error = InputError::new("", "", problem).help("lengths are in mm; is it a scan of this design?");
            return Err(Error::Input(error.in_file(&self.job.table.file)));
        }
        statistics.compared = count;
        statistics.mean_mm = distances.iter().sum::<f64>() / count as f64;
        statistics.rms_mm = (distances.iter().map(|d| d * d).sum::<f64>() / count as f64).sqrt();
        let mut sizes: Vec<f64> = distances.iter().map(|d| d.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        statistics.p95_mm = sizes[(count * 95).div_ceil(100).min(count) - 1];
        statistics.max_mm = sizes[count - 1];

        let (mut along, mut mean) = (Vec::new(), Vec::new());
        for (mut values, sum) in bins {
            if values.is_empty() {
                continue;
            }
            let s = sum / values.len() as f64;
            let offset = median(&mut values);
            let ([rho, z], out) = (dome.curve.position(s), dome.curve.normal(s).map(|c| -c));
            // Distances count from the scanned face: laid onto the meridian they are those of the middle of the sheet.
            mean.push([s, rho + offset * out[0], z + offset * out[1]]);
            along.push([s, 100.0 * offset.abs() / length]);
        }
        let errors = || along.iter().map(|a| a[1]);
        let choice = if self.options.placement == PlacementChoice::AsGiven { "as-given" } else { "fit" };
        let mut placement = PlacementRecord::new(choice, &fit.placement);
        if choice == "fit" {
            placement = placement.uncertain(fit.uncertainty);
        }
        let deviation = Deviation {
            max_error_percent: errors().fold(0.0, f64::max),
            rms_error_percent: (errors().map(|e| e * e).sum::<f64>() / along.len() as f64).sqrt(),
            max_shape_error_percent: None,
            points: Some(statistics),
            placement,
            along,
            cloud,
        };
        Ok((deviation, mean))
    }
}

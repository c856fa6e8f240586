//! B-spline surfaces as a file states them, and as the Bézier surfaces that are traced.
use patchray::bspline::{BSpline, BSplineError};
use patchray::pieces::{Piece, PieceError, PieceMemory, Pieces};
use patchray::point::{Plain, Point, Weighted};
use patchray::surface::Direction;
use serde::Serialize;

use super::model::ModelSurface;
use crate::lower::FromFile;

/// A B-spline surface as its file states it, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Degrees in u and in v.
    pub degrees: [usize; 2],
    /// Knots in u and in v.
    pub knots: [Vec<f64>; 2],
    /// Whether the file gave weights.
    pub rational: bool,
    /// The control points `[x, y, z, w]`, u being the outer index, the weight not multiplied in; it is 1 throughout a
    /// polynomial surface.
    pub points: Vec<[f64; 4]>,
}

/// What became of a B-spline surface of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SplineSummary {
    /// Its number in its file, from 0.
    pub surface: usize,
    /// Whether the file gave weights.
    pub rational: bool,
    /// Degrees in u and in v.
    pub degrees: [usize; 2],
    /// Control points in u and in v.
    pub control_points: [usize; 2],
    /// Knots in u and in v.
    pub knots: [usize; 2],
    /// Spans of positive length in u and in v.
    pub spans: [usize; 2],
    /// The Bézier surfaces that it was cut into.
    pub pieces: usize,
    /// Its parameters in u, and in v, from and to.
    pub domain: [[f64; 2]; 2],
    /// Trimming curves of the file, which are not heeded.
    pub trims_ignored: usize,
}

/// Why a B-spline surface was not cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SplineError {
    /// It is none.
    Invalid(BSplineError),
    /// Its pieces do not fit into memory.
    Memory {
        /// How many control points they have.
        points: usize,
    },
}

impl From<BSplineError> for SplineError {
    fn from(error: BSplineError) -> Self {
        SplineError::Invalid(error)
    }
}

impl Spline {
    /// Cuts it into Bézier surfaces with this number.
    ///
    /// That is done in 64 bits, whatever they are traced in, so that each control point is rounded to the precision of
    /// tracing once.
    ///
    /// # Errors
    /// Its knots or points are not those of a surface, or there are too many pieces.
    pub fn cut(&self, number: usize) -> Result<(Vec<ModelSurface>, SplineSummary), SplineError> {
        if self.rational { self.cut_as::<Weighted<f64>>(number) } else { self.cut_as::<Plain<f64>>(number) }
    }

    fn cut_as<P: FromFile + Point<Scalar = f64>>(
        &self,
        number: usize,
    ) -> Result<(Vec<ModelSurface>, SplineSummary), SplineError> {
        let [degree_u, degree_v] = self.degrees;
        let [u, v] = &self.knots;
        let points: Vec<P> = self.points.iter().map(|&point| P::from_file(point)).collect();
        let spline = BSpline::new(degree_u, degree_v, u, v, &points)?;
        let both = [Direction::U, Direction::V];
        let nothing = PieceMemory { points: &mut [], pieces: &mut [] };
        let needs = match Pieces::build(&[spline], nothing) {
            Err(PieceError::Memory(needs)) => needs,
            // A domain that is not empty makes a piece.
            _ => return Err(SplineError::Memory { points: usize::MAX }),
        };
        let full = SplineError::Memory { points: needs.points.needed };
        let mut surfaces = Vec::new();
        let (mut slots, mut pieces) = (Vec::new(), Vec::new());
        let reserved = surfaces
            .try_reserve_exact(needs.pieces.needed)
            .and_then(|()| slots.try_reserve_exact(needs.points.needed))
            .and_then(|()| pieces.try_reserve_exact(needs.pieces.needed));
        reserved.map_err(|_| full.clone())?;
        slots.resize(needs.points.needed, P::EMPTY);
        pieces.resize(needs.pieces.needed, Piece::EMPTY);
        let memory = PieceMemory { points: &mut slots, pieces: &mut pieces };
        let pieces = Pieces::build(&[spline], memory).map_err(|_| full)?;
        surfaces.extend(pieces.nets().zip(pieces.all()).map(|(net, piece)| {
            let point = |point: &P| {
                let [x, y, z] = point.position();
                [x, y, z, point.weight()]
            };
            ModelSurface {
                number,
                degree_u,
                degree_v,
                rational: self.rational,
                points: net.points().iter().map(point).collect(),
                knots: Some(piece.part()),
            }
        }));
        let summary = SplineSummary {
            surface: number,
            rational: self.rational,
            degrees: self.degrees,
            control_points: both.map(|direction| spline.size(direction)),
            knots: both.map(|direction| spline.knots(direction).len()),
            spans: both.map(|direction| spline.spans(direction)),
            pieces: surfaces.len(),
            domain: both.map(|direction| spline.domain(direction)),
            trims_ignored: 0,
        };
        Ok((surfaces, summary))
    }
}

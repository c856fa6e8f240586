//! The display transform: tristimulus values under equal-energy light to linear sRGB.
//!
//! What is white in the scene is white on the display: the white of the matching functions is that of equal-energy light, the
//! display's is D65, and between them the cone responses are scaled (von Kries) as in Bradford's transform, linear part. That
//! is what the ICC's profiles adapt by; a scaling of X, Y and Z themselves would shift hues more. A matrix of published
//! digits would leave white off by 1e-4, so the display's is made from its primaries.
//!
//! Sources: IEC 61966-2-1 (sRGB's primaries and white); K. M. Lam, "Metamerism and colour constancy", thesis, University of
//! Bradford, 1985, and ICC.1:2010, annex E (the cone responses).

/// A matrix, row by row.
pub type Matrix = [[f64; 3]; 3];

/// sRGB's primaries and its white, D65: x and y of each.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const WHITE: [f64; 2] = [0.3127, 0.3290];

/// Bradford's cone responses of X, Y and Z.
const CONES: Matrix = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// X, Y and Z, all 1 for equal-energy light on white, to linear sRGB, all 1 then too.
pub fn matrix() -> Matrix {
    let white = tristimulus(WHITE);
    // The primaries as columns, of the strengths that make up the white.
    let columns = transposed(PRIMARIES.map(tristimulus));
    let strengths = times(&inverse(&columns), white);
    let to_display = inverse(&columns.map(|row| [0, 1, 2].map(|k| row[k] * strengths[k])));
    let (from, to) = (times(&CONES, [1.0; 3]), times(&CONES, white));
    let scaled = [0, 1, 2].map(|k| CONES[k].map(|cone| cone * to[k] / from[k]));
    product(&to_display, &product(&inverse(&CONES), &scaled))
}

/// X, Y and Z of a chromaticity, at Y = 1.
fn tristimulus([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// A matrix on a column.
pub fn times(matrix: &Matrix, column: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * column[0] + row[1] * column[1] + row[2] * column[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| [0, 1, 2].map(|k| row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k]))
}

fn transposed(a: Matrix) -> Matrix {
    [0, 1, 2].map(|k| a.map(|row| row[k]))
}

/// The inverse, by Cramer's rule, of a matrix that has one.
fn inverse(&[a, b, c]: &Matrix) -> Matrix {
    let cross =
        |p: [f64; 3], q: [f64; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let determinant = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
    transposed([bc, ca, ab]).map(|row| row.map(|part| part / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white() {
        let white = times(&matrix(), [1.0; 3]);
        assert!(white.iter().all(|part| (part - 1.0).abs() < 1e-14), "{white:?}");
    }

    /// Of the display's own white there is nothing to adapt: without that part the matrix is the standard's, to its digits.
    #[test]
    fn without_the_adaptation_it_is_the_standards_matrix() {
        let white = tristimulus(WHITE);
        let (from, to) = (times(&CONES, [1.0; 3]), times(&CONES, white));
        let back = [0, 1, 2].map(|k| CONES[k].map(|cone| cone * from[k] / to[k]));
        let plain = product(&matrix(), &product(&inverse(&CONES), &back));
        let published = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for (row, expected) in plain.iter().flatten().zip(published.iter().flatten()) {
            assert!((row - expected).abs() < 5e-4, "{plain:?}");
        }
    }
}

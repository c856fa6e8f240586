//! How much light a conductor mirrors: Fresnel's equations with a complex index of refraction.
//!
//! Source: M. Born and E. Wolf, Principles of Optics, 7th edition, section 14.2 (reflection from a metal's surface).

/// The complex index of refraction n + i k of a conductor at one wavelength, against vacuum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// The refractive index.
    pub n: f64,
    /// The extinction coefficient.
    pub k: f64,
}

impl Index {
    /// The share of unpolarised light that is mirrored, 0 to 1, `cosine` being that of the angle between the ray and the
    /// normal; a cosine outside 0 to 1 is taken for the nearer end.
    pub fn reflectance(self, cosine: f64) -> f64 {
        let Index { n, k } = self;
        let c = cosine.clamp(0.0, 1.0);
        let sine_sq = 1.0 - c * c;
        // a + i b is the root of (n + i k)² - sin²; `sum` is a² + b².
        let part = n * n - k * k - sine_sq;
        let sum = part.hypot(2.0 * n * k);
        let a = (0.5 * (sum + part)).max(0.0).sqrt();
        let share = |left: f64, middle: f64| (left - middle) / (left + middle);
        let across = share(sum + c * c, 2.0 * a * c);
        let along = across * share(c * c * sum + sine_sq * sine_sq, 2.0 * a * c * sine_sq);
        0.5 * (across + along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_normal_incidence_it_is_the_textbooks() {
        for (n, k) in [(0.29, 2.863), (1.5, 0.0), (0.05, 3.3), (1.37, 7.4)] {
            let expected = ((n - 1.0f64).powi(2) + k * k) / ((n + 1.0f64).powi(2) + k * k);
            assert!((Index { n, k }.reflectance(1.0) - expected).abs() < 1e-14);
        }
    }

    /// The mean of the two polarisations by their complex amplitudes, (c - w) / (c + w) and (m² c - w) / (m² c + w) with
    /// w² = m² - sin², at every degree.
    #[test]
    fn at_an_angle_it_is_the_square_of_the_complex_amplitudes() {
        let times = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
        let norm_sq = |(a, b): (f64, f64)| a * a + b * b;
        for (n, k) in [(0.29, 2.863), (1.31, 1.849), (0.05, 3.3), (1.37, 7.4), (1.5, 1e-9)] {
            for degree in 0..90 {
                let c = f64::from(degree).to_radians().cos();
                let square = times((n, k), (n, k));
                let w_sq = (square.0 - (1.0 - c * c), square.1);
                let (length, angle) = (norm_sq(w_sq).sqrt().sqrt(), 0.5 * w_sq.1.atan2(w_sq.0));
                let w = (length * angle.cos(), length * angle.sin());
                let ratio = |(a, b): (f64, f64)| norm_sq((a - w.0, b - w.1)) / norm_sq((a + w.0, b + w.1));
                let expected = 0.5 * (ratio((c, 0.0)) + ratio((square.0 * c, square.1 * c)));
                let found = Index { n, k }.reflectance(c);
                assert!((found - expected).abs() < 1e-12, "{n} {k} {degree}: {found} {expected}");
            }
        }
    }

    #[test]
    fn all_light_comes_back_at_the_edge_and_from_a_perfect_conductor() {
        assert_eq!(Index { n: 0.29, k: 2.863 }.reflectance(0.0), 1.0);
        assert_eq!(Index { n: 0.29, k: 2.863 }.reflectance(-0.5), 1.0);
        for cosine in [1.0, 0.6, 0.1, 0.0] {
            assert_eq!(Index { n: 0.0, k: 3.0 }.reflectance(cosine), 1.0);
        }
    }
}

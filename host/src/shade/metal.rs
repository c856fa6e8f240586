//! Metals: their complex indices of refraction as published, over the visible range.
//!
//! Sources: P. B. Johnson and R. W. Christy, "Optical constants of the noble metals", Physical Review B 6 (1972), 4370-4379,
//! table I, for gold, silver and copper, whose photon energies are given here as wavelengths; A. D. Rakić, "Algorithm for the
//! determination of intrinsic optical constants of metal films: application to aluminum", Applied Optics 34 (1995),
//! 4755-4767, for aluminium, as the model of Rakić, Djurišić, Elazar and Majewski, Applied Optics 37 (1998),
//! 5271-5283, was fitted to.

use super::fresnel::Index;
use crate::scene::appearance::Metal;

/// The index of a metal at a wavelength in nanometres, on straight lines between the entries of its table; beyond its ends
/// that of the end.
pub fn index(metal: Metal, nanometres: f64) -> Index {
    let table = match metal {
        Metal::Aluminium => ALUMINIUM,
        Metal::Copper => COPPER,
        Metal::Gold => GOLD,
        Metal::Silver => SILVER,
    };
    let above = table.partition_point(|row| row[0] <= nanometres).clamp(1, table.len() - 1);
    let ([low, n_low, k_low], [high, n_high, k_high]) = (table[above - 1], table[above]);
    let share = ((nanometres - low) / (high - low)).clamp(0.0, 1.0);
    Index { n: n_low + share * (n_high - n_low), k: k_low + share * (k_high - k_low) }
}

// Rows of a table: the wavelength in nanometres, n and k.

/// The table of gold.
#[rustfmt::skip]
const GOLD: &[[f64; 3]] = &[
    [367.9, 1.48, 1.895],
    [381.5, 1.46, 1.933],
    [397.4, 1.47, 1.952],
    [413.3, 1.46, 1.958],
    [430.5, 1.45, 1.948],
    [450.9, 1.38, 1.914],
    [471.4, 1.31, 1.849],
    [495.9, 1.04, 1.833],
    [520.9, 0.62, 2.081],
    [548.6, 0.43, 2.455],
    [582.1, 0.29, 2.863],
    [616.8, 0.21, 3.272],
    [659.5, 0.14, 3.697],
    [704.5, 0.13, 4.103],
    [756.0, 0.14, 4.542],
    [821.1, 0.16, 5.083],
];

/// The table of copper.
#[rustfmt::skip]
const COPPER: &[[f64; 3]] = &[
    [367.9, 1.36, 1.975],
    [381.5, 1.33, 2.045],
    [397.4, 1.32, 2.116],
    [413.3, 1.28, 2.207],
    [430.5, 1.25, 2.305],
    [450.9, 1.24, 2.397],
    [471.4, 1.25, 2.483],
    [495.9, 1.22, 2.564],
    [520.9, 1.18, 2.608],
    [548.6, 1.02, 2.577],
    [582.1, 0.70, 2.704],
    [616.8, 0.30, 3.205],
    [659.5, 0.22, 3.747],
    [704.5, 0.21, 4.205],
    [756.0, 0.24, 4.665],
    [821.1, 0.26, 5.180],
];

/// The table of silver.
#[rustfmt::skip]
const SILVER: &[[f64; 3]] = &[
    [367.9, 0.07, 1.657],
    [381.5, 0.05, 1.864],
    [397.4, 0.05, 2.070],
    [413.3, 0.05, 2.275],
    [430.5, 0.04, 2.462],
    [450.9, 0.04, 2.657],
    [471.4, 0.05, 2.869],
    [495.9, 0.05, 3.093],
    [520.9, 0.05, 3.324],
    [548.6, 0.06, 3.586],
    [582.1, 0.05, 3.858],
    [616.8, 0.06, 4.152],
    [659.5, 0.05, 4.483],
    [704.5, 0.04, 4.838],
    [756.0, 0.03, 5.242],
    [821.1, 0.04, 5.727],
];

/// The table of aluminium.
#[rustfmt::skip]
const ALUMINIUM: &[[f64; 3]] = &[
    [364.66, 0.39877, 4.3957],
    [413.28, 0.52135, 5.0008],
    [442.80, 0.60790, 5.3676],
    [476.87, 0.72780, 5.7781],
    [516.60, 0.87340, 6.2418],
    [563.57, 1.0728, 6.7839],
    [619.93, 1.3660, 7.4052],
    [652.25, 1.5724, 7.7354],
    [688.81, 1.8301, 8.0601],
    [729.32, 2.1606, 8.3565],
    [774.91, 2.6154, 8.4914],
    [794.78, 2.7675, 8.3866],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_what_lies_between_and_beyond() {
        assert_eq!(index(Metal::Gold, 582.1), Index { n: 0.29, k: 2.863 });
        let between = index(Metal::Gold, 599.45);
        assert!((between.n - 0.25).abs() < 1e-12 && (between.k - 3.0675).abs() < 1e-12, "{between:?}");
        assert_eq!(index(Metal::Silver, 200.0), Index { n: 0.07, k: 1.657 });
        assert_eq!(index(Metal::Aluminium, 2000.0), Index { n: 2.7675, k: 8.3866 });
    }

    #[test]
    fn tables_span_the_visible_range_in_order() {
        for table in [ALUMINIUM, COPPER, GOLD, SILVER] {
            assert!(table.is_sorted_by(|a, b| a[0] < b[0]));
            assert!(table[0][0] <= 380.0 && table[table.len() - 1][0] >= 780.0);
        }
    }

    /// No metal gives back more than it gets; past the angle at which it gives back least, all of it by and by.
    #[test]
    fn reflectances_stay_within_0_and_1_and_rise_to_1() {
        for metal in Metal::ALL {
            for nanometres in (380..=780).step_by(10) {
                let index = index(metal, f64::from(nanometres));
                let at = |tenth: u32| index.reflectance((f64::from(tenth) / 10.0).to_radians().cos());
                let shares: Vec<f64> = (0..=900).map(at).collect();
                assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)), "{metal:?} {nanometres}");
                let least = (0..=900).min_by(|&a, &b| shares[a].total_cmp(&shares[b])).unwrap_or(900);
                assert!(shares[least..].is_sorted_by(|a, b| a < b), "{metal:?} {nanometres}");
                assert!(shares[900] > 0.999_999, "{metal:?} {nanometres}");
            }
        }
    }
}

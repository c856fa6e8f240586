//! What is a surface and what is not.

use super::*;
use crate::point::Weighted;

#[test]
fn what_is_no_surface_is_refused_by_name() {
    let points = [Weighted::new([0.0; 3], 1.0_f64); 6];
    assert_eq!(Net::new(0, 5, &points).err(), Some(NetError::DegreeU(0)));
    assert_eq!(Net::new(16, 2, &points).err(), Some(NetError::DegreeU(16)));
    assert_eq!(Net::new(2, 16, &points).err(), Some(NetError::DegreeV(16)));
    assert_eq!(Net::new(1, 1, &points).err(), Some(NetError::Points(Need { needed: 4, given: 6 })));
    assert_eq!(Net::new(3, 1, &points).err(), Some(NetError::Points(Need { needed: 8, given: 6 })));
    assert!(Net::checked(1, 2, &points).is_ok());
    for bad in [f64::NAN, f64::INFINITY] {
        let mut bad_points = points;
        bad_points[4] = Weighted::new([0.0, bad, 0.0], 1.0);
        assert_eq!(Net::checked(1, 2, &bad_points).err(), Some(NetError::NotFinite(4)));
        bad_points[4] = Weighted::new([0.0; 3], bad);
        assert_eq!(Net::checked(1, 2, &bad_points).err(), Some(NetError::NotFinite(4)));
    }
    for weight in [0.0, -0.0, -1.0] {
        let mut bad_points = points;
        bad_points[3] = Weighted::new([1.0; 3], weight);
        assert_eq!(Net::checked(1, 2, &bad_points).err(), Some(NetError::Weight(3)));
    }
}

//! Vectors of three numbers.

pub(crate) fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The largest |coordinate| of these points, 0 of none.
pub(crate) fn largest(points: impl IntoIterator<Item = [f64; 3]>) -> f64 {
    points.into_iter().flatten().fold(0.0, |most, c| most.max(c.abs()))
}

/// The vector over its length; zero for a zero vector.
pub(crate) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = length(vector);
    if length > 0.0 { vector.map(|c| c / length) } else { [0.0; 3] }
}

//! The oracle against closed forms: planes, bilinear surfaces, spheres, cylinders, tori and a paraboloid.
//!
//! The equations are solved here without any Bézier surface. An answer counts where the oracle's margin says that it can
//! be judged; each test also says how many answers must be of that kind.

//! Both numbers that the oracle can work in go through the same tests; the closed forms are solved in f64.

/// Makes tests of functions `test<R: Real>(fewer)`, with either number; `fewer` divides the number of rays.
macro_rules! in_either {
    ($($test:ident)*) => {
        mod in_f64 {
            $(#[test] fn $test() { super::$test::<f64>(1) })*
        }
        mod in_double_double {
            $(#[test] fn $test() { super::$test::<patchray_host::oracle::DoubleDouble>(4) })*
        }
    };
}

mod cases;
mod closed_forms;
mod extremes;
mod steep;
mod truth;

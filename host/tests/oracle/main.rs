//! The oracle against closed forms: planes, bilinear surfaces, spheres, cylinders, tori and a paraboloid.
//!
//! The equations are solved here without any Bézier surface. An answer counts where the oracle's margin says that it can
//! be judged; each test also says how many answers must be of that kind.

mod cases;
mod closed_forms;
mod truth;

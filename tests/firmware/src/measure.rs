//! Traces a picture's scan lines by a method, and tells what came out and what it took.

use patchray::limits::{Limits, Work};
use patchray::point::Point;

use crate::hash::Hash;
use crate::machine::Machine;
use crate::picture::Picture;
use crate::tracer::Tracer;

/// How many characters a row of the picture has.
const ROW: usize = 64;

/// Traces the lines of `picture` by a method, and says so on the machine's console: a line `method NAME`, a row of the
/// picture for each scan line, and then lines of a name and a number. `patches` is said as it is.
pub fn measure<P: Point, T: Tracer<P>>(
    machine: &mut Machine,
    name: &str,
    picture: &Picture,
    patches: usize,
    tracer: Option<T>,
) {
    machine.say("method ");
    machine.say(name);
    machine.say("\n");
    let Some(mut tracer) = tracer else {
        return machine.fail("no view, or its memory is too small\n");
    };
    let limits = Limits::<P::Scalar>::default();
    let bound = limits.worst_case(&tracer.extent()).counts();
    let (mut hash, mut worst) = (Hash::NOTHING, [0; Work::COUNT]);
    let (mut least, mut most, mut sum, mut hits_sum, mut lines) = (u64::MAX, 0, 0, 0, 0);
    let (mut rays, mut hits, mut gave_up) = (0, 0, 0);
    for number in picture.lines() {
        let begin = machine.instructions();
        let line = T::line(&mut tracer, picture, number);
        lines += machine.since(begin);
        let Some(mut line) = line else {
            return machine.fail("a scan line needs more memory\n");
        };
        let y = picture.y(number);
        let mut row = [b'.'; ROW];
        for column in 0..picture.size[0] {
            let (at, mut work) = ([picture.x(column), y], Work::default());
            let begin = machine.instructions();
            let answer = T::ray(&mut line, at, &limits, &mut work);
            let took = machine.since(begin);
            (least, most, sum) = (took.min(least), took.max(most), sum + took);
            rays += 1;
            match answer {
                Ok(Some(_)) => {
                    hits += 1;
                    hits_sum += took;
                    let place = column as usize * ROW / picture.size[0].max(1) as usize;
                    row.get_mut(place).into_iter().for_each(|mark| *mark = b'#');
                }
                Ok(None) => {}
                Err(_) => gave_up += 1,
            }
            hash.add_answer(&answer);
            hash.add_work(&work);
            for (worst, count) in worst.iter_mut().zip(work.counts()) {
                *worst = count.max(*worst);
            }
        }
        machine.say("row ");
        machine.say(core::str::from_utf8(&row).unwrap_or(""));
        machine.say("\n");
    }
    machine.tell("patches", patches as u64);
    machine.tell("rays", rays);
    machine.tell("hits", hits);
    machine.tell("gave_up", gave_up);
    machine.tell("hash", hash.0);
    machine.tell("least", least);
    machine.tell("sum", sum + lines);
    machine.tell("hits_sum", hits_sum);
    machine.tell("lines", lines);
    #[cfg(feature = "planted")]
    planted(rays);
    machine.tell("worst", most);
    for (name, worst) in Work::NAMES.iter().zip(worst) {
        machine.tell(name, u64::from(worst));
    }
    if worst.iter().zip(bound).any(|(worst, bound)| *worst > bound) {
        machine.fail("more work than Limits::worst_case says\n");
    }
}

/// An index out of bounds, which nobody can foretell.
#[cfg(feature = "planted")]
fn planted(rays: u64) {
    let few = [0_u8; 3];
    core::hint::black_box(few[core::hint::black_box(rays) as usize]);
}

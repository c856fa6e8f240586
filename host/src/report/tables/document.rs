//! The experiment as a document: question, method, scenes, results, and why they differ from the paper's.

use super::{Report, SceneReport, Style, Table, gain, intersection_points, percent};
use crate::experiment::Run;
use crate::experiment::subject::{Family, PRUNING};

const QUESTION: &str = "\
# The experiment of Wang, Shih and Chang (2000), repeated

This is an independent implementation, with extensions, of S.-W. Wang, Z.-C. Shih, R.-C. Chang, *An improved rendering technique for \
ray tracing Bézier and B-spline surfaces*, The Journal of Visualization and Computer Animation 11, 2000. `patchray tables --markdown` \
writes this document.

## Question

A ray next to another along a scan line meets a surface near the other's point. The paper begins there, and sends a testing ray back \
to the eye to verify that the point found is the closest. It reports that this saves 16 to 40 % of the time of Barth and Stürzlinger's \
numerical method, and 6 to 28 % of that of Bézier clipping. Does it, by the paper's own methods on scenes like the paper's? What is \
each part worth? And would it still be so on the paper's machine where it is not on today's?

## Method

The paper's methods are traced to the letter (`--by-the-letter`): rays one by one along scan lines; a uniform grid over the min-max \
boxes of surfaces; for the numerical original a binary tree of patches per surface, for the improved one a regular grid; the original \
clipping of whole surfaces without patches, the improved one around the prior region, verified through the grid. Every surface that \
the ray meets is searched, and the closest point is selected afterwards. A second implementation, written from the text with lists \
that are kept and nothing left out, finds the same points, the same lists and the same verdicts on 10,000 rays of each scene, by as many clips to 0.5 % (`tests/letter`); it shares subdivision, projection, boxes, starts and one solve by Newton's method, and reads what is open alike.

Most departures are switches, off by the letter and on for users (`--without PART` switches one off). On those rays \
each switch alone changes no answer and only the counts that it should (the same tests); where weights fall steeply, or rays lie in \
a surface, clipping's end to the letter is too coarse for that. Departures in both the original and the improved method are in the table at the end.
";

const SCENES: &str = "\
## Scenes

The paper's cameras and control points are not published. The scenes are modelled after its figures, with its numbers of surfaces; a \
flatness for each gives its number of patches within 10 %, and the field of view was fitted so that the numerical original, to the \
letter, finds the paper's intersection points of Table 1. One placement serves all tables. That is a confound: what is fitted is no \
result. It fits three scenes within 1 %; of the fourth, `mirrors`, no field of view that its backdrop fills does. Four more cameras by \
one rule, the eye turned by 20° to either side and by 10° up and down, tell how much a gain depends on the placement.
";

const WHY: &str = "\
**Coherence is worth what the paper says where rays meet several sheets of a surface,** as on `toruses` and `mirrors`, in either kind of \
method; on `teapot` and `rings`, where one search finds little more than the one point, less. It saves the search of the whole surface. \
Where that search ends at the closest point by itself, which the paper does not describe, there is less to save: believed without \
verification coherence still gains, and is wrong at times, but in the numerical methods verification takes back all of it (Table 5; \
\"not right\" are pixels that are wrong). The testing ray walks the grid, and tests the parallelepipeds of patches, for each point.

In instructions, which no other work on the machine disturbs, the parts are worth as much (128 × 128 rays, counted once by callgrind):

| Saved instructions, % | numerical | clipping |
| --- | --- | --- |
| improved method over original, to the letter | -11, 27, -45, 5 | -2, 20, -3, 18 |
| of these the grid in place of what the original has | -18, 5, -47, -11 | -4, -1, -4, -1 |
| and coherence, over the same with nothing kept | 6, 24, 2, 14 | 2, 21, 0, 19 |
| original: + pruning | 32, 2, 30, 43 | 35, 1, 29, 50 |
| + grid, early end | -7, 34, -31, 10 | -5, -1, -4, -1 |
| + coherence, believed | 12, 16, 6, 11 | 6, 31, 4, 21 |
| + verification | -15, -24, -10, -17 | -3, -14, -4, -5 |

**The numerical method loses elsewhere what coherence gains: its grid takes longer than the tree that it replaces.** A tree says that \
a ray misses a surface in a few tests of parallelepipeds that fit, where a grid is walked from end to end of what it holds. Where \
many surfaces are missed, as on `rings`, the grid costs more than coherence can save. The paper has no such row: it compares the \
original with a tree and the improved method with a grid, and gains on all scenes. Tried: from 0.1 to 30 voxels per patch \
no gain is more than 2 % above that of 3 (coarse grids test more patches, fine ones walk through more voxels); and a test of the \
whole surface's parallelepiped before its grid, which the paper does not describe, spares 57 % of the full searches on `rings`, 35 % of the \
voxels and 7 % of the tests of patches, and makes its gain -50 % instead of -65 %, but changes none elsewhere by more than 1 % (counted \
once, by a build with that test). The surface's min-max \
box is tested first in any case, and the grid is entered where the box of its patches is.

**The counts do not depend on the machine, and they do not allow the paper's gains on two scenes.** Table 8 takes time for a sum of \
Newton steps, or clips, and of tests, and asks at which ratio of their costs the paper's gain would follow. The improved numerical \
method takes more Newton steps than the original on `teapot` and `rings`: a remembered start takes some 3.8 to 4.1 steps, \
the parallelogram of a patch some 3 (Table 5). Ended at a tolerance of 1e-6 both take fewer, and gain 2 % more at most (Table 7). So no ratio gives 20 % there, on a Pentium II or elsewhere, unless the paper's original \
wasted steps that this one does not. On `toruses` and `mirrors`, where rays meet many sheets, the paper's gains are within reach; on `mirrors` only since Newton's method is \
taken to the last digits, which the paper does not ask for.

**Points reproduce in three scenes of four.** With the original's fitted, the improved numerical method finds the paper's number to a few \
percent on `teapot` and `toruses`, and a fifth more on `rings`. Clipping finds each root once: ended at an interval of 9e-10 it has no \
duplicates, and no other reading of its text gives it more than 1 % more points (Table 7). Near tangents, which the paper names as the \
cause of its many, a coarser end adds few: at 1e-3 0.1 %, at 1e-2 2 % (counted once, by a build with another constant). What does give \
ratios of about the paper's size is pruning in the numerical methods alone, the last row above. And `mirrors`, of which no \
placement has few enough points to the letter, then has the paper's within 1 % (Table 7, four times as many at 512 × 512). So the \
paper's numerical methods may have left out what lies behind the closest hit, which it does not say, and its clipping not. Against it \
is that with pruning `teapot` and `rings` have little more than half of the points that their cameras were fitted to.

**Clipping depends on which parameter is called u,** since it begins with u, and the paper's nets are not published: exchanged, the gains \
are those of the last rows of Table 7, by which `toruses` and `mirrors` change places.

**Ours is not the paper's.** Pruning by the closest hit so far is worth more than coherence, on three scenes of four, in original and \
improved methods alike (Table 7). The predicted methods (Tables 5 and 6, last rows) keep the paper's idea, a start from the ray before \
and a testing ray, and gain by what the paper does not have: they know beforehand which patches the rays of a scan line can meet.
";

const DEPARTURES: [[&str; 3]; 21] = [
    [
        "Points on each surface that the ray meets, the closest selected afterwards",
        "Surfaces and patches behind the closest hit so far are left out",
        "`pruning`, Table 7",
    ],
    [
        "The closest point of a whole surface is \"found and marked\"",
        "The improved full search ends at it",
        "`early-end`, Table 7",
    ],
    [
        "The testing ray's list is obtained, then looked at",
        "Yes or no as soon as it is known",
        "`quick-verdict`, Table 7",
    ],
    [
        "Clipping ends when the interval is small",
        "It ends by Newton's method once that is proved to lead to the only root; to the letter at 9e-10, which is a choice: \
         at 1e-6 it would take 6 to 8 % fewer clips, at 1e-4 12 to 17 %",
        "`newton-end`, Table 7",
    ],
    [
        "The interval that a clip fails to reduce is split into halves",
        "The other one, where it is much longer in space",
        "`long-side`, Table 7",
    ],
    [
        "The interval that a clip fails to reduce is split into halves",
        "They are looked at across the ray first",
        "`look-across`, Table 7",
    ],
    [
        "Clipping \"modified according to Campagna et al.\"",
        "That article was not at hand. What stands instead are the spread lines of Efremov, Havran and Seidel (2005), for chords within 6° of each other",
        "`spread-lines`, Table 7",
    ],
    [
        "Points found again count again",
        "A root found from two regions is known again, and kept once; counted it is each time",
        "`known-roots`, Table 7",
    ],
    [
        "Surfaces are clipped that pass a min-max box",
        "Left out are those all of whose projected control points lie to one side, which the first clips would find out",
        "`box-first`, Table 7",
    ],
    [
        "The interval is split into halves if a clip fails to reduce it by 20 %",
        "The halves are of the interval as it was. Kept, what such clips remove would spare 0 to 3 % of the clips, of `mirrors` 7 %",
        "none on points",
    ],
    ["Clipping begins with u", "Which parameter is u is the model's choice", "u and v exchanged, Table 7"],
    [
        "Threshold \"20 % of the interval width\"",
        "Read as what a clip has to remove, as by Nishita et al.; the other reading, that 20 % must remain, is a row",
        "`--clip-threshold`, Table 7",
    ],
    [
        "Eq. (1), tan α > b/h, by a figure that is not in the text",
        "α from v3, h the thickness, b the chord along the ray, factor 1",
        "`--critical-factor`, Table 7",
    ],
    [
        "Halving is \"based on the curvature\"",
        "The larger bound of second derivatives; the other reading, what turns more, is a row",
        "`bend-halving`, Table 7",
    ],
    [
        "Newton's method",
        "Halved steps where it does not lead closer, an end by Taylor's theorem at 2e-15 of the surface's size",
        "not switched: the same in all numerical methods; tolerance 1e-6, Table 7",
    ],
    [
        "The testing ray's entrance into the parallelepiped is a start",
        "The viewing ray's, since the testing ray begins inside the owner's; of other listed patches it comes first, too",
        "5 to 8 % of the starts",
    ],
    [
        "A parallelogram, and its normal",
        "Where its sides are all but parallel one is replaced; parallelepipeds are padded by rounding",
        "no point",
    ],
    [
        "Patches in their voxels",
        "All voxels of the parallelepiped's box, three voxels per patch; a walk ends where nothing lies ahead in its octant",
        "times of improved methods: the latter spares an eighth of the voxels of a teapot",
    ],
    [
        "Four rays per pixel",
        "Two scan lines per row of pixels; 256 × 256 pixels, where the paper's times are of 512 × 512",
        "times of Table 3",
    ],
    ["Two orthogonal planes through the ray", "Two planes along axes", "all methods alike"],
    ["B-splines projected", "Cut into Bézier surfaces by knot insertion", "no scene has one"],
];

const PAPER_ITSELF: &str = "\
## What the paper says otherwise of itself

- Its abstract promises 16 to 40 % for both kinds of methods; its Table 2 has 6 to 28 %.
- Points of clipping are said to differ from Newton's \"particularly\" in Figs. 9 and 10; by Table 2 they do in Figs. 8, 10 and 11, \
and in Fig. 9 by 0.3 %.
- Table 3, Fig. 8: 33.9 to 34.7 s are 2.4 %, printed as 1 %.

## Threats to validity

- Scenes, cameras and flatness are ours, fitted as said above.
- Barth and Stürzlinger's and Campagna's articles were not at hand in full; Fig. 2, which defines eq. (1), is not in the text.
- Times are processor times on a shared machine. A gain is of runs in turn, part of a picture by part; its spread says what is noise. \
Over five runs of the whole the gains of Tables 1 and 2 were within 4 points of each other, most within 2. Counts have no spread.
- A gain in time belongs to a machine. On another virtual machine whose processor has the same name, 1.5 times slower, the same program \
gave -15, 30, -53 and 15 % for the numerical methods, and -1, 18, -9 and 20 % for clipping. Instructions belong to none.
- A machine of today pays little for arithmetic beside memory; see Table 8.
- Newton's steps, projections and clips are the same code in original and improved methods, and are tuned; the 2000 ones may have \
been less so.

## How to repeat it

```sh
cargo run --release -- tables --markdown -o experiment.md
```

writes this document with the figures of the machine at hand; `--json` has all of them, `--size` and `--repetitions` ask for more. \
`render FILE.toml --method newton-coherent --by-the-letter --acceptance paper` draws a scene in the paper's way. Instructions are those of

```sh
valgrind --tool=callgrind --toggle-collect='<patchray_host::scanline::MethodLane*' \\
  target/release/patchray query FILE.toml RAYS.csv -o ANSWERS.csv --threads 1 --acceptance paper --method METHOD --by-the-letter
```
";

impl Report {
    /// The whole document, in Markdown.
    pub(super) fn document(&self) -> String {
        let [numerical, clipping] = Family::ALL;
        let table = |table: Table| table.to_text(Style::Markdown) + "\n";
        let mut text = format!("{QUESTION}\n{SCENES}\n## Results\n\n");
        for results in
            [self.improvements(1, numerical), self.improvements(2, clipping), self.samplings(), self.incoherent()]
        {
            text += &table(results);
        }
        text += &format!("{}\n\n## What each part is worth\n\n", self.notes().join("\n\n"));
        for parts in [self.ladders(5, numerical), self.ladders(6, clipping), self.changes(), self.costs()] {
            text += &table(parts);
        }
        let why = self.why();
        text + &format!(
            "## Why the figures differ\n\n{why}\n## Departures and choices\n\n{}\n{PAPER_ITSELF}",
            departures()
        )
    }

    /// What the gains are made of, with those of this run.
    fn why(&self) -> String {
        let [numerical, clipping] = Family::ALL;
        let paper = |family| self.each(|scene| scene.improvement(family).gain);
        let all = |family| self.each(|scene| gain(&scene.family(family).letter));
        // Of runs that are the original, the improved method, and that with nothing kept.
        let of = |family, from: usize, to: usize| {
            self.each(|scene| match (scene.family(family).letter.get(from), scene.family(family).letter.get(to)) {
                (Some(from), Some(to)) => to.gain_over(from),
                _ => f64::NAN,
            })
        };
        let points = |run: Option<&Run>| run.map_or(f64::NAN, |run| intersection_points(run) as f64);
        let ratios = |of: &dyn Fn(&SceneReport) -> f64| {
            self.scenes.iter().map(|scene| format!("{:.2}", of(scene))).collect::<Vec<_>>().join(", ")
        };
        // Of one size of pictures.
        let pruned = |scene: &SceneReport| {
            let change = scene.numerical.changes.iter().find(|change| change.name == PRUNING);
            points(change.and_then(|change| change.after.first()))
        };
        let clipped =
            |scene: &SceneReport| points(scene.clipping.changes.first().and_then(|change| change.before.first()));
        format!(
            "Gains in %, of {}, in this order:\n\n\
             | | numerical | clipping |\n| --- | --- | --- |\n\
             | the paper | {} | {} |\n\
             | to the letter | {} | {} |\n\
             | of these the grid in place of what the original has | {} | {} |\n\
             | and coherence, over the same with nothing kept | {} | {} |\n\n\
             Points of the original clipping for one of the original numerical method, in the same order:\n\n\
             | | |\n| --- | --- |\n\
             | the paper | {} |\n\
             | to the letter | {} |\n\
             | where the numerical method is pruned by the closest hit so far, and clipping is not | {} |\n\n{WHY}",
            self.scenes.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", "),
            paper(numerical),
            paper(clipping),
            all(numerical),
            all(clipping),
            of(numerical, 0, 2),
            of(clipping, 0, 2),
            of(numerical, 2, 1),
            of(clipping, 2, 1),
            ratios(&|scene| scene.paper.clipping.points[0] as f64 / scene.paper.numerical.points[0] as f64),
            ratios(&|scene| points(scene.clipping.letter.first()) / points(scene.numerical.letter.first())),
            ratios(&|scene| clipped(scene) / pruned(scene)),
        )
    }

    /// Shares of each scene, in percent.
    fn each(&self, share: impl Fn(&SceneReport) -> f64) -> String {
        self.scenes.iter().map(|scene| percent(share(scene))).collect::<Vec<_>>().join(", ")
    }
}

/// What the paper says, what is done, and where its effect stands.
fn departures() -> String {
    let rows = DEPARTURES.iter().map(|[paper, ours, effect]| format!("| {paper} | {ours} | {effect} |\n"));
    "| The paper | We | Effect |\n| --- | --- | --- |\n".to_owned() + &rows.collect::<String>()
}

//! Which parts of the methods the command line switches off.

use clap::ValueEnum;
use patchray::reading::Switches;
use serde::{Serialize, Serializer};

macro_rules! names {
    ($($(#[$doc:meta])* $name:ident = $switch:ident,)*) => {
        /// A part of the methods that can be switched off, by its name in [`Switches`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
        #[serde(rename_all = "kebab-case")]
        pub enum Switch {
            $($(#[$doc])* $name,)*
        }

        impl Switch {
            fn of(self, all: &mut Switches) -> &mut bool {
                match self {
                    $(Switch::$name => &mut all.$switch,)*
                }
            }
        }
    };
}

names! {
    /// The paper's: begin at the point that the ray before found
    Coherence = coherence,
    /// The paper's: verify that point by a testing ray
    Verification = verification,
    /// A departure: leave out what lies behind the closest hit so far, on whatever surface
    Pruning = pruning,
    /// A departure: end the improved numerical method's search of a whole surface at the closest point
    EarlyEnd = early_end,
    /// A departure: say the yes or no of clipping's testing ray as soon as it is known
    QuickVerdict = quick_verdict,
    /// A departure: leave out a surface that lies to one side of the ray before it is clipped
    BoxFirst = box_first,
    /// A departure: let Newton's method stand for the last clips where it is proved to lead to the only root
    NewtonEnd = newton_end,
    /// A departure: look across the ray at a region that a clip does not shorten enough, before it is bisected
    LookAcross = look_across,
    /// A departure: halve the side of a region that is much longer, not the one that a clip did not shorten enough
    LongSide = long_side,
    /// A departure: spread lines along chords that are all but parallel, before clipping by them
    SpreadLines = spread_lines,
    /// A departure: know again a root that clipping finds again
    KnownRoots = known_roots,
    /// A choice: halve a surface where it strays farther from its chord, not where it turns more
    BendHalving = bend_halving,
}

impl Switch {
    /// Its name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// What is switched on. Serialised, it is the names of what is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct On(pub Switches);

impl On {
    /// All.
    pub const ALL: Self = On(Switches::ours());

    /// The paper's text to the letter.
    pub const LETTER: Self = On(Switches::letter());

    /// This without some.
    pub fn without(self, off: &[Switch]) -> Self {
        self.set(off, false)
    }

    /// This with some.
    pub fn with(self, on: &[Switch]) -> Self {
        self.set(on, true)
    }

    fn set(self, some: &[Switch], on: bool) -> Self {
        let On(mut all) = self;
        for switch in some {
            *switch.of(&mut all) = on;
        }
        On(all)
    }

    /// What the kernel is to be asked by; `None` where it is asked as users are served best.
    pub fn reading(self) -> Option<Switches> {
        (self != On::ALL).then_some(self.0)
    }
}

impl Serialize for On {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let On(mut all) = *self;
        serializer.collect_seq(Switch::value_variants().iter().filter(|switch| !*switch.of(&mut all)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_switch_has_one_name_everywhere() {
        let On(switches) = On::ALL.without(Switch::value_variants());
        assert!(!format!("{switches:?}").contains("true"));
        let json = serde_json::to_string(&On::ALL.without(&[Switch::EarlyEnd])).expect("it is a list");
        assert_eq!(json, r#"["early-end"]"#);
        assert_eq!((On::ALL.reading(), On::LETTER.reading()), (None, Some(Switches::letter())));
    }
}

//! What a program is made of: the methods that it traces with, over tables that were baked for them.

/// A program that traces by some methods, each over the tables of a module, in this precision.
#[macro_export]
macro_rules! program {
    ($scalar:ident: $($method:ident over $tables:ident),+) => {
        $crate::start!();

        fn run(machine: &mut $crate::machine::Machine) {
            let picture = $crate::picture::Picture::named(&$crate::machine::chosen(env!("PICTURE")));
            $($crate::$method!(machine, $tables, $scalar, picture);)+
        }
    };
}

/// Measures [`Newton`](crate::tracer::Newton).
#[macro_export]
macro_rules! newton {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {{
        use $crate::patchray::{method::Scratch, point::Plain};
        static ROOM: $crate::lent::Lent<Scratch<Plain<$scalar>, { $tables::ORDER }, { $tables::NET }>> =
            $crate::lent::Lent::new(Scratch::new());
        let tracer = ROOM.lend().map(|room| $crate::tracer::Newton {
            scene: $tables::scene(),
            led: $crate::tracer::By(($tables::patches(), $tables::tree())),
            room: room.view(),
            memory: &mut [],
        });
        $crate::measure::measure($machine, "newton", &$picture, $tables::PATCHES.len(), tracer);
    }};
}

/// Measures [`NewtonCoherent`](crate::tracer::NewtonCoherent).
#[macro_export]
macro_rules! newton_coherent {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {{
        use $crate::patchray::method::{Remembered, Scratch};
        use $crate::patchray::point::Plain;
        type Room =
            (Scratch<Plain<$scalar>, { $tables::ORDER }, { $tables::NET }>, [Remembered<$scalar>; $tables::COUNT]);
        static ROOM: $crate::lent::Lent<Room> =
            $crate::lent::Lent::new((Scratch::new(), [Remembered::EMPTY; $tables::COUNT]));
        let tracer = ROOM.lend().map(|(room, memory)| $crate::tracer::NewtonCoherent {
            scene: $tables::scene(),
            led: $crate::tracer::By(($tables::patches(), $tables::grids())),
            room: room.view(),
            memory,
        });
        $crate::measure::measure($machine, "newton-coherent", &$picture, $tables::PATCHES.len(), tracer);
    }};
}

/// Measures [`Clipping`](crate::tracer::Clipping).
#[macro_export]
macro_rules! clipping {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {{
        use $crate::patchray::{method::ClipScratch, point::Plain};
        type Room = ClipScratch<Plain<$scalar>, { $tables::ORDER }, { $tables::NET }, { $crate::PENDING }>;
        static ROOM: $crate::lent::Lent<Room> = $crate::lent::Lent::new(ClipScratch::new());
        let tracer = ROOM.lend().map(|room| $crate::tracer::Clipping {
            scene: $tables::scene(),
            led: $crate::tracer::By(()),
            room: room.view(),
            memory: &mut [],
        });
        $crate::measure::measure($machine, "clipping", &$picture, 0, tracer);
    }};
}

/// Measures [`ClippingCoherent`](crate::tracer::ClippingCoherent).
#[macro_export]
macro_rules! clipping_coherent {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {{
        use $crate::patchray::method::{ClipScratch, Remembered};
        use $crate::patchray::point::Plain;
        type Room = (
            ClipScratch<Plain<$scalar>, { $tables::ORDER }, { $tables::NET }, { $crate::PENDING }>,
            [Remembered<$scalar>; $tables::COUNT],
        );
        static ROOM: $crate::lent::Lent<Room> =
            $crate::lent::Lent::new((ClipScratch::new(), [Remembered::EMPTY; $tables::COUNT]));
        let tracer = ROOM.lend().map(|(room, memory)| $crate::tracer::ClippingCoherent {
            scene: $tables::scene(),
            led: $crate::tracer::By(($tables::patches(), $tables::grids())),
            room: room.view(),
            memory,
        });
        $crate::measure::measure($machine, "clipping-coherent", &$picture, $tables::PATCHES.len(), tracer);
    }};
}

/// Measures [`NewtonPredicted`](crate::lines::NewtonPredicted).
#[macro_export]
macro_rules! newton_predicted {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {
        $crate::predicted!(
            $machine,
            $tables,
            $scalar,
            $picture,
            "newton-predicted",
            $crate::patchray::method::Scratch<Point, { $tables::ORDER }, { $tables::NET }>
        )
    };
}

/// Measures [`ClippingPredicted`](crate::lines::ClippingPredicted).
#[macro_export]
macro_rules! clipping_predicted {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr) => {
        $crate::predicted!(
            $machine,
            $tables,
            $scalar,
            $picture,
            "clipping-predicted",
            $crate::patchray::method::ClipScratch<Point, { $tables::ORDER }, { $tables::NET }, { $crate::PENDING }>
        )
    };
}

/// Measures a method for the rays of a view.
#[doc(hidden)]
#[macro_export]
macro_rules! predicted {
    ($machine:ident, $tables:ident, $scalar:ident, $picture:expr, $name:literal, $scratch:ty) => {{
        type Point = $crate::patchray::point::Plain<$scalar>;
        type View = $crate::lines::ViewRoom<
            Point,
            { $tables::POINTS.len() },
            { $tables::COUNT },
            { $tables::COUNT + 1 },
            { $tables::PATCHES.len() },
            { $crate::lines::runs($tables::PATCHES.len(), $tables::COUNT) },
        >;
        static ROOM: $crate::lent::Lent<(View, $scratch)> = $crate::lent::Lent::new((View::new(), <$scratch>::new()));
        let tracer = ROOM
            .lend()
            .and_then(|(view, scratch)| view.seen(&$tables::scene(), &$tables::patches(), &$picture, scratch.view()));
        $crate::measure::measure($machine, $name, &$picture, $tables::PATCHES.len(), tracer);
    }};
}

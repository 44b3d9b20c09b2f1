//! Hard pairs of triangles, against an oracle in big integers with another definition.
//!
//! The oracle is compared with `reference`, which decides every sign exactly, and with a moving
//! world, whose filters skip what they can. Thousands of pairs are compared here, and ten million
//! by
//!
//! ```sh
//! cargo test --release -p pliant --test all oracle:: -- --ignored --nocapture
//! ```

use pliant::{BodyId, ContactKind, Scalar, Selection, World, reference};
use pliant_oracle::{self as oracle, Class, Random, Triangle, contact_kind, fits_f32, intersect};
use std::thread;
use std::time::{Duration, Instant};

/// A world of two bodies with one triangle each, moved from pair to pair.
struct Moving<S: Scalar> {
    world: World<S>,
    bodies: [BodyId; 2],
}

impl<S: Scalar> Moving<S> {
    fn new() -> Self {
        let mut world = World::new();
        let start = [[S::default(); 3]; 3];
        let bodies = [(); 2].map(|()| world.add(&[[0, 1, 2]], &start).unwrap());
        Self { world, bodies }
    }

    /// Answers of the world and of the reference for a pair: whether they intersect, and how.
    fn answers(&mut self, pair: [[[S; 3]; 3]; 2]) -> [(bool, oracle::ContactKind); 2] {
        for (&body, triangle) in self.bodies.iter().zip(&pair) {
            self.world.set_positions(body, triangle).unwrap();
        }
        let found = self
            .world
            .intersections(Selection::World)
            .all()
            .unwrap()
            .len();
        let reference =
            reference::intersection_pairs(&[[0, 1, 2]], &pair[0], &[[0, 1, 2]], &pair[1]).unwrap();
        let pairs = self.world.statistics().pairs;
        let how = self.world.contacts(Selection::World).all().unwrap();
        let how = how.first().map(|contact| contact.kind);
        assert_eq!(self.world.statistics().pairs, pairs);
        let should = reference::contacts(&[[0, 1, 2]], &pair[0], &[[0, 1, 2]], &pair[1]).unwrap();
        let should = should.first().map(|&(_, kind)| kind);
        let [how, should] = [how, should].map(|kind| match kind {
            None => oracle::ContactKind::Apart,
            Some(ContactKind::Touching) => oracle::ContactKind::Touching,
            Some(ContactKind::Overlapping) => oracle::ContactKind::Overlapping,
            Some(ContactKind::Crossing) => oracle::ContactKind::Crossing,
        });
        [(found == 1, how), (reference == [[0, 0]], should)]
    }
}

/// Counters of the pairs compared in one class.
#[derive(Clone, Copy, Default)]
struct Tally {
    pairs: u64,
    meeting: u64,
    crossing: u64,
    overlapping: u64,
    as_f32: u64,
    by_exact_arithmetic: u64,
}

/// Compares the next `count` pairs of a class.
fn compare(class: Class, seed: u64, count: u64) -> Tally {
    let (mut singles, mut doubles) = (Moving::<f32>::new(), Moving::<f64>::new());
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for index in 0..count {
        let pair = class.pair(&mut random);
        let expected = intersect(&pair[0], &pair[1]);
        let kind = contact_kind(&pair[0], &pair[1]);
        assert_eq!(kind != oracle::ContactKind::Apart, expected);
        let check = |answers: [(bool, oracle::ContactKind); 2], precision: &str| {
            assert!(
                answers == [(expected, kind); 2],
                "{class:?}, seed {seed}, pair {index}, {precision}: \
                 the oracle says {kind:?}, world and reference say {answers:?}\n{pair:?}\n{}",
                in_bits(&pair),
            );
        };
        check(doubles.answers(pair), "f64");
        tally.by_exact_arithmetic += doubles.world.statistics().exact_decisions;
        if fits_f32(&pair) {
            let narrowed = pair.map(|triangle| triangle.map(|p| p.map(|x| x as f32)));
            check(singles.answers(narrowed), "f32");
            tally.as_f32 += 1;
        }
        tally.pairs += 1;
        tally.meeting += u64::from(expected);
        tally.crossing += u64::from(kind == oracle::ContactKind::Crossing);
        tally.overlapping += u64::from(kind == oracle::ContactKind::Overlapping);
    }
    tally
}

fn in_bits(pair: &[Triangle; 2]) -> String {
    let number = |x: &f64| format!("{:#018x}", x.to_bits());
    let numbers: Vec<_> = pair
        .as_flattened()
        .as_flattened()
        .iter()
        .map(number)
        .collect();
    format!("f64::from_bits of: {}", numbers.join(" "))
}

#[test]
fn thousands_of_pairs() {
    let mut all = Tally::default();
    for class in Class::ALL {
        let tally = compare(class, 1, 600);
        all += tally;
        assert_eq!(tally.pairs, 600);
        assert!(
            (50..580).contains(&tally.meeting),
            "{class:?}: {}",
            tally.meeting
        );
    }
    println!(
        "{} pairs, {} meet, {} cross, {} overlap",
        all.pairs, all.meeting, all.crossing, all.overlapping
    );
    let touching = all.meeting - all.crossing - all.overlapping;
    assert!(
        [touching, all.crossing, all.overlapping]
            .iter()
            .all(|&of| of > 300)
    );
}

/// Pairs that once were decided wrongly, as bits: corner by corner, the first triangle first.
const FOUND: [[u64; 18]; 1] = [
    // The dot product n . t overflows in single precision, and its error bound does not.
    [
        0xc0d7_6000_0000_0000,
        0xc0e6_c000_0000_0000,
        0xc0da_d000_0000_0000,
        0x3c78_0800_0000_0000,
        0x3c64_f000_0000_0000,
        0x3c61_c000_0000_0000,
        0xb959_4000_0000_0000,
        0x395a_b000_0000_0000,
        0x395c_3800_0000_0000,
        0x410b_1000_0000_0000,
        0x40f3_e000_0000_0000,
        0xc0b3_0000_0000_0000,
        0x39eb_e000_0000_0000,
        0x39da_9000_0000_0000,
        0xb9c1_c000_0000_0000,
        0xc5fa_2000_0000_0000,
        0xc5f9_f800_0000_0000,
        0x45d3_e000_0000_0000,
    ],
];

#[test]
fn pairs_that_once_were_wrong() {
    let mut world = Moving::<f64>::new();
    for bits in FOUND {
        let points = bits.map(f64::from_bits);
        let corners = points.as_chunks::<3>().0;
        let pair = [0, 3].map(|first| [corners[first], corners[first + 1], corners[first + 2]]);
        let expected = intersect(&pair[0], &pair[1]);
        let kind = contact_kind(&pair[0], &pair[1]);
        assert_eq!(world.answers(pair), [(expected, kind); 2], "{pair:?}");
    }
}

/// Ten million pairs: 16 classes of 640,000, a tenth of a class at a time in each of two threads.
#[test]
#[ignore = "minutes; see the head of this file"]
fn ten_million_pairs() {
    const SHARE: u64 = 32_000;
    println!(
        "{:<16}{:>11}{:>11}{:>11}{:>12}{:>11}{:>11}{:>9}",
        "class", "pairs", "meeting", "crossing", "overlapping", "as f32 too", "exact", "seconds"
    );
    let print = |name: &str, tally: Tally, time: Duration| {
        let Tally {
            pairs,
            meeting,
            crossing,
            overlapping,
            as_f32,
            by_exact_arithmetic,
        } = tally;
        let seconds = time.as_secs_f64();
        println!(
            "{name:<16}{pairs:>11}{meeting:>11}{crossing:>11}{overlapping:>12}{as_f32:>11}\
             {by_exact_arithmetic:>11}{seconds:>9.1}"
        );
    };
    let begin = Instant::now();
    let mut all = Tally::default();
    for class in Class::ALL {
        let begin = Instant::now();
        let half = move |first: u64| {
            let mut tally = Tally::default();
            for share in 0..10 {
                tally += compare(class, 1000 + first + 2 * share, SHARE);
            }
            tally
        };
        let tally = thread::scope(|scope| {
            let other = scope.spawn(|| half(1));
            let mut tally = half(0);
            tally += other.join().unwrap();
            tally
        });
        print(&format!("{class:?}"), tally, begin.elapsed());
        all += tally;
    }
    print("all", all, begin.elapsed());
    assert!(all.pairs >= 10_000_000);
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.meeting += other.meeting;
        self.crossing += other.crossing;
        self.overlapping += other.overlapping;
        self.as_f32 += other.as_f32;
        self.by_exact_arithmetic += other.by_exact_arithmetic;
    }
}

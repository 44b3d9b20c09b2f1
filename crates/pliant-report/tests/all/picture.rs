//! Pictures: equal bytes everywhere, the nearest in front, intersections in red, also behind
//! others.

use pliant::{Selection, World};
use pliant_report::Spot;
use pliant_report::picture::{Picture, Shot, View};

/// A folded sheet, and a thorn through it.
fn world() -> (World<f32>, Vec<[u32; 4]>) {
    let mut world = World::new();
    let side = 6_u32;
    let positions: Vec<[f32; 3]> = (0..side * side)
        .map(|i| {
            [
                (i % side) as f32,
                (i / side) as f32 * 0.5,
                (i % side % 2) as f32,
            ]
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..(side - 1) * side)
        .filter(|i| i % side < side - 1)
        .flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]])
        .collect();
    world.add(&triangles, &positions).unwrap();
    let thorn = [
        [2.6, 1.2, -2.0],
        [2.9, 1.2, -2.0],
        [2.7, 1.5, -2.0],
        [2.8, 1.3, 3.0],
    ];
    world
        .add(&[[0, 1, 3], [1, 2, 3], [2, 0, 3]], &thorn)
        .unwrap();
    let pairs = world.intersections(Selection::World).all().unwrap().iter();
    let rows = pairs.map(|pair| {
        [
            pair.body_a.0,
            pair.triangle_a,
            pair.body_b.0,
            pair.triangle_b,
        ]
    });
    let rows = rows.collect();
    (world, rows)
}

fn is_reddish(pixel: &[u8]) -> bool {
    pixel[0] / 2 > pixel[1] && pixel[0] / 2 > pixel[2]
}

fn png(picture: &Picture) -> Vec<u8> {
    let mut bytes = Vec::new();
    picture.write_png(&mut bytes).unwrap();
    bytes
}

fn decode(bytes: &[u8]) -> Picture {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    Picture {
        size: [info.width as usize, info.height as usize],
        pixels,
    }
}

/// Compares with the golden picture.
///
/// `PLIANT_GOLDEN=write cargo test -p pliant-report` writes it anew; then look at it.
#[test]
fn the_picture_is_the_one_that_was_looked_at() {
    let (world, pairs) = world();
    assert!(!pairs.is_empty());
    let picture = Picture::of(&world, &pairs, [160, 120]);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/thorn.png");
    if std::env::var_os("PLIANT_GOLDEN").is_some() {
        std::fs::write(path, png(&picture)).unwrap();
    }
    let golden = decode(&std::fs::read(path).unwrap());
    assert_eq!(picture.size, golden.size);
    assert!(
        picture.pixels == golden.pixels,
        "the pixels differ; PLIANT_GOLDEN=write to see how"
    );
}

#[test]
fn a_picture_survives_its_file() {
    let (world, pairs) = world();
    let picture = Picture::of(&world, &pairs, [33, 20]);
    assert!(decode(&png(&picture)) == picture);
}

#[test]
fn red_is_what_intersects_and_nothing_else() {
    let (world, pairs) = world();
    let red = |pairs: &[[u32; 4]]| {
        let picture = Picture::of(&world, pairs, [160, 120]);
        picture
            .pixels
            .chunks(3)
            .filter(|pixel| is_reddish(pixel))
            .count()
    };
    assert_eq!(red(&[]), 0);
    assert!(red(&pairs) > 50);
    // A body or a triangle that does not exist paints nothing.
    assert_eq!(red(&[[7, 0, 8, 1], [0, 9999, 1, 9999]]), 0);
}

#[test]
fn the_nearer_triangle_hides_the_other() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let faces = [[0, 1, 2], [0, 2, 3]];
    // The eye is at larger z, whatever the order of the bodies.
    for heights in [[0.0, 1e-3], [1e-3, 0.0]] {
        let mut world = World::<f64>::new();
        for z in heights {
            world.add(&faces, &square(z)).unwrap();
        }
        let front = u32::from(heights[1] > heights[0]);
        let red = |body: u32| {
            let picture = Picture::of(&world, &[[body, 0, body, 1]], [40, 40]);
            let middle = 3 * (20 * 40 + 20);
            is_reddish(&picture.pixels[middle..middle + 3])
        };
        assert!(red(front) && !red(1 - front), "{heights:?}");
    }
}

#[test]
fn what_intersects_shines_through_what_hides_it() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let faces = [[0, 1, 2], [0, 2, 3]];
    // For every order, and whatever hides it or is hidden.
    let sheets = [0.0, 1e-3, 2e-3, 3e-3];
    let orders = [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1], [1, 3, 0, 2]];
    for order in orders {
        let mut world = World::<f64>::new();
        for sheet in order {
            world.add(&faces, &square(sheets[sheet])).unwrap();
        }
        let centre = |red: &[usize]| {
            let at = |sheet| order.iter().position(|&other| other == sheet).unwrap() as u32;
            let pairs: Vec<_> = red.iter().map(|&s| [at(s), 0, at(s), 1]).collect();
            let picture = Picture::of(&world, &pairs, [40, 40]);
            let middle = 3 * (20 * 40 + 20);
            let colour: [u8; 3] = picture.pixels[middle..middle + 3].try_into().unwrap();
            colour.map(i32::from)
        };
        let (plain, red) = (centre(&[]), [0xd6, 0x2f, 0x2b]);
        for hidden in [&[0][..], &[1], &[2], &[0, 1, 2]] {
            let faint = centre(hidden);
            for part in 0..3 {
                let third = (2 * plain[part] + red[part]) / 3;
                assert!((faint[part] - third).abs() <= 1, "{order:?}: {hidden:?}");
            }
        }
        // In front it is as red as alone, whatever is behind.
        assert_eq!(centre(&[3]), centre(&[0, 1, 2, 3]));
        assert_ne!(centre(&[3]), centre(&[2]));
    }
}

#[test]
fn any_shape_gives_a_picture() {
    let corners = |scale: f64| [[0.0, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, scale]];
    for scale in [5e-324, 1e-300, 1e-30, 1.0, 1e30, f64::from(f32::MAX), 0.0] {
        let mut world = World::<f64>::new();
        world
            .add(&[[0, 1, 2], [0, 0, 1], [2, 2, 2]], &corners(scale))
            .unwrap();
        let picture = Picture::of(&world, &[[0, 0, 0, 1]], [16, 12]);
        assert_eq!(picture.pixels.len(), 3 * 16 * 12);
        let drawn = picture.pixels.chunks(3).any(is_reddish);
        // Products of the smallest numbers vanish, so that no side can be told.
        assert!(drawn || scale < 1e-150, "{scale}");
    }
    let empty = Picture::of(&World::<f32>::new(), &[], [4, 2]);
    assert_eq!(empty.pixels, [255; 24]);
}

/// Number of reddish pixels in some columns and rows of a picture.
fn red_in(
    picture: &Picture,
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
) -> usize {
    let at = |x: usize, y: usize| 3 * (y * picture.size[0] + x);
    let all = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    all.filter(|&(x, y)| is_reddish(&picture.pixels[at(x, y)..][..3]))
        .count()
}

#[test]
fn a_place_fills_the_picture_and_is_marked_in_an_inset() {
    // A wide sheet, and a thorn far in a corner of it.
    let mut world = World::<f32>::new();
    let wide = [[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0]];
    world.add(&[[0, 1, 2]], &wide).unwrap();
    let thorn = [[10.0, 10.0, -5.0], [12.0, 10.0, 5.0], [10.0, 12.0, 5.0]];
    world.add(&[[0, 1, 2]], &thorn).unwrap();
    let spot = Spot {
        number: 3,
        count: 1,
        lower: [10.0, 10.0, -5.0],
        upper: [12.0, 12.0, 5.0],
        depth: None,
        label: String::new(),
    };
    // Only the thorn is red, so that red is where the place is.
    let pairs = [[1, 0, 1, 0]];
    let shot = Shot {
        size: [320, 240],
        spot: Some(&spot),
        caption: "frame 7: 1 pair".to_owned(),
        ..Shot::default()
    };
    for (_, view) in View::NAMES {
        let picture = Picture::shot(
            &world,
            &pairs,
            &Shot {
                view,
                ..shot.clone()
            },
        );
        assert_eq!(
            picture,
            Picture::shot(
                &world,
                &pairs,
                &Shot {
                    view,
                    ..shot.clone()
                }
            )
        );
        let marked = red_in(&picture, 225..320, 170..240);
        assert!(marked > 20, "{view:?}: {marked} red pixels in the inset");
    }
    let front = Picture::shot(
        &world,
        &pairs,
        &Shot {
            view: View::Front,
            ..shot.clone()
        },
    );
    let place = red_in(&front, 100..220, 60..170);
    assert!(place > 20, "{place} red pixels in the middle");
    // Without a place, the picture of everything, without a caption.
    let whole = Shot {
        spot: None,
        caption: String::new(),
        ..shot
    };
    assert_eq!(
        Picture::shot(&world, &pairs, &whole),
        Picture::of(&world, &pairs, [320, 240])
    );
    assert_eq!("left".parse(), Ok(View::Left));
    assert_eq!(
        "above".parse::<View>().unwrap_err(),
        "there is no view \"above\"; choose one of corner, front, back, left, right, top, bottom"
    );
    // No size is too small, and no shape too strange.
    for size in [[1, 1], [17, 3], [3, 40]] {
        let empty = Picture::shot(
            &World::<f64>::new(),
            &[],
            &Shot {
                size,
                spot: Some(&spot),
                caption: "x".to_owned(),
                ..Shot::default()
            },
        );
        assert_eq!(empty.pixels.len(), 3 * size[0] * size[1]);
    }
}

#[test]
fn hits_smaller_than_a_pixel_are_seen() {
    let mut world = World::<f32>::new();
    let wide = [
        [0.0, 0.0, 0.0],
        [1000.0, 0.0, 0.0],
        [0.0, 1000.0, 0.0],
        [1000.0, 1000.0, 0.0],
    ];
    world.add(&[[0, 1, 2], [1, 3, 2]], &wide).unwrap();
    // Dust between samples, in front of the sheet; and a needle as long as the sheet, thinner than
    // a pixel.
    let dust = [
        [500.1, 500.1, 1.0],
        [500.2, 500.1, 1.0],
        [500.1, 500.2, 1.0],
    ];
    let needle = [
        [100.0, 300.01, 1.0],
        [900.0, 300.01, 1.0],
        [100.0, 300.02, 1.0],
    ];
    for corners in [dust, needle] {
        world.add(&[[0, 1, 2]], &corners).unwrap();
    }
    let shot = Shot {
        size: [100, 100],
        view: View::Front,
        ..Shot::default()
    };
    let red = |pairs: &[[u32; 4]]| red_in(&Picture::shot(&world, pairs, &shot), 0..100, 0..100);
    let [dust, needle] = [red(&[[1, 0, 1, 0]]), red(&[[2, 0, 2, 0]])];
    assert!(needle > 50, "{needle}");
    assert!((1..=4).contains(&dust), "{dust}");
}

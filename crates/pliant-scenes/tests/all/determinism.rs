//! A committed hash of every scene, which any changed bit of a position would change.
//!
//! Such a change may come from the code or from another machine.

use pliant_scenes::Scene;

/// FNV-1a hash, 64 bits.
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Hash of the bits of the positions of all bodies, little-endian.
fn hash(scene: &Scene, step: u32) -> u64 {
    let mut all = Vec::new();
    let mut positions = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, step, &mut positions);
        all.extend_from_slice(positions.as_flattened());
    }
    fnv(all.iter().flat_map(|x| x.to_bits().to_le_bytes()))
}

#[test]
fn positions_are_the_committed_ones() {
    let committed = [
        ("spheres", 1, 0x941f_2f5e_b8c2_be4c),
        ("spheres", 60, 0x7550_538e_3c9b_911b),
        ("spheres", 200, 0x5896_9d57_b689_0c5a),
        ("crowd", 1, 0x7272_5834_d364_01b5),
        ("crowd", 100, 0xc0c8_b43a_949c_26df),
        ("crowd", 200, 0xef35_d9ed_6321_4f43),
        ("arms", 1, 0x1d92_83f0_ae5c_7d62),
        ("arms", 100, 0x4de1_1a9f_2df2_12dc),
        ("arms", 200, 0xed4e_3bec_c3c8_7dd4),
        ("gather", 1, 0x916c_2fe2_6b4e_2a30),
        ("gather", 135, 0x8785_e848_7b70_5757),
        ("gather", 200, 0x5665_11a6_6286_6781),
        ("cloth", 1, 0x9438_d37b_0309_d40d),
        ("cloth", 26, 0xa096_f786_5b3c_4bf4),
        ("cloth", 50, 0x8901_563c_ccf8_89be),
    ];
    for (name, step, expected) in committed {
        let scene = Scene::new(name, None, Scene::DEFAULT_SEED).unwrap();
        let found = hash(&scene, step);
        assert_eq!(
            found, expected,
            "{name} at step {step} is now {found:#018x}"
        );
    }
}

#[test]
fn connectivity_is_the_committed_one() {
    let committed = [
        ("spheres", 0x313f_8b0c_b729_edd1),
        ("crowd", 0xd955_8696_c7b4_f309),
        ("arms", 0xd955_8696_c7b4_f309),
        ("gather", 0x3088_8c7f_fdd9_51c9),
        ("cloth", 0x17ab_2461_3fab_0b37),
    ];
    for (name, expected) in committed {
        let scene = Scene::new(name, None, Scene::DEFAULT_SEED).unwrap();
        let vertices = scene.triangles(0).iter().flatten();
        let found = fnv(vertices.flat_map(|v| v.to_le_bytes()));
        assert_eq!(found, expected, "{name} is now {found:#018x}");
    }
}

#[test]
fn a_seed_is_a_scene() {
    for name in Scene::NAMES {
        let [a, again, b] = [1, 1, 2].map(|seed| hash(&Scene::new(name, None, seed).unwrap(), 20));
        assert_eq!(a, again, "{name}");
        assert_ne!(a, b, "{name}");
    }
}

//! Scenes whose meshes change: events are possible, end as described, and are equal on every
//! machine.

use pliant_scenes::{Change, ChangingMesh, ChangingScene, Event};
use std::collections::{BTreeMap, BTreeSet};

/// A mesh to which events are applied.
#[derive(Clone, Default)]
struct Mesh {
    triangles: Vec<Option<[u32; 3]>>,
    is_vertex: Vec<bool>,
}

impl Mesh {
    fn change(&mut self, changes: &[Change]) {
        let before = self.clone();
        for change in changes {
            match change {
                Change::AddVertices(count) => {
                    self.is_vertex.extend(std::iter::repeat_n(true, *count));
                }
                Change::PlaceVertex(vertex) => {
                    assert!(!std::mem::replace(
                        &mut self.is_vertex[*vertex as usize],
                        true
                    ));
                }
                Change::SplitVertex { vertex, triangles } => {
                    let new = self.is_vertex.len() as u32;
                    assert!(self.is_vertex[*vertex as usize] && !triangles.is_empty());
                    self.is_vertex.push(true);
                    for &triangle in triangles {
                        let corners = self.triangles[triangle as usize].as_mut().unwrap();
                        assert!(corners.contains(vertex));
                        *corners = corners.map(|it| if it == *vertex { new } else { it });
                    }
                }
                Change::MergeVertices { kept, gone } => {
                    assert!(self.is_vertex[*kept as usize] && self.is_vertex[*gone as usize]);
                    for corners in self.triangles.iter_mut().flatten() {
                        *corners = corners.map(|it| if it == *gone { *kept } else { it });
                    }
                    self.is_vertex[*gone as usize] = false;
                }
                Change::AddTriangles(triangles) => {
                    self.triangles.extend(triangles.iter().copied().map(Some));
                }
                Change::SetTriangle { triangle, corners } => {
                    self.triangles[*triangle as usize] = Some(*corners);
                }
                Change::RemoveTriangles(triangles) => {
                    for &triangle in triangles {
                        assert!(self.triangles[triangle as usize].take().is_some());
                    }
                }
            }
        }
        let now = self.used();
        for vertex in before.used().difference(&now) {
            self.is_vertex[*vertex as usize] = false;
        }
        assert!(now.iter().all(|&vertex| self.is_vertex[vertex as usize]));
        for [a, b, c] in self.triangles.iter().flatten() {
            assert!(a != b && b != c && c != a);
        }
    }

    fn used(&self) -> BTreeSet<u32> {
        self.triangles.iter().flatten().flatten().copied().collect()
    }

    /// Number of boundary edges; no edge may have more than two triangles.
    fn boundary(&self) -> usize {
        let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for [a, b, c] in self.triangles.iter().flatten() {
            for [p, q] in [[a, b], [b, c], [c, a]] {
                *edges.entry([*p.min(q), *p.max(q)]).or_default() += 1;
            }
        }
        assert!(edges.values().all(|&count| count <= 2));
        edges.values().filter(|&&count| count == 1).count()
    }

    fn components(&self) -> usize {
        let mut all: Vec<BTreeSet<u32>> = Vec::new();
        for corners in self.triangles.iter().flatten() {
            let mut one: BTreeSet<u32> = corners.iter().copied().collect();
            let (with, others) = all
                .into_iter()
                .partition(|it: &BTreeSet<u32>| corners.iter().any(|vertex| it.contains(vertex)));
            all = others;
            let with: Vec<BTreeSet<u32>> = with;
            one.extend(with.into_iter().flatten());
            all.push(one);
        }
        all.len()
    }
}

/// Plays a scene to its end; `look` sees every mesh at every step.
fn play(scene: &ChangingScene, mut look: impl FnMut(u32, &[Mesh])) -> Vec<Mesh> {
    let mesh = |body| Mesh {
        triangles: scene.triangles(body).iter().copied().map(Some).collect(),
        is_vertex: vec![true; scene.vertex_count(body, 0)],
    };
    let mut meshes: Vec<Mesh> = (0..scene.body_count()).map(mesh).collect();
    let bodies = 0..scene.body_count();
    let mut played: Vec<ChangingMesh> = bodies
        .map(|body| ChangingMesh::new(scene.triangles(body), scene.vertex_count(body, 0)))
        .collect();
    let mut positions = Vec::new();
    for step in 1..=scene.steps() {
        for event in scene.events(step) {
            match event {
                Event::Edit { body, changes } => {
                    meshes[*body].change(changes);
                    played[*body].change(changes);
                }
                Event::Fuse { kept, gone } => {
                    let other = std::mem::take(&mut played[*gone]);
                    played[*kept].append(&other);
                    let gone = std::mem::take(&mut meshes[*gone]);
                    let kept = &mut meshes[*kept];
                    let by = kept.is_vertex.len() as u32;
                    let moved = |it: Option<[u32; 3]>| it.map(|it| it.map(|vertex| by + vertex));
                    kept.triangles.extend(gone.triangles.into_iter().map(moved));
                    kept.is_vertex.extend(gone.is_vertex);
                }
            }
        }
        for (body, mesh) in meshes.iter().enumerate() {
            assert_eq!(scene.vertex_count(body, step), mesh.is_vertex.len());
            let there = mesh.triangles.iter();
            let there = there.map(|it| it.unwrap_or(ChangingMesh::EMPTY));
            assert!(there.eq(played[body].triangles.iter().copied()));
            assert_eq!(played[body].vertices, mesh.is_vertex.len());
            scene.positions(body, step, &mut positions);
            assert_eq!(positions.len(), mesh.is_vertex.len());
            assert!(positions.as_flattened().iter().all(|x| x.is_finite()));
        }
        look(step, &meshes);
    }
    meshes
}

fn small(name: &str) -> ChangingScene {
    let size = match name {
        "tear" => 2 * 30 * 30,
        "shuffle" => 4 * 1024,
        _ => 1280,
    };
    ChangingScene::new(name, Some(size), ChangingScene::DEFAULT_SEED).unwrap()
}

#[test]
fn a_cut_leaves_two_pieces_with_a_rim_each() {
    let scene = small("cut");
    let first_triangles = scene.triangles(0).len();
    let mut whole = 0;
    let meshes = play(&scene, |step, meshes| {
        if step < 95 {
            whole = whole.max(meshes[0].components());
        }
    });
    assert_eq!((whole, meshes[0].components()), (1, 2));
    // Every triangle that was cut is three; each rim has one of its edges.
    let cut = (meshes[0].triangles.len() - first_triangles) / 2;
    assert!(cut > 40);
    assert_eq!(meshes[0].boundary(), 2 * cut);
}

#[test]
fn a_tear_goes_from_side_to_side() {
    let scene = small("tear");
    let sides = play(&scene, |_, _| {})[0].boundary();
    let torn: usize = (1..=250).map(|step| scene.events(step).len()).sum();
    assert_eq!(play(&scene, |_, _| {})[0].components(), 2);
    assert!(torn > 25 && sides > 4 * 30 + 2 * torn - 4);
}

#[test]
fn what_is_fused_is_one_and_closed() {
    let scene = small("fuse");
    let meshes = play(&scene, |step, meshes| {
        assert_eq!(meshes[0].boundary(), 0, "{step}");
        if step < 100 {
            assert_eq!(meshes[1].boundary(), 0);
        }
    });
    assert_eq!(meshes[0].components(), 1);
    assert!(meshes[1].triangles.is_empty());
}

#[test]
fn what_is_remeshed_stays_closed_and_uses_numbers_again() {
    let scene = small("remesh");
    let meshes = play(&scene, |_, meshes| {
        assert!(meshes.iter().all(|mesh| mesh.boundary() == 0));
    });
    for mesh in meshes {
        let many = mesh.triangles.len();
        assert!(many > 1280 + 100 && many < 1280 + 2 * 6 * 21, "{many}");
    }
}

#[test]
fn what_is_shuffled_keeps_its_mesh() {
    let scene = small("shuffle");
    assert!((1..=scene.steps()).all(|step| scene.events(step).is_empty()));
    assert_eq!(scene.triangles(0).len(), 4 * 1024);
}

#[test]
fn defaults_are_those_of_the_front_page() {
    let shape = |name| {
        let scene = ChangingScene::new(name, None, ChangingScene::DEFAULT_SEED).unwrap();
        assert_eq!(scene.name(), name);
        let triangles = scene.triangles(0).len();
        (scene.body_count(), triangles, scene.steps())
    };
    let expected = [
        (1, 20_480, 200),
        (1, 79_202, 250),
        (2, 20_480, 200),
        (1, 81_920, 200),
        (2, 20_480, 200),
    ];
    assert_eq!(ChangingScene::NAMES.map(shape), expected);
    let error = ChangingScene::new("shuffle", Some(80_000), 0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a body of scene `shuffle` cannot have 80000 triangles; \
         the nearest possible numbers are 65536 and 81920"
    );
}

/// A hash of events and positions, in small scenes.
#[test]
fn events_and_positions_are_the_committed_ones() {
    let committed = [
        ("cut", 0x1035_7259_6c55_f5f3),
        ("tear", 0xd422_ec4f_4fbb_b90a),
        ("fuse", 0x4b75_7473_0778_25b1),
        ("shuffle", 0xf9cb_ddae_5d2f_2fb9),
        ("remesh", 0xee99_5dfc_1e1d_4c41),
    ];
    for (name, expected) in committed {
        let scene = small(name);
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut take = |byte: u8| hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let mut positions = Vec::new();
        for step in 1..=scene.steps() {
            format!("{:?}", scene.events(step))
                .bytes()
                .for_each(&mut take);
            for body in 0..scene.body_count() {
                scene.positions(body, step, &mut positions);
                let bits = positions.as_flattened().iter().map(|x| x.to_bits());
                bits.flat_map(u32::to_le_bytes).for_each(&mut take);
            }
        }
        assert_eq!(hash, expected, "{name} is now {hash:#018x}");
    }
}

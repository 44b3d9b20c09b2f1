//! Fuzzes glTF accessors and buffer views: any numbers over any bytes.
//!
//! The document uses them for everything that a file can contain. A fuzzer of bytes does not find
//! this, since the JSON must be whole first. Buffers are the chunk behind the JSON, and the file
//! itself.
#![no_main]

use arbitrary::Arbitrary;
use std::fmt::Write as _;

#[derive(Arbitrary, Debug)]
struct Input<'a> {
    views: Vec<View>,
    accessors: Vec<Accessor>,
    /// Positions of another primitive, which has nothing else.
    another: Option<u8>,
    mode: u8,
    positions: u8,
    indices: Option<u8>,
    /// Joints, weights, and the skin's matrices.
    held: Option<(u8, u8, Option<u8>)>,
    targets: Vec<u8>,
    /// Times, values, the animated property, and the interpolation.
    clip: Option<(u8, u8, u8, u8)>,
    bytes: &'a [u8],
}

#[derive(Arbitrary, Debug)]
struct View {
    is_of_the_file: bool,
    offset: Number,
    length: Number,
    stride: Option<Number>,
}

#[derive(Arbitrary, Debug)]
struct Accessor {
    view: Option<u8>,
    offset: Number,
    count: Number,
    component: u8,
    shape: u8,
    normalized: bool,
    sparse: Option<Sparse>,
}

#[derive(Arbitrary, Debug)]
struct Sparse {
    count: Number,
    component: u8,
    indices: (u8, Number),
    values: (u8, Number),
}

/// A number of the document. Small ones are sometimes right; in others sums and products overflow.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Number {
    Small(u8),
    Medium(u16),
    Large(u32),
    Largest(u8),
}

impl Number {
    fn get(self) -> u64 {
        match self {
            Self::Small(x) => x.into(),
            Self::Medium(x) => x.into(),
            Self::Large(x) => x.into(),
            Self::Largest(below) => u64::MAX - u64::from(below),
        }
    }
}

fn component(number: u8) -> u32 {
    [5126, 5121, 5123, 5125, 5120, 5122, 5124, 0][usize::from(number % 8)]
}

fn shape(number: u8) -> &'static str {
    ["VEC3", "SCALAR", "VEC4", "MAT4", "VEC2"][usize::from(number % 5)]
}

/// Index into `items`, or one beyond the end.
fn one_of<T>(items: &[T], number: u8) -> usize {
    usize::from(number) % (items.len() + 1)
}

/// Elements of a JSON array, separated by commas.
fn list<T>(items: &[T], each: impl Fn(&T) -> String) -> String {
    items.iter().map(each).collect::<Vec<_>>().join(",")
}

fn view(view: &View) -> String {
    let stride = view
        .stride
        .map(|stride| format!(",\"byteStride\":{}", stride.get()));
    format!(
        "{{\"buffer\":{},\"byteOffset\":{},\"byteLength\":{}{}}}",
        u8::from(view.is_of_the_file),
        view.offset.get(),
        view.length.get(),
        stride.unwrap_or_default()
    )
}

fn accessor(accessor: &Accessor, views: &[View]) -> String {
    let view = |number: u8| one_of(views, number);
    let mut text = format!(
        "{{\"componentType\":{},\"type\":\"{}\",\"count\":{},\"byteOffset\":{},\"normalized\":{}",
        component(accessor.component),
        shape(accessor.shape),
        accessor.count.get(),
        accessor.offset.get(),
        accessor.normalized
    );
    if let Some(number) = accessor.view {
        write!(text, ",\"bufferView\":{}", view(number)).expect("text grows");
    }
    if let Some(sparse) = &accessor.sparse {
        let ((indices, at), (values, from)) = (sparse.indices, sparse.values);
        write!(
            text,
            ",\"sparse\":{{\"count\":{},\
             \"indices\":{{\"bufferView\":{},\"byteOffset\":{},\"componentType\":{}}},\
             \"values\":{{\"bufferView\":{},\"byteOffset\":{}}}}}",
            sparse.count.get(),
            view(indices),
            at.get(),
            component(sparse.component),
            view(values),
            from.get()
        )
        .expect("text grows");
    }
    text + "}"
}

fn document(input: &Input) -> String {
    let accessor_of = |number: u8| one_of(&input.accessors, number);
    let mut attributes = format!("\"POSITION\":{}", accessor_of(input.positions));
    let (mut skin, mut skins) = ("", String::new());
    if let Some((joints, weights, matrices)) = input.held {
        let [joints, weights] = [joints, weights].map(accessor_of);
        let matrices = matrices.map(accessor_of);
        write!(attributes, ",\"JOINTS_0\":{joints},\"WEIGHTS_0\":{weights}").expect("text grows");
        let matrices = matrices.map(|matrices| format!(",\"inverseBindMatrices\":{matrices}"));
        skins = format!("{{\"joints\":[1,2]{}}}", matrices.unwrap_or_default());
        skin = ",\"skin\":0";
    }
    let indices = input
        .indices
        .map(|indices| format!(",\"indices\":{indices}"));
    let clip = input.clip.map(|(times, values, path, way)| {
        let [times, values] = [times, values].map(accessor_of);
        let path = ["translation", "rotation", "scale", "weights"][usize::from(path % 4)];
        let node = if path == "weights" { 0 } else { 1 };
        let way = ["LINEAR", "STEP", "CUBICSPLINE"][usize::from(way % 3)];
        format!(
            "{{\"channels\":[{{\"sampler\":0,\"target\":{{\"node\":{node},\"path\":\"{path}\"}}}}],\
             \"samplers\":[{{\"input\":{times},\"output\":{values},\"interpolation\":\"{way}\"}}]}}"
        )
    });
    let targets = list(&input.targets, |&target| {
        format!("{{\"POSITION\":{}}}", accessor_of(target))
    });
    let primitive = format!(
        "{{\"attributes\":{{{attributes}}},\"mode\":{},\"targets\":[{targets}]{}}}",
        4 + input.mode % 3,
        indices.unwrap_or_default()
    );
    let another = input.another.map(|positions| {
        let positions = accessor_of(positions);
        format!(",{{\"attributes\":{{\"POSITION\":{positions}}}}}")
    });
    let primitives = primitive + &another.unwrap_or_default();
    format!(
        "{{\"scenes\":[{{\"nodes\":[0,1]}}],\
         \"nodes\":[{{\"mesh\":0{skin}}},{{\"children\":[2]}},{{}}],\"skins\":[{skins}],\
         \"meshes\":[{{\"weights\":[0.5,2],\"primitives\":[{primitives}]}}],\
         \"animations\":[{}],\"accessors\":[{}],\"bufferViews\":[{}],\
         \"buffers\":[{{\"byteLength\":{}}},{{\"byteLength\":{},\"uri\":\"fuzzed.gltf\"}}]}}",
        clip.unwrap_or_default(),
        list(&input.accessors, |it| accessor(it, &input.views)),
        list(&input.views, view),
        input.bytes.len(),
        u64::MAX,
    )
}

libfuzzer_sys::fuzz_target!(|input: Input| {
    pliant_fuzz::read_as(
        "gltf",
        &pliant_fuzz::glb(document(&input).as_bytes(), input.bytes),
    );
});

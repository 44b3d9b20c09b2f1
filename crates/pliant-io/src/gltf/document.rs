//! The JSON of a glTF file, as far as it describes triangles and their motion.
//!
//! All else (materials, cameras, ...) is passed over unread, so that faults there do not matter.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::error::Reason;
use crate::shown::shown_within;
use crate::text::quoted;

#[derive(Deserialize, Debug, Default)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    pub(super) extensions_used: Vec<String>,
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    pub(super) scenes: Vec<Roots>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) skins: Vec<Skin>,
    pub(super) animations: Vec<Animation>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<View>,
    pub(super) buffers: Vec<Buffer>,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
struct Asset {
    version: String,
}

impl Asset {
    fn check_version(&self) -> Result<(), Reason> {
        let Self { version } = self;
        if version.is_empty() || version.starts_with("2.") {
            return Ok(());
        }
        Err(Reason::Unsupported(format!(
            "is glTF {}; only version 2 can be read, so convert it",
            quoted(version)
        )))
    }
}

/// The part of a document that all versions have in common.
#[derive(Deserialize)]
struct OfAnyVersion {
    asset: Asset,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
pub(super) struct Roots {
    pub(super) nodes: Vec<usize>,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<Box<[f64; 3]>>,
    pub(super) rotation: Option<Box<[f64; 4]>>,
    pub(super) scale: Option<Box<[f64; 3]>>,
    pub(super) weights: Option<Vec<f64>>,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
    pub(super) weights: Vec<f64>,
}

#[derive(Deserialize, Debug)]
pub(super) struct Primitive {
    #[serde(default)]
    pub(super) attributes: BTreeMap<String, usize>,
    pub(super) indices: Option<usize>,
    #[serde(default = "triangles")]
    pub(super) mode: u32,
    #[serde(default)]
    pub(super) targets: Vec<BTreeMap<String, usize>>,
    #[serde(default)]
    extensions: PrimitiveExtensions,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    draco: Option<IgnoredAny>,
}

fn triangles() -> u32 {
    4
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub(super) joints: Vec<usize>,
    pub(super) inverse_bind_matrices: Option<usize>,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
pub(super) struct Animation {
    pub(super) name: Option<String>,
    pub(super) channels: Vec<Channel>,
    pub(super) samplers: Vec<Sampler>,
}

#[derive(Deserialize, Debug)]
pub(super) struct Channel {
    pub(super) sampler: usize,
    pub(super) target: Target,
}

#[derive(Deserialize, Debug)]
pub(super) struct Target {
    pub(super) node: Option<usize>,
    pub(super) path: String,
    #[serde(default)]
    extensions: TargetExtensions,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
struct TargetExtensions {
    #[serde(rename = "KHR_animation_pointer")]
    pointer: Option<Pointer>,
}

#[derive(Deserialize, Debug)]
struct Pointer {
    pointer: String,
}

impl Target {
    /// JSON pointer that `KHR_animation_pointer` names.
    pub(super) fn pointer(&self) -> Option<&str> {
        let pointer = self.extensions.pointer.as_ref()?;
        (self.path == "pointer").then_some(&pointer.pointer)
    }
}

#[derive(Deserialize, Debug)]
pub(super) struct Sampler {
    pub(super) input: usize,
    pub(super) output: usize,
    #[serde(default = "linear")]
    pub(super) interpolation: String,
}

fn linear() -> String {
    "LINEAR".to_owned()
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<Box<Sparse>>,
}

#[derive(Deserialize, Debug)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparseIndices,
    pub(super) values: SparseValues,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
    #[serde(default)]
    extensions: ViewExtensions,
}

#[derive(Deserialize, Debug, Default)]
#[serde(default)]
struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    meshopt: Option<Box<Compressed>>,
    #[serde(rename = "KHR_meshopt_compression")]
    khr_meshopt: Option<Box<Compressed>>,
}

/// Location and encoding of the compressed bytes of a view.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct Compressed {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: u64,
    pub(super) count: u64,
    pub(super) mode: String,
    pub(super) filter: Option<String>,
}

impl View {
    /// The compressed form of its bytes: the only one if its buffer has no bytes.
    pub(super) fn compressed(&self) -> Option<&Compressed> {
        let ViewExtensions {
            meshopt,
            khr_meshopt,
        } = &self.extensions;
        meshopt.as_deref().or(khr_meshopt.as_deref())
    }
}

#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: u64,
}

/// Upper bound of the bytes that a parsed value takes, per `,`, `[` or `{` in the text.
const VALUE: u64 = 256;

/// Upper bound of the memory that the document in `text` takes, text included. Takes O(length).
pub(super) fn memory(text: &[u8]) -> u64 {
    let begins = |byte: &&u8| matches!(byte, b',' | b'[' | b'{');
    let values = text.iter().filter(begins).count() as u64;
    (text.len() as u64 * 2).saturating_add(values * VALUE)
}

impl Document {
    pub(super) fn parse(text: &[u8]) -> Result<Self, Reason> {
        let text = text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text);
        let document: Self = serde_json::from_slice(text).map_err(|error| {
            // Version 1 has objects where version 2 has arrays.
            if let Ok(OfAnyVersion { asset }) = serde_json::from_slice(text)
                && let Err(reason) = asset.check_version()
            {
                return reason;
            }
            // The message may quote a string of the file, of any length.
            let mut message = shown_within(error.to_string(), 200);
            if error.is_eof() {
                message = format!(
                    "the JSON is cut short at line {} column {}",
                    error.line(),
                    error.column()
                );
                return Reason::Truncated(message);
            }
            Reason::Malformed(format!("the JSON does not describe a glTF file: {message}"))
        })?;
        document.asset.check_version()?;
        document.refuse_extensions()?;
        Ok(document)
    }

    /// Refuses extensions that would change shapes if they were evaluated.
    fn refuse_extensions(&self) -> Result<(), Reason> {
        let unsupported = |why: String| Err(Reason::Unsupported(why));
        for name in &self.extensions_required {
            match &name[..] {
                "KHR_mesh_quantization"
                | "KHR_animation_pointer"
                | "EXT_meshopt_compression"
                | "KHR_meshopt_compression" => {}
                DRACO => return unsupported(DRACO_REFUSED.into()),
                name if is_of_looks(name) => {}
                name => {
                    return unsupported(format!(
                        "needs the extension {}, which is not evaluated; export it without",
                        quoted(name)
                    ));
                }
            }
        }
        // Draco need not be required: the file may have uncompressed data too, or none.
        let has_no_data = |primitive: &Primitive| {
            let attributes = primitive.attributes.iter();
            let shapes = attributes.filter(|(name, _)| {
                name.starts_with("POSITION")
                    || name.starts_with("JOINTS_")
                    || name.starts_with("WEIGHTS_")
            });
            let used = shapes.map(|(_, accessor)| accessor);
            let used = used.chain(&primitive.indices);
            // Sparse values replace some of the compressed ones, not of zeros.
            let mut accessors = used.filter_map(|&accessor| self.accessors.get(accessor));
            primitive.extensions.draco.is_some() && accessors.any(|it| it.buffer_view.is_none())
        };
        let mut primitives = self.meshes.iter().flat_map(|mesh| &mesh.primitives);
        if primitives.any(has_no_data) {
            return unsupported(DRACO_REFUSED.into());
        }
        if self
            .extensions_used
            .iter()
            .any(|name| name == "EXT_mesh_gpu_instancing")
        {
            return unsupported(
                "uses EXT_mesh_gpu_instancing, which is not evaluated; \
                 export every instance as a node"
                    .to_owned(),
            );
        }
        Ok(())
    }

    /// Name of an animation, or its number if it has none.
    pub(super) fn clip_name(&self, animation: usize) -> String {
        let name = self
            .animations
            .get(animation)
            .and_then(|it| it.name.clone());
        name.unwrap_or_else(|| animation.to_string())
    }
}

const DRACO: &str = "KHR_draco_mesh_compression";
const DRACO_REFUSED: &str =
    "is compressed by Draco, which is not evaluated; export it without compression";

/// Whether an extension affects only the look of surfaces.
fn is_of_looks(name: &str) -> bool {
    [
        "KHR_materials_",
        "KHR_texture_",
        "EXT_texture_",
        "KHR_lights_",
        "EXT_lights_",
    ]
    .iter()
    .any(|begin| name.starts_with(begin))
        || matches!(name, "KHR_xmp_json_ld" | "KHR_xmp")
}

//! Options for reading a body.

use crate::files::Files;

/// Options for reading a body: welding, memory, animation, and where its files are.
///
/// ```
/// use pliant_io::OpenOptions;
/// let as_in_the_file = OpenOptions { weld: false, ..OpenOptions::default() };
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct OpenOptions {
    /// Whether to weld vertices whose boundary edges coincide bit for bit, in each frame. Default:
    /// true.
    ///
    /// Without welding, every seam of a file that splits vertices is reported as an intersection.
    pub weld: bool,
    /// Tolerance for joining boundary edges that nearly coincide. Default: 0, which joins none.
    ///
    /// In diagonals of the body's bounding box in the current frame: 0, or from 1e-15 to 0.1. Both
    /// ends of two edges must be at most this far apart; the nearest edges are joined first. Single
    /// points are never joined, nor two corners of one triangle. Joined vertices have one position,
    /// the position of the smallest. Ignored where [`weld`](Self::weld) is off.
    pub weld_tolerance: f64,
    /// Upper limit of the memory of a frame, in bytes. Default: 4 GiB.
    ///
    /// All data held at once is counted:
    ///
    /// | bytes | for each |
    /// |---|---|
    /// | 12 or 24 | vertex (f32 or f64) |
    /// | 12 | triangle |
    /// | 4 | triangle, where the body has polygons of more than three corners |
    /// | 24 | triangle, while seams are found; at most 12 of them stay |
    /// | 8 | vertex, while seams are found; at most 12 stay |
    ///
    /// Without [`weld`](Self::weld) the last two are not needed. The bytes that stay are held twice
    /// while a later frame has other seams.
    ///
    /// A frame that announces more is refused before it is read. An OBJ file announces nothing; it
    /// is refused once as much has been read. Buffers are not counted, nor the line or polygon
    /// being read; these take many MB only where a line or polygon is that long.
    ///
    /// The bodies of one glTF file share the limit. The description of their shape and motion
    /// counts too.
    pub max_memory: u64,
    /// Name of the glTF animation to evaluate. Default: the first.
    ///
    /// An animation without a name is named by its number. A file without animations stands still.
    pub clip: Option<String>,
    /// Frames per second at which an animation is evaluated. Default: 30.
    pub fps: f64,
    /// Files that arguments name. Default: the system's.
    pub files: Files,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self {
            weld: true,
            weld_tolerance: 0.0,
            max_memory: 4 << 30,
            clip: None,
            fps: 30.0,
            files: Files::default(),
        }
    }
}

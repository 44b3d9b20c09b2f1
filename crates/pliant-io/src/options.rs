//! How a body is read: what callers choose.

/// How to read a body.
///
/// ```
/// use pliant_io::OpenOptions;
/// let as_in_the_file = OpenOptions { weld: false, ..OpenOptions::default() };
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct OpenOptions {
    /// Weld vertices where boundary edges coincide bit for bit, in each frame those that do there. Default: true;
    /// without, every seam of a file that splits vertices is a hit.
    pub weld: bool,
    /// Join boundary edges besides whose ends are no further apart in a frame than this times the diagonal of the body's box
    /// there, the nearest first; never single points, and never two corners of one triangle. Joined vertices have one position, that
    /// of the smallest. 0, or from 1e-15 to 0.1. Default: 0; not used where [`weld`](Self::weld) is off.
    pub weld_tolerance: f64,
    /// The most bytes that a frame may take. Default: 4 GiB.
    ///
    /// Counted is all that is held at once: 12 or 24 per vertex, 12 per triangle, 4 more where there
    /// are polygons of more corners, and, unless [`weld`](Self::weld) is off, 24 per triangle and 8 per
    /// vertex while seams are found, of which at most 12 and 12 stay, twice where a later frame has others. A frame that announces more is
    /// refused before it is read; an OBJ file announces nothing, and is refused when so much of it has
    /// been read. Not counted: buffers, and the one line or polygon in hand (many MB only where a file
    /// has a line or polygon so long).
    ///
    /// The bodies of one glTF file share it, and beside their frames what the file says about their shape and motion is counted.
    pub max_memory: u64,
    /// The animation of a glTF file to evaluate, by name; one without a name is called by its number. Default: the first. A
    /// file that has no animation stands still.
    pub clip: Option<String>,
    /// Frames a second at which an animation is evaluated. Default: 30.
    pub fps: f64,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self {
            weld: true,
            weld_tolerance: 0.0,
            max_memory: 4 << 30,
            clip: None,
            fps: 30.0,
        }
    }
}

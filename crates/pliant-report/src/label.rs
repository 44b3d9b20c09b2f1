//! What bodies and their parts are called on a page.

/// A body, drawn and named.
#[derive(Clone, Debug, Default)]
pub struct BodyLabel {
    /// What people call it; its file, say. Anything may be in it.
    pub name: String,
    /// For each triangle the polygon of the file that it is a part of, where they differ.
    pub faces: Option<Vec<u32>>,
    /// What it is split into, if each part is a body to those who read the page.
    pub parts: Option<Parts>,
}

/// What a body is split into.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// What each is called, behind the name of the whole and a `#`. Anything may be in it.
    pub names: Vec<String>,
    /// The part of each triangle; one that is of none has the number behind the last.
    pub of_triangles: Vec<u32>,
}

//! Names of bodies and their parts on a page.

/// Label of a body: its name and, if any, its polygons and parts.
#[derive(Clone, Debug, Default)]
pub struct BodyLabel {
    /// Name for people, such as the file. It may contain any text.
    pub name: String,
    /// Polygon of the file that each triangle is a part of, if polygons differ from triangles.
    pub faces: Option<Vec<u32>>,
    /// Parts, if each counts as a body on the page.
    pub parts: Option<Parts>,
}

/// Parts that a body is split into.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Names of the parts, shown behind the body's name and a `#`. They may contain any text.
    pub names: Vec<String>,
    /// Part of each triangle; a triangle without a part has the number of parts.
    pub of_triangles: Vec<u32>,
}

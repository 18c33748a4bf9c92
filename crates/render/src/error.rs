//! What can be wrong with a scene or with the options of its picture.

/// Why a picture could not be drawn or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The scene has no face.
    #[error("the scene has no face to draw")]
    EmptyScene,
    /// All the points to draw coincide.
    #[error("all {what} of the scene coincide, so there is nothing to frame")]
    NoExtent {
        /// Which points: positions or UVs.
        what: &'static str,
    },
    /// A coordinate is NaN or infinite.
    #[error("{what} {index} has a coordinate that is not finite")]
    NotFinite {
        /// What carries the coordinate: a vertex, a corner's UV, a colour.
        what: &'static str,
        /// Its place in the list.
        index: usize,
    },
    /// An element names a vertex that does not exist.
    #[error("{what} {index} names vertex {vertex}, but the scene has {vertices} vertices")]
    VertexOutOfRange {
        /// What names the vertex: a face, cone, seam, feature, corner or end.
        what: &'static str,
        /// Its place in the list.
        index: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A list has a wrong length.
    #[error("expected {expected} {what}, found {found}")]
    WrongCount {
        /// What the list holds.
        what: &'static str,
        /// The length it should have.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// There are more elements than the picture can tell apart.
    #[error("{found} {what} are more than a picture can hold")]
    TooMany {
        /// Which elements: faces or dots.
        what: &'static str,
        /// How many there are.
        found: usize,
    },
    /// The picture asks for UVs, and the scene has none.
    #[error("this picture needs the UVs of the corners, which the scene lacks")]
    MissingUvs,
    /// The picture is empty or too large.
    #[error("a picture of {width} x {height} pixels is not between 1 and {limit} on each side")]
    BadSize {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// The largest side allowed, in pixels.
        limit: u32,
    },
    /// An option lies outside its range.
    #[error("option `{name}` must be {requirement}")]
    BadOption {
        /// The option's name.
        name: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// The PNG encoder or the writer failed.
    #[error("the PNG could not be written")]
    Png(#[from] png::EncodingError),
}

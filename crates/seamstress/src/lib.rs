//! Seamless parametrizations of triangle meshes, and what people make from them.

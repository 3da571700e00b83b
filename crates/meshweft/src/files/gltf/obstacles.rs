//! What keeps a primitive, or only its vertices, as it is.

use std::borrow::Cow;

/// Why vertices stay where they are.
#[derive(Debug, Clone)]
pub(super) struct VertexObstacle {
    /// The JSON pointer to what keeps them.
    pub(super) pointer: String,
    /// The reason, to be read after "the vertices stay where they are: ".
    pub(super) why: String,
}

/// What keeps a primitive or its vertices where they are. Of each, the first reason found counts.
#[derive(Debug, Clone, Default)]
pub(super) struct Obstacles {
    /// The reason, to be read after "left as it is: ".
    pub(super) of_primitive: Option<Cow<'static, str>>,
    pub(super) of_vertices: Option<VertexObstacle>,
    /// Pointers to what has an extension that is not known, with its name.
    pub(super) unknown: Vec<(String, String)>,
}

impl Obstacles {
    /// Whether nothing keeps anything.
    pub(super) fn are_none(&self) -> bool {
        self.of_primitive.is_none() && self.of_vertices.is_none()
    }

    pub(super) fn keep_primitive(&mut self, why: impl Into<Cow<'static, str>>) {
        self.of_primitive.get_or_insert_with(|| why.into());
    }

    pub(super) fn keep_vertices(&mut self, pointer: &str, why: impl Into<String>) {
        self.of_vertices.get_or_insert_with(|| VertexObstacle {
            pointer: pointer.to_owned(),
            why: why.into(),
        });
    }

    /// Keeps the primitive because of an extension on it or its mesh that is not known.
    pub(super) fn keep_primitive_for_unknown(&mut self, pointer: &str, extension: &str) {
        self.keep_primitive(format!(
            "the extension {extension} is not known and may depend on the order of its faces or vertices: \
             if it does not, add it to assume_order_safe"
        ));
        self.unknown
            .push((pointer.to_owned(), extension.to_owned()));
    }

    /// Keeps the vertices because of an extension on their data that is not known.
    pub(super) fn keep_vertices_for_unknown(&mut self, pointer: &str, extension: &str) {
        let why = format!("the extension {extension} is not known and may depend on their order");
        self.keep_vertices(pointer, why);
        self.unknown
            .push((pointer.to_owned(), extension.to_owned()));
    }
}

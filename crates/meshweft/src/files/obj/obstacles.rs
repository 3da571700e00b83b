//! What keeps the vertices or the faces of an OBJ where they are, as far as the whole file tells it.

use super::reader::ObjReader;
use crate::files::error::Fault;

impl ObjReader<'_> {
    /// Whether all numbers name vertices, and what must stay: all vertices and runs are known.
    pub(super) fn check(&mut self) -> Result<(), Fault> {
        self.check_range()?;
        // Unknown statements; where the vertices stand is no matter when some of them leave.
        self.bond = self.obstacle.clone();
        self.check_late_vertex();
        self.check_comments()?;
        self.check_attributes();
        Ok(())
    }

    /// A vertex below a face, line or point that may come to name it keeps all where they are. Those
    /// between the faces of the first run go above these.
    fn check_late_vertex(&mut self) {
        let Some(at) = self.late_vertex else { return };
        let last_vertex = self.vertices.start(self.vertices.len() - 1);
        let end_of_run = self
            .runs
            .starts
            .get(1)
            .map_or(self.faces.len(), |&end| end as usize);
        let goes_above = end_of_run > 0
            && last_vertex < self.faces.start(end_of_run - 1)
            && last_vertex < self.lines.start(0);
        if !goes_above {
            let why = "this one comes after faces, lines or points".to_owned();
            self.keep_vertices(at, why);
        }
    }

    /// Keeps the vertices where they are; what stands first in the file is why.
    fn keep_vertices(&mut self, at: usize, why: String) {
        if self.obstacle.as_ref().is_none_or(|&(other, _)| at < other) {
            self.obstacle = Some((at, why));
        }
    }

    /// Comments with data for each vertex or face, unless it can go along, keep these where they are.
    fn check_comments(&mut self) -> Result<(), Fault> {
        let vertex_count = self.vertices.len();
        if let Some((at, why)) = self.comments.vertex_obstacle(vertex_count) {
            self.bond.get_or_insert_with(|| (at, why.clone()));
            self.keep_vertices(at, why);
        }
        let of_vertices = self.comments.unknown(vertex_count, self.options);
        let of_faces = self.comments.unknown(self.faces.len(), self.options);
        let unknown = of_vertices.as_ref().or(of_faces.as_ref());
        let refused = unknown.and_then(|(at, word)| {
            let kind = self.options.refusal("the comment", word)?;
            Some(Fault { at: *at, kind })
        });
        refused.map_or(Ok(()), Err)?;
        match of_vertices {
            Some((at, word)) => {
                let why = format!("the comments {word:?} may go by their order");
                self.bond.get_or_insert_with(|| (at, why.clone()));
                self.keep_vertices(at, why);
            }
            None => self.face_obstacle = of_faces,
        }
        Ok(())
    }

    /// Texture coordinates or normals that no face names, as many as vertices: some programs take
    /// them as belonging to the vertices one by one, so these must not move.
    fn check_attributes(&mut self) {
        for (keyword, seen) in ["vt", "vn"].into_iter().zip(self.values) {
            if seen.count > 0 && seen.count == self.vertices.len() && !seen.is_named {
                let why = format!(
                    "the {keyword} lines, one for each and not used by any face, may belong to them"
                );
                self.bond.get_or_insert_with(|| (seen.first, why.clone()));
                self.obstacle.get_or_insert((seen.first, why));
            }
        }
    }
}

//! What may be wrong with the faces of a surface, whatever it is over.

/// What a surface is beside all heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct SurfaceFaults {
    /// Places of full detail that no face covers.
    pub(super) uncovered: usize,
    /// Voids in a face, or at its corner.
    pub(super) covered_voids: usize,
    /// Heights inside of a face that are in another one as well, or at its side.
    pub(super) overlaps: usize,
    /// Faces that are clockwise seen from above, or have no area.
    pub(super) turned: usize,
    /// Sides of faces with more than two of them, or with one where full detail goes on.
    pub(super) cracks: usize,
    /// Whether the faces have another area than full detail.
    pub(super) has_other_area: bool,
}

impl SurfaceFaults {
    #[cfg(test)]
    pub(super) fn is_sound(&self) -> bool {
        *self == Self::default()
    }
}

/// In which faces each height was found so far.
#[derive(Debug)]
pub(super) struct Coverage(Vec<Covered>);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Covered {
    No,
    AtASide,
    Inside,
}

/// What a height that is in a face is new for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CoveredAs {
    First,
    /// At a common side or corner.
    Again,
    /// Two faces at most one of which may have it.
    Overlapping,
}

impl Coverage {
    pub(super) fn new(heights: usize) -> Self {
        Self(vec![Covered::No; heights])
    }

    /// A face has a height inside, or at a side.
    pub(super) fn add(&mut self, height: usize, is_inside: bool) -> CoveredAs {
        let covered = &mut self.0[height];
        match (*covered, is_inside) {
            (Covered::No, true) => *covered = Covered::Inside,
            (Covered::No, false) => *covered = Covered::AtASide,
            (Covered::AtASide, false) => return CoveredAs::Again,
            (Covered::Inside, _) | (_, true) => return CoveredAs::Overlapping,
        }
        CoveredAs::First
    }

    pub(super) fn has(&self, height: usize) -> bool {
        self.0[height] != Covered::No
    }
}

/// The sides of faces, from vertex to vertex, sorted.
#[derive(Debug)]
pub(super) struct SurfaceSides(Vec<[u32; 2]>);

impl SurfaceSides {
    pub(super) fn of(faces: &[(u32, [u32; 3])]) -> Self {
        let sides = faces
            .iter()
            .flat_map(|&(_, [a, b, c])| [[a, b], [b, c], [c, a]]);
        let mut sides: Vec<[u32; 2]> = sides.collect();
        sides.sort_unstable();
        Self(sides)
    }

    /// How many are those of more than one face, and how many open ones, with a face on one side only, `is_crack` says are cracks.
    pub(super) fn cracks(&self, mut is_crack: impl FnMut([u32; 2]) -> bool) -> usize {
        let twice = self.0.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let is_open = |&&[from, to]: &&[u32; 2]| self.0.binary_search(&[to, from]).is_err();
        let open = self.0.iter().filter(is_open);
        twice + open.filter(|&&side| is_crack(side)).count()
    }
}

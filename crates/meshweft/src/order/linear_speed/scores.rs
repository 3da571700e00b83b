//! What a vertex scores by its place in the list and by its faces that are not drawn yet.
//!
//! The figures are those that meshoptimizer (Arseny Kapoulkine, MIT License) uses in
//! `optimizeVertexCache`, `kVertexScoreTable` in its `vcacheoptimizer.cpp`. How they
//! were found is described in <https://zeux.io/2020/01/22/learning-from-data/>.

/// How many vertices are in the list.
pub(super) const LIST_SIZE: usize = 16;

/// Beyond as many live faces their number does not matter.
const MOST_LIVE: usize = 8;

/// The part of the score by place in the list, from the last used vertex on.
const BY_PLACE: [f32; LIST_SIZE] = [
    0.779, 0.791, 0.789, 0.981, 0.843, 0.726, 0.847, 0.882, 0.867, 0.799, 0.642, 0.613, 0.600,
    0.568, 0.372, 0.234,
];

/// The part of the score by the number of live faces.
const BY_LIVE_FACES: [f32; MOST_LIVE + 1] =
    [0.0, 0.995, 0.713, 0.450, 0.404, 0.059, 0.005, 0.147, 0.006];

/// The scores of a vertex at one place, by its number of live faces.
pub(super) struct ScoresAtPlace([f32; MOST_LIVE + 1]);

impl ScoresAtPlace {
    /// The score of a vertex with as many live faces.
    #[inline]
    pub(super) fn of(&self, live: u32) -> f32 {
        self.0[(live as usize).min(MOST_LIVE)]
    }
}

/// The scores at each place of the list, and at the three places of vertices that just left it.
pub(super) static VERTEX_SCORES: [ScoresAtPlace; LIST_SIZE + 3] = all_scores();

/// The scores of a vertex that is not in the list.
pub(super) static SCORES_OUTSIDE: &ScoresAtPlace = &VERTEX_SCORES[LIST_SIZE];

const fn all_scores() -> [ScoresAtPlace; LIST_SIZE + 3] {
    let mut scores = [const { ScoresAtPlace(BY_LIVE_FACES) }; LIST_SIZE + 3];
    let mut place = 0;
    while place < LIST_SIZE {
        let mut live = 0;
        while live <= MOST_LIVE {
            scores[place].0[live] += BY_PLACE[place];
            live += 1;
        }
        place += 1;
    }
    scores
}

//! What is wrong with the parts of a table.

use std::fmt;

/// Why parts are not those of a [`CullingTable`](super::CullingTable).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CullingTableError {
    /// The starts of clusters do not begin with 0, or one is below the one before.
    Starts,
    /// The number of clusters that there are planes for is not the number of clusters.
    Count {
        /// How many clusters there are.
        clusters: usize,
        /// For how many there are planes.
        found: usize,
    },
    /// The center or the reach is not a finite number, or too large, or the reach is below 0.
    Ball,
    /// A plane of this cluster has a normal longer than 1, or passes by the mesh too far away, or is not of finite numbers.
    Plane {
        /// The number of the cluster.
        cluster: usize,
    },
}

impl fmt::Display for CullingTableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Starts => f.write_str("the starts of clusters do not rise from 0"),
            Self::Count { clusters, found } => {
                write!(f, "there are {clusters} clusters, but planes of {found}")
            }
            Self::Ball => {
                f.write_str("the center or the reach is not a finite number, or out of range")
            }
            Self::Plane { cluster } => {
                write!(f, "the planes of cluster {cluster} are out of range")
            }
        }
    }
}

impl std::error::Error for CullingTableError {}

#[cfg(test)]
mod tests {
    use super::super::{CullingTable, Eye, Ranges};
    use super::CullingTableError;
    use crate::mesh::Mesh;

    /// The parts of a table.
    type Parts = ([f32; 3], f32, Vec<u32>, Vec<[[f32; 4]; 4]>);

    /// A corner of a cube far from the origin, in three clusters, one of them empty.
    fn parts() -> (CullingTable, Parts) {
        let positions = [
            [9.0, 0.0, 0.0],
            [8.0, 1.0, 0.0],
            [8.0, 0.0, 1.0],
            [8.0, 0.0, 0.0],
        ];
        let faces = [[0, 1, 2], [3, 2, 1], [3, 0, 2]];
        let mesh = Mesh::new(positions, faces).unwrap();
        let table = CullingTable::new(&mesh, &[0, 1, 1, 3]);
        let planes = (0..3).map(|cluster| table.planes(cluster)).collect();
        let parts = (
            table.center(),
            table.reach(),
            table.starts().to_vec(),
            planes,
        );
        (table, parts)
    }

    #[test]
    fn a_table_comes_back_from_its_parts() {
        let (table, (center, reach, starts, planes)) = parts();
        let again = CullingTable::from_parts(center, reach, starts, &planes);
        assert_eq!(again, Ok(table));
        let none = CullingTable::from_parts([0.0; 3], 0.0, vec![0], &[]).unwrap();
        let mut ranges = Ranges::default();
        let drawn = none.visible_ranges(Eye::at([1.0; 3]), &mut ranges);
        assert_eq!((none.cluster_count(), drawn.face_count()), (0, 0));
    }

    #[test]
    fn other_parts_are_refused() {
        let refused = |change: &dyn Fn(&mut Parts)| {
            let (_, mut parts) = parts();
            change(&mut parts);
            let (center, reach, starts, planes) = parts;
            CullingTable::from_parts(center, reach, starts, &planes).unwrap_err()
        };
        use CullingTableError::{Ball, Count, Plane, Starts};
        assert_eq!(refused(&|it| it.2.clear()), Starts);
        assert_eq!(refused(&|it| it.2[0] = 1), Starts);
        assert_eq!(refused(&|it| it.2[3] = 0), Starts);
        let [clusters, found] = [3, 2];
        assert_eq!(refused(&|it| it.3.truncate(2)), Count { clusters, found });
        for number in [f32::NAN, f32::INFINITY, -1.0, f32::MAX] {
            assert_eq!(refused(&|it| it.1 = number), Ball);
        }
        assert_eq!(refused(&|it| it.0[1] = f32::NAN), Ball);
        for (place, number) in [(0, 1.1), (1, f32::NAN), (3, 99.0), (3, f32::NEG_INFINITY)] {
            assert_eq!(
                refused(&|it| it.3[2][1][place] = number),
                Plane { cluster: 2 }
            );
        }
    }
}

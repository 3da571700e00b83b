//! Tutte's embedding: the boundary on a circle, every other vertex at the centroid of its neighbours.
//!
//! W. Tutte: *How to Draw a Graph*, 1963, doi:10.1112/plms/s3-13.1.743. Of a triangulated disk no face is
//! turned over.

/// Sweeps end when no vertex moves farther.
const STILL: f64 = 1e-13;

/// The drawing of a disk in the circle of radius 1: the first `boundary` vertices around it, in equal steps.
pub(super) fn drawing(faces: &[[u32; 3]], vertices: usize, boundary: usize) -> Vec<[f64; 2]> {
    // Around an inner vertex each neighbour is the next corner in exactly one face.
    let mut neighbors = vec![Vec::new(); vertices];
    for face in faces {
        for i in 0..3 {
            neighbors[face[i] as usize].push(face[(i + 1) % 3] as usize);
        }
    }

    let mut drawn = circle(boundary);
    drawn.resize(vertices, [0.0; 2]);
    loop {
        let mut moved = 0.0_f64;
        for vertex in boundary..vertices {
            let of = &neighbors[vertex];
            let mean = [0, 1].map(|axis| {
                of.iter().map(|&other| drawn[other][axis]).sum::<f64>() / of.len() as f64
            });
            for axis in 0..2 {
                moved = moved.max((mean[axis] - drawn[vertex][axis]).abs());
            }
            drawn[vertex] = mean;
        }
        if moved <= STILL {
            return drawn;
        }
    }
}

/// Points around the circle of radius 1 in equal steps, counterclockwise from (1, 0).
pub(super) fn circle(count: usize) -> Vec<[f64; 2]> {
    let step = std::f64::consts::TAU / count as f64;
    // Sine and cosine by their series: the library's may differ from one platform to another.
    let (mut sine, mut cosine, mut term) = (0.0, 0.0, 1.0);
    for power in 0..60_u32 {
        let sign = if power % 4 < 2 { 1.0 } else { -1.0 };
        match power % 2 {
            0 => cosine += sign * term,
            _ => sine += sign * term,
        }
        term *= step / f64::from(power + 1);
    }
    let next = |&[x, y]: &[f64; 2]| Some([x * cosine - y * sine, x * sine + y * cosine]);
    std::iter::successors(Some([1.0, 0.0]), next)
        .take(count)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_is_round() {
        for count in [3, 4, 66] {
            for (i, [x, y]) in circle(count).into_iter().enumerate() {
                let (sine, cosine) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
                assert!((x - cosine).abs() < 1e-13 && (y - sine).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_wheel_and_a_chain() {
        let wheel = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let drawn = drawing(&wheel, 5, 4);
        assert!(drawn[4].iter().all(|x| x.abs() < 1e-12));

        // Two inner vertices on the line between opposite corners, one third from each end.
        let faces = [
            [0, 1, 4],
            [1, 5, 4],
            [1, 2, 5],
            [2, 3, 5],
            [3, 4, 5],
            [3, 0, 4],
        ];
        let drawn = drawing(&faces, 6, 4);
        // x of 4 is (1 + 0 + x of 5 + 0) / 4, that of 5 its opposite.
        assert!((drawn[4][0] - 0.2).abs() < 1e-12 && (drawn[5][0] + 0.2).abs() < 1e-12);
        assert!(drawn[4][1].abs() < 1e-12);
    }
}

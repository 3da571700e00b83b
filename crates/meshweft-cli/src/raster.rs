//! Triangles with a depth buffer, as pictures in PNG.

/// Samples of a pixel in each direction.
const SAMPLES: usize = 3;
const BACKGROUND: [f32; 3] = [0.985, 0.98, 0.965];

/// A square that triangles are drawn into, the nearest in front.
pub(crate) struct Raster {
    /// In samples.
    side: usize,
    colors: Vec<[f32; 3]>,
    depths: Vec<f32>,
}

impl Raster {
    /// An empty square of so many pixels on each side.
    pub(crate) fn new(pixels: usize) -> Self {
        let side = pixels * SAMPLES;
        Self {
            side,
            colors: vec![BACKGROUND; side * side],
            depths: vec![f32::MIN; side * side],
        }
    }

    /// How many samples each side has: corners of triangles are given in these, to the right, downward and toward us.
    pub(crate) fn side(&self) -> f32 {
        self.side as f32
    }

    /// Draws a triangle whose color at a point follows from the weights of its corners there.
    pub(crate) fn triangle(
        &mut self,
        corners: [[f32; 3]; 3],
        color: impl Fn([f32; 3]) -> [f32; 3],
    ) {
        fill(corners, self.side, |x, y, [a, b, c]| {
            let z = a * corners[0][2] + b * corners[1][2] + c * corners[2][2];
            let sample = y * self.side + x;
            if z > self.depths[sample] {
                self.depths[sample] = z;
                self.colors[sample] = color([a, b, c]);
            }
        });
    }

    /// The pixels, row by row.
    pub(crate) fn finish(self) -> Vec<[u8; 3]> {
        let pixels = self.side / SAMPLES;
        let all = (0..pixels * pixels).map(|at| (at % pixels, at / pixels));
        all.map(|(x, y)| self.average(x, y)).collect()
    }

    fn average(&self, x: usize, y: usize) -> [u8; 3] {
        let mut sum = [0.0; 3];
        for sy in 0..SAMPLES {
            for sx in 0..SAMPLES {
                let sample = self.colors[(y * SAMPLES + sy) * self.side + x * SAMPLES + sx];
                for (sum, part) in sum.iter_mut().zip(sample) {
                    *sum += part;
                }
            }
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a byte"
        )]
        sum.map(|c| (c / (SAMPLES * SAMPLES) as f32 * 255.0).clamp(0.0, 255.0) as u8)
    }
}

/// Calls `visit(x, y, barycentric)` for each sample inside the triangle.
fn fill(corners: [[f32; 3]; 3], side: usize, mut visit: impl FnMut(usize, usize, [f32; 3])) {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture"
    )]
    let span = |i: usize| {
        let low = a[i].min(b[i]).min(c[i]).floor().clamp(0.0, side as f32);
        let high = a[i].max(b[i]).max(c[i]).ceil().clamp(0.0, side as f32);
        low as usize..high as usize
    };

    for y in span(1) {
        for x in span(0) {
            let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
            let edge = |p: [f32; 3], q: [f32; 3]| {
                ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])) / area
            };
            let weights = [edge(b, c), edge(c, a), edge(a, b)];
            if weights.iter().all(|&w| w >= 0.0) {
                visit(x, y, weights);
            }
        }
    }
}

/// A PNG of squares with so many pixels on each side, in so many columns; `description` says what it is.
pub(crate) fn png(
    squares: &[Vec<[u8; 3]>],
    pixels: usize,
    columns: usize,
    description: Option<&str>,
) -> Vec<u8> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a color, clamped"
    )]
    let background = BACKGROUND.map(|c| (c * 255.0) as u8);
    let rows = squares.len().div_ceil(columns);
    let mut bytes = Vec::with_capacity(3 * rows * columns * pixels * pixels);
    for row in 0..rows {
        for y in 0..pixels {
            for column in 0..columns {
                match squares.get(row * columns + column) {
                    Some(square) => {
                        bytes.extend(square[y * pixels..][..pixels].as_flattened());
                    }
                    None => bytes.extend(vec![background; pixels].as_flattened()),
                }
            }
        }
    }

    let side = |count: usize| u32::try_from(count * pixels).expect("a small picture");
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, side(columns), side(rows));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some(text) = description {
        let text = encoder.add_text_chunk("Description".to_owned(), text.to_owned());
        text.expect("a short text");
    }
    let written = encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&bytes));
    written.expect("writing to memory cannot fail");
    file
}

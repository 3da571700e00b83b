//! Frames: front faces of meshes in ranges, with depth, as a program that culls draws them.

use std::ops::Range;
use std::time::{Duration, Instant};

use crate::draw::Topology;
use crate::error::GpuError;
use crate::renderer::{Counts, Renderer, median};
use crate::vulkan::{Buffer, Commands, Draws, Geometry, Pipeline, Settings, Target, Timestamps};
use crate::workload::shader;

/// What draws frames on a card.
#[derive(Debug)]
pub struct Frames<'r, 'g> {
    renderer: &'r Renderer<'g>,
    target: Target<'g>,
    /// Two words a pixel, and its depth.
    words: Buffer<'g>,
    depths: Buffer<'g>,
    counting: Pipeline<'g>,
    timed: [Pipeline<'g>; Shading::ALL.len()],
}

/// What a vertex costs in a frame that is timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shading {
    /// A matrix: what is left is the cost of faces.
    Cheap,
    /// 3,200 floating-point operations.
    Compute,
}

impl Shading {
    /// All of them, as they are listed.
    pub const ALL: [Self; 2] = [Self::Cheap, Self::Compute];

    /// As it is printed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cheap => "cheap",
            Self::Compute => "compute",
        }
    }
}

/// One geometry, drawn at several places, each with ranges of its own.
#[derive(Debug)]
pub struct Scene<'s, 'g> {
    /// What is drawn.
    pub geometry: &'s Geometry<'g>,
    /// All ranges, one object's after the other's.
    pub draws: &'s Draws<'g>,
    /// For each object how it is seen, and which of the draws are its.
    pub objects: Vec<(View, Range<u32>)>,
}

/// A matrix from a mesh to the picture, its columns one after the other.
pub type View = [f32; 16];

/// What a frame shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// In each pixel, which draw of the object and which face of that; `None` where nothing is seen.
    pub seen: Vec<Option<[u32; 2]>>,
    /// The bits of how deep it is.
    pub depths: Vec<u32>,
}

impl<'r, 'g> Frames<'r, 'g> {
    /// Prepares pictures of this width and height.
    ///
    /// # Errors
    /// If the card has too little memory, or cannot draw so.
    pub fn new(renderer: &'r Renderer<'g>, side: u32) -> Result<Self, GpuError> {
        let gpu = renderer.gpu();
        // Says what the card does not have, before a shader asks for it.
        Draws::new(gpu, &[])?;
        let target = Target::frame(gpu, side)?;
        let pipeline = |vertex, fragment| {
            let settings = Settings {
                vertex,
                fragment: Some(fragment),
                positions: true,
                topology: Topology::TriangleList,
                restart: false,
                solid: true,
            };
            Pipeline::new(gpu, renderer.layout(), &target, &settings)
        };
        let pixels = side as usize * side as usize;
        Ok(Self {
            renderer,
            words: Buffer::zeros(gpu, 2 * pixels)?,
            depths: Buffer::zeros(gpu, pixels)?,
            counting: pipeline(shader::frame_count(gpu.has_warps()), shader::FRAME_FRAGMENT)?,
            timed: [
                pipeline(shader::FRAME, shader::RANGE_FRAGMENT)?,
                pipeline(shader::FRAME_COMPUTE, shader::RANGE_FRAGMENT)?,
            ],
            target,
        })
    }

    /// What draws on the card.
    #[must_use]
    pub fn renderer(&self) -> &'r Renderer<'g> {
        self.renderer
    }

    /// Draws a scene once: what is seen, and what the card counted.
    ///
    /// # Errors
    /// If the card fails.
    pub fn picture(&self, scene: &Scene<'_, '_>) -> Result<(Picture, Counts), GpuError> {
        let counts = self
            .renderer
            .counted_run(|commands| self.record(commands, &self.counting, scene))?;
        self.renderer.gpu().run(|commands| {
            commands.copy_frame(&self.target, &self.words, &self.depths);
        })?;
        let words = self.words.read(self.words.words())?;
        let seen = words.as_chunks().0.iter();
        let seen = seen.map(|pixel: &[u32; 2]| (pixel[0] != Target::NOTHING).then_some(*pixel));
        let picture = Picture {
            seen: seen.collect(),
            depths: self.depths.read(self.depths.words())?,
        };
        Ok((picture, counts))
    }

    /// Nanoseconds that a frame of each scene adds to one before it: the median over samples of the difference
    /// between `1 + frames` frames and one, divided by `frames`. All scenes in turn, so that a change of clocks
    /// meets all of them.
    ///
    /// # Errors
    /// If the card has no timestamps, or fails.
    pub fn time(
        &self,
        scenes: &[Scene<'_, '_>],
        shading: Shading,
        samples: u32,
        frames: u32,
    ) -> Result<Vec<f64>, GpuError> {
        let gpu = self.renderer.gpu();
        let pipeline = &self.timed[shading as usize];
        let timestamps = Timestamps::new(gpu, 4)?;
        let mut differences = vec![Vec::new(); scenes.len()];
        // The first is not taken: it may still load what it needs, and the clocks of a card that was idle rise.
        let (start, mut is_warm) = (Instant::now(), false);
        let least = match gpu.times_mean_something() {
            true => Duration::from_millis(100),
            false => Duration::ZERO,
        };
        let mut taken = 0;
        while taken < samples.max(1) {
            for (scene, differences) in scenes.iter().zip(&mut differences) {
                gpu.run(|commands| {
                    let mut stamps = commands.stamps(&timestamps);
                    for count in [1, 1 + frames.max(1)] {
                        commands.stamp(&mut stamps);
                        (0..count).for_each(|_| self.record(commands, pipeline, scene));
                        commands.stamp(&mut stamps);
                    }
                })?;
                let spans = timestamps.spans()?;
                if is_warm {
                    differences.push((spans[1] - spans[0]) / f64::from(frames.max(1)));
                }
            }
            taken += u32::from(is_warm);
            is_warm = start.elapsed() >= least;
        }
        Ok(differences.into_iter().map(median).collect())
    }

    /// A frame in a pass of its own.
    fn record<'c>(
        &'c self,
        commands: &mut Commands<'c>,
        pipeline: &'c Pipeline<'c>,
        scene: &'c Scene<'c, 'c>,
    ) {
        commands.pass(&self.target, pipeline, scene.geometry, |pass| {
            for (view, which) in &scene.objects {
                pass.draw_ranges(view, scene.draws, which.clone());
            }
        });
    }
}

//! Draws, and says what the card counted and how long it took.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use crate::draw::Draw;
use crate::error::GpuError;
use crate::vulkan::{
    Buffer, Commands, Geometry, Gpu, Layout, Pipeline, Settings, Statistics, Target, Timestamps,
};
use crate::workload::{SIZE, Workload, shader};

/// Most invocations that are written down one by one.
pub const MOST_LOGGED: usize = 1 << 20;
/// Words of the table that scattered loads read: more than the caches of a card hold.
const TABLE_WORDS: usize = 1 << 25;
/// The same where a program draws.
const SMALL_TABLE_WORDS: usize = 1 << 20;

/// A card with everything that draws need.
#[derive(Debug)]
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    target: Target<'g>,
    layout: Rc<Layout<'g>>,
    statistics: Option<Statistics<'g>>,
    /// Those that were needed so far.
    pipelines: RefCell<Vec<(Settings, Rc<Pipeline<'g>>)>>,
}

/// What the card did for one draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Invocations of the vertex shader by the card's statistics, if it has any.
    pub statistics: Option<u64>,
    /// The same, counted by the shader.
    pub invocations: u64,
    /// The groups that they ran in, if a shader of this card can tell.
    pub warps: Option<u64>,
}

/// One invocation of the vertex shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Invocation {
    /// The number of the group that it ran in, if the shader can tell.
    pub warp: u32,
    /// Its place in the group.
    pub lane: u32,
    /// The vertex.
    pub vertex: u32,
}

/// How much is drawn for one time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// How many times are taken; the result is the median.
    pub samples: u32,
    /// How many draws follow each other in a sample.
    pub draws: u32,
}

impl<'g> Renderer<'g> {
    /// Prepares the card.
    ///
    /// # Errors
    /// If it has too little memory.
    pub fn new(gpu: &'g Gpu) -> Result<Self, GpuError> {
        let table = match gpu.times_mean_something() {
            true => TABLE_WORDS.min(gpu.most_words().next_power_of_two() / 2),
            false => SMALL_TABLE_WORDS,
        };
        let buffers = [
            Buffer::zeros(gpu, 2)?,
            Buffer::zeros(gpu, 3 * MOST_LOGGED)?,
            Buffer::zeros(gpu, table)?,
        ];
        Ok(Self {
            gpu,
            target: Target::new(gpu)?,
            layout: Rc::new(Layout::new(gpu, buffers)?),
            statistics: Statistics::new(gpu)?,
            pipelines: RefCell::default(),
        })
    }

    /// The card.
    #[must_use]
    pub fn gpu(&self) -> &'g Gpu {
        self.gpu
    }

    /// Where shaders find what they are given.
    pub(crate) fn layout(&self) -> &Rc<Layout<'g>> {
        &self.layout
    }

    /// Counts what the card does while commands run.
    pub(crate) fn counted_run<'c>(
        &'c self,
        record: impl FnOnce(&mut Commands<'c>),
    ) -> Result<Counts, GpuError> {
        self.gpu.run(|commands| {
            commands.fill_with_zeros(self.layout.counters());
            commands.counted(self.statistics.as_ref(), record);
        })?;
        let counters = self.layout.counters().read(2)?;
        let statistics = self.statistics.as_ref().map(Statistics::invocations);
        Ok(Counts {
            statistics: statistics.transpose()?,
            invocations: counters[0].into(),
            warps: self.gpu.has_warps().then(|| counters[1].into()),
        })
    }

    /// A draw in the card's memory.
    ///
    /// # Errors
    /// As [`Geometry::new`].
    pub fn upload(&self, draw: &Draw<'_>) -> Result<Geometry<'g>, GpuError> {
        Geometry::new(self.gpu, draw)
    }

    /// Draws once and counts.
    ///
    /// # Errors
    /// If the card fails.
    pub fn count(&self, geometry: &Geometry<'_>) -> Result<Counts, GpuError> {
        self.counted(geometry, shader::count(self.gpu.has_warps()))
    }

    /// Draws once and writes down every invocation, sorted by group and lane; where shaders cannot tell
    /// groups, in the order in which they were written down.
    ///
    /// # Errors
    /// If there are more than [`MOST_LOGGED`], or the card fails.
    pub fn log(&self, geometry: &Geometry<'_>) -> Result<(Counts, Vec<Invocation>), GpuError> {
        let counts = self.counted(geometry, shader::log(self.gpu.has_warps()))?;
        let logged = usize::try_from(counts.invocations).unwrap_or(usize::MAX);
        if logged > MOST_LOGGED {
            return Err(GpuError::input(format!(
                "{logged} invocations of one draw; at most {MOST_LOGGED} are written down"
            )));
        }
        let words = self.layout.log().read(3 * logged)?;
        let invocation = |words: &[u32]| Invocation {
            vertex: words[0],
            warp: words[1],
            lane: words[2],
        };
        let mut log: Vec<Invocation> = words.chunks_exact(3).take(logged).map(invocation).collect();
        if counts.warps.is_some() {
            log.sort_unstable();
        }
        Ok((counts, log))
    }

    fn counted(&self, geometry: &Geometry<'_>, vertex: &'static [u8]) -> Result<Counts, GpuError> {
        let settings = Settings {
            vertex,
            fragment: Some(shader::WHITE),
            positions: false,
            topology: geometry.topology(),
            restart: geometry.restart(),
            solid: false,
        };
        let pipeline = self.pipeline(&settings)?;
        self.counted_run(|commands| {
            commands.pass(&self.target, &pipeline, geometry, |pass| {
                pass.draw([0.0; 4])
            });
        })
    }

    /// Nanoseconds that one draw adds to others before it: the median over samples of the difference
    /// between `1 + draws` draws and one, divided by `draws`. A constant changes before each draw, as in
    /// any scene. Starting and finishing the card's work cancels out.
    ///
    /// # Errors
    /// If the card has no timestamps, the geometry no positions, or the card fails.
    pub fn time(
        &self,
        geometry: &Geometry<'_>,
        workload: Workload,
        sampling: Sampling,
    ) -> Result<f64, GpuError> {
        let settings = workload.settings(geometry.topology(), geometry.restart());
        let pipeline = self.pipeline(&settings)?;
        let (samples, draws) = (sampling.samples.max(1), sampling.draws.max(1));
        let timestamps = Timestamps::new(self.gpu, 4 * samples)?;
        self.gpu.run(|commands| {
            // The first draw is not timed: it may still load what it needs.
            self.draw(commands, &pipeline, geometry, 1);
            let mut stamps = commands.stamps(&timestamps);
            for _ in 0..samples {
                for count in [1, 1 + draws] {
                    commands.stamp(&mut stamps);
                    self.draw(commands, &pipeline, geometry, count);
                    commands.stamp(&mut stamps);
                }
            }
        })?;
        let spans = timestamps.spans()?;
        let difference = |pair: &[f64]| (pair[1] - pair[0]) / f64::from(draws);
        Ok(median(spans.chunks_exact(2).map(difference).collect()))
    }

    /// Draws so often, a constant changed before each.
    fn draw<'c>(
        &'c self,
        commands: &mut Commands<'c>,
        pipeline: &'c Pipeline<'c>,
        geometry: &'c Geometry<'c>,
        count: u32,
    ) {
        commands.pass(&self.target, pipeline, geometry, |pass| {
            for number in 0..count {
                // Too little to matter, and inside the picture's depth.
                let depth = 0.25 + (number % 1024) as f32 / 4096.0;
                pass.draw([0.0, 0.0, depth, SIZE]);
            }
        });
    }

    /// Draws for a third of a second, so that the clocks of a card that was idle have risen when times are
    /// taken. Does nothing where times say nothing.
    ///
    /// # Errors
    /// As [`time`](Self::time).
    pub fn warm_up(&self, geometry: &Geometry<'_>, sampling: Sampling) -> Result<(), GpuError> {
        let start = Instant::now();
        while self.gpu.times_mean_something() && start.elapsed() < Duration::from_millis(333) {
            self.time(geometry, Workload::Setup, sampling)?;
        }
        Ok(())
    }

    fn pipeline(&self, settings: &Settings) -> Result<Rc<Pipeline<'g>>, GpuError> {
        let mut pipelines = self.pipelines.borrow_mut();
        if let Some((_, made)) = pipelines.iter().find(|(of, _)| of == settings) {
            return Ok(Rc::clone(made));
        }
        let made = Rc::new(Pipeline::new(
            self.gpu,
            &self.layout,
            &self.target,
            settings,
        )?);
        pipelines.push((*settings, Rc::clone(&made)));
        Ok(made)
    }
}

/// The middle value, the upper of two; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

//! Answers requests with the native build, for a comparison with wasm32.
//!
//! `native BITS INDEX_COUNT VERTEX_COUNT` reads from standard input the indices, each of 16 or 32
//! bits with the low byte first, then requests, each a line of text: `TARGET EFFORT STEPS
//! SEED FLAGS CACHE`. For each it orders the indices as they came and writes the status (32 bits),
//! the misses in that cache (64 bits) and the indices in their new order.

use std::error::Error;
use std::io::{self, Read, Write};

use meshweft::operations::VertexIndex;
use meshweft_wasm::{Request, misses, optimize};

fn main() -> Result<(), Box<dyn Error>> {
    let numbers = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
    let [bits, index_count, vertex_count] = numbers[..] else {
        return Err("usage: native BITS INDEX_COUNT VERTEX_COUNT <REQUESTS".into());
    };
    let mut input = Vec::new();
    io::stdin().read_to_end(&mut input)?;
    let (indices, requests) = input
        .split_at_checked(index_count * bits / 8)
        .ok_or("the input ends before the last index")?;
    let requests = str::from_utf8(requests)?;

    match bits {
        16 => answer(&read(indices, u16::from_le_bytes), vertex_count, requests),
        32 => answer(&read(indices, u32::from_le_bytes), vertex_count, requests),
        other => Err(format!("indices have 16 or 32 bits, not {other}").into()),
    }
}

fn read<I, const BYTES: usize>(bytes: &[u8], number: fn([u8; BYTES]) -> I) -> Vec<I> {
    let (numbers, _) = bytes.as_chunks();
    numbers.iter().map(|&bytes| number(bytes)).collect()
}

fn answer<I>(original: &[I], vertex_count: usize, requests: &str) -> Result<(), Box<dyn Error>>
where
    I: VertexIndex + Into<u32>,
{
    let mut output = io::stdout().lock();
    for line in requests.lines() {
        let words: Vec<_> = line.split(' ').collect();
        let [target, effort, steps, seed, flags, cache] = words[..] else {
            return Err(format!("{line:?} is not a request").into());
        };
        let request = Request {
            target,
            effort: effort.parse()?,
            steps: steps.parse()?,
            seed: seed.parse()?,
            flags: flags.parse()?,
        };

        let mut indices = original.to_vec();
        let status = optimize(&mut indices, vertex_count, &request);
        let wide: Vec<u32> = indices.iter().map(|&index| index.into()).collect();
        let mut bytes = (status as u32).to_le_bytes().to_vec();
        bytes.extend(misses(&wide, vertex_count, cache).to_le_bytes());
        bytes.extend(wide.iter().flat_map(|index| {
            let bytes = index.to_le_bytes();
            bytes.into_iter().take(size_of::<I>())
        }));
        output.write_all(&bytes)?;
        output.flush()?;
    }
    Ok(())
}

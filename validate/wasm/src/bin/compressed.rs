//! Compresses and decodes with the native build, for a comparison with wasm32.
//!
//! `compressed tiers` prints how many tiers there are. Without arguments it reads
//! [cases](meshweft_wasm::compressed) from standard input, and writes for each the length of the answer, as 32 bits
//! with the low byte first, and the answer.

use std::error::Error;
use std::io::{self, Read, Write};

use meshweft::compression::Tier;
use meshweft_wasm::compressed::{answer, case_length};

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("tiers") => println!("{}", Tier::ALL.len()),
        Some(_) => return Err("usage: compressed [tiers]".into()),
        None => answer_all()?,
    }
    Ok(())
}

fn answer_all() -> Result<(), Box<dyn Error>> {
    let mut output = io::stdout().lock();
    let mut input = io::stdin().lock();
    let mut case = Vec::new();
    loop {
        // Two counts say how much belongs to the case.
        case.clear();
        input.by_ref().take(8).read_to_end(&mut case)?;
        if case.is_empty() {
            return Ok(());
        }
        let length = case_length(&case).ok_or("the input ends within a case")?;
        let left = u64::try_from(length - case.len())?;
        input.by_ref().take(left).read_to_end(&mut case)?;
        if case.len() < length {
            return Err("the input ends within a case".into());
        }

        let answer = answer(&case);
        output.write_all(&u32::try_from(answer.len())?.to_le_bytes())?;
        output.write_all(&answer)?;
        output.flush()?;
    }
}

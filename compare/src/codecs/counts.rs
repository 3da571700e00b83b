//! Counts before the bytes of codecs that store none: 32 bits each.

/// The bytes of these counts.
pub(super) fn written<const N: usize>(counts: [usize; N]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    for count in counts {
        let count = u32::try_from(count).map_err(|_| "a count over 32 bits")?;
        bytes.extend(count.to_le_bytes());
    }
    Ok(bytes)
}

/// As many counts, and the bytes after them.
pub(super) fn read<const N: usize>(mut bytes: &[u8]) -> Result<([usize; N], &[u8]), String> {
    let mut counts = [0; N];
    for count in &mut counts {
        let (first, rest) = bytes.split_first_chunk().ok_or("the bytes end early")?;
        (*count, bytes) = (u32::from_le_bytes(*first) as usize, rest);
    }
    Ok((counts, bytes))
}

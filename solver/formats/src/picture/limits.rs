//! Limits on the size of a file: a header is checked before memory is allocated for it.

/// Values that any file may hold: 22 million pixels of three channels, 256 MB.
const FREE_VALUES: u64 = 1 << 26;
/// Values per byte of the file beyond that; a picture with anything in it packs less.
const VALUES_PER_BYTE: u64 = 256;
/// Values that no file may exceed: a lat-long picture of 24k x 12k.
const MAX_VALUES: u64 = 1 << 30;
/// Bytes that no file may exceed.
pub(super) const MAX_BYTES: u64 = 8 << 30;

/// Refuses a header that asks for more values than a file of `bytes` can hold.
pub(super) fn check(width: u64, height: u64, channels: u64, bytes: usize) -> Result<(), String> {
    let limit = FREE_VALUES.max(VALUES_PER_BYTE.saturating_mul(bytes as u64)).min(MAX_VALUES);
    if width == 0 || height == 0 {
        return Err("its header says that it has no pixels; write it again".to_owned());
    }
    let values = u128::from(width) * u128::from(height) * u128::from(channels.max(1));
    if values > u128::from(limit) {
        return Err(format!(
            "its header asks for {width} x {height} pixels of {channels} channels, too many for a \
             file of {bytes} bytes; write it again, or smaller"
        ));
    }
    Ok(())
}

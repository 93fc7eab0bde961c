//! How much memory there is.

use std::fs;

/// Share of the available memory that a solution may take.
const SHARE: f64 = 0.8;

/// Bytes that a solution may take by default: most of what is available; `None` where the system does not say.
#[must_use]
pub fn default_limit() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    available(&text).map(|bytes| (SHARE * bytes as f64) as u64)
}

fn available(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::available;

    #[test]
    fn the_kernel_s_table_is_read() {
        let text = "MemTotal:       24576000 kB\nMemFree:          1024 kB\nMemAvailable:   20000000 kB\n";
        assert_eq!(available(text), Some(20_480_000_000));
        assert_eq!(available("MemTotal: 1 kB\n"), None);
        assert_eq!(available("MemAvailable: lots\n"), None);
    }
}

//! How wide the registers are that loops are compiled for.

use pulp::Arch;
use std::sync::OnceLock;

/// The registers that every loop of this workspace takes: the widest of this machine, found once.
///
/// The environment variable `SNAKES_REGISTERS` allows narrower ones, so that times and digits of other machines can be
/// looked at on this one: `256` stops at AVX2 where there is AVX-512, `128` takes what every machine of this kind
/// has. Anything else, and widths that the machine lacks, mean the widest. The digits do not depend on it.
#[inline]
#[must_use]
pub fn registers() -> Arch {
    static CHOSEN: OnceLock<Arch> = OnceLock::new();
    *CHOSEN.get_or_init(choose)
}

/// Bits of the registers that [`registers`] has chosen.
#[must_use]
pub fn register_bits() -> u32 {
    match registers() {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(_) => 512,
        #[cfg(target_arch = "x86_64")]
        Arch::V3(_) => 256,
        _ => 128,
    }
}

#[cold]
fn choose() -> Arch {
    let asked = std::env::var("SNAKES_REGISTERS");
    at_most(asked.ok().and_then(|bits| bits.parse().ok()))
}

/// The widest registers of at most so many bits.
fn at_most(bits: Option<u32>) -> Arch {
    match bits {
        Some(128) => Arch::Scalar,
        #[cfg(target_arch = "x86_64")]
        Some(256) => pulp::x86::V3::try_new().map_or(Arch::Scalar, Arch::V3),
        _ => Arch::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn narrower_registers_are_had_for_the_asking() {
        assert!(matches!(at_most(Some(128)), Arch::Scalar));
        #[cfg(target_arch = "x86_64")]
        assert!(!matches!(at_most(Some(256)), Arch::V4(_)));
        let widest = std::mem::discriminant(&Arch::new());
        for odd in [None, Some(512), Some(7)] {
            assert!(std::mem::discriminant(&at_most(odd)) == widest);
        }
    }
}

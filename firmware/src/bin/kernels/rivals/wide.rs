//! 16-bit weights: sums need 64 bits.

use tenax_logic::array::network::ACTIVATION_MAX;

/// `I`-`H1`-`H2`-1.
pub struct WideMlp<const I: usize, const H1: usize, const H2: usize> {
    first: [[i16; I]; H1],
    second: [[i16; H1]; H2],
    last: [i16; H2],
}

impl<const I: usize, const H1: usize, const H2: usize> WideMlp<I, H1, H2> {
    pub const fn specimen(mut seed: u32) -> Self {
        let mut network = Self { first: [[0; I]; H1], second: [[0; H1]; H2], last: [0; H2] };
        let (first, second) = (network.first.as_flattened_mut(), network.second.as_flattened_mut());
        fill(first, &mut seed);
        fill(second, &mut seed);
        fill(&mut network.last, &mut seed);
        network
    }

    pub fn judge(&self, inputs: &[i16; I]) -> i64 {
        dot(&self.last, &hidden(&self.second, &hidden(&self.first, inputs)))
    }
}

const fn fill(weights: &mut [i16], seed: &mut u32) {
    let mut n = 0;
    while n < weights.len() {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        weights[n] = (*seed >> 16) as i16;
        n += 1;
    }
}

fn hidden<const I: usize, const O: usize>(weights: &[[i16; I]; O], inputs: &[i16; I]) -> [i16; O] {
    let mut activations = [0; O];
    for (activation, row) in activations.iter_mut().zip(weights) {
        *activation = (dot(row, inputs) >> 16).clamp(0, i64::from(ACTIVATION_MAX)) as i16;
    }
    activations
}

fn dot(row: &[i16], inputs: &[i16]) -> i64 {
    row.iter().zip(inputs).map(|(&w, &x)| i64::from(i32::from(w) * i32::from(x))).sum()
}

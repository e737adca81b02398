use proptest::prelude::*;
use tenax_logic::array::{Aligned, FEATURES, HIDDEN, Layer, Mlp};

const H1: usize = HIDDEN[0];
const H2: usize = HIDDEN[1];

type Plain<const IN: usize, const OUT: usize> = ([[i16; IN]; OUT], [i32; OUT], u32);

fn layer<const IN: usize, const OUT: usize>(plain: &Plain<IN, OUT>) -> Layer<IN, OUT> {
    Layer::new(plain.0, plain.1, plain.2).expect("within range")
}

fn sums<const IN: usize, const OUT: usize>(plain: &Plain<IN, OUT>, inputs: &[i16; IN]) -> [i64; OUT] {
    let product = |(w, x): (&i16, &i16)| i64::from(*w) * i64::from(*x);
    std::array::from_fn(|output| {
        i64::from(plain.1[output]) + plain.0[output].iter().zip(inputs).map(product).sum::<i64>()
    })
}

fn activations<const N: usize>(sums: [i64; N], shift: u32) -> [i16; N] {
    sums.map(|sum| (sum >> shift).clamp(0, i64::from(i16::MAX)) as i16)
}

fn plain<const IN: usize, const OUT: usize>() -> impl Strategy<Value = Plain<IN, OUT>> {
    // 112 * 500 * 2^15 + 2^24 is below 2^31.
    let weight = prop_oneof![4 => -128..=127i16, 1 => -500..=500i16, 1 => Just(-500i16)];
    let weights = prop::collection::vec(weight, IN * OUT);
    let bias = prop::collection::vec(-(1 << 24)..1 << 24, OUT);
    (weights, bias, 0..=20u32).prop_map(|(weights, bias, shift)| {
        let rows = std::array::from_fn(|o| std::array::from_fn(|i| weights[o * IN + i]));
        (rows, std::array::from_fn(|o| bias[o]), shift)
    })
}

fn inputs() -> impl Strategy<Value = [i16; FEATURES]> {
    let input = prop_oneof![3 => any::<i16>(), 1 => Just(i16::MIN), 1 => Just(i16::MAX), 1 => Just(0)];
    prop::collection::vec(input, FEATURES).prop_map(|inputs| std::array::from_fn(|n| inputs[n]))
}

proptest! {
    #[test]
    fn the_logit_is_that_of_64_bits(
        first in plain::<FEATURES, H1>(),
        second in plain::<H1, H2>(),
        last in plain::<H2, 1>(),
        frames in prop::collection::vec(inputs(), 1..12),
    ) {
        let network = Mlp { first: layer(&first), second: layer(&second), last: layer(&last) };
        for frame in &frames {
            let mut seen = Aligned([0; H1]);
            network.first.activate(&Aligned(*frame), 0..H1, &mut seen.0);
            prop_assert_eq!(seen.0, activations(sums(&first, frame), first.2));
            let [logit] = sums(&last, &activations(sums(&second, &seen.0), second.2));
            prop_assert_eq!(i64::from(network.judge(&seen)), logit);
        }
    }

    #[test]
    fn a_layer_is_refused_exactly_if_its_sums_could_overflow(
        weights in prop::array::uniform4(any::<i16>()),
        bias in any::<i32>(),
    ) {
        let worst = weights.iter().map(|w| i64::from(w.unsigned_abs()) << 15).sum::<i64>()
            + i64::from(bias.unsigned_abs());
        let layer = Layer::new([weights], [bias], 0);
        prop_assert_eq!(layer.is_ok(), worst <= i64::from(i32::MAX));
    }
}

#[test]
fn a_shift_of_all_bits_is_refused() {
    assert!(Layer::new([[1; 1]; 1], [0], 32).is_err());
}

//! Classifiers that could be shipped instead, at the sizes of `docs/figures/detectors.csv`: a kernel's name is
//! `classifier_precision_lookback`, with which the chart finds it. Those of the paper see its 76 numbers, those called
//! `structure` all 112. Their weights are nobody's; their work is real.

mod float;
mod wide;

use core::hint::black_box;

use tenax_logic::array::{FEATURES, Features, Layer, LookBack, Mlp, PAPER_FEATURES, specimen};

use self::float::{FloatDense, FloatLstm, FloatMlp};
use self::wide::WideMlp;

type PaperFeatures = [i16; PAPER_FEATURES];
type Queue380 = [PaperFeatures; 5];

static MLP_8_1: Mlp<PAPER_FEATURES, 32, 1, 16> = specimen::mlp(1);
static MLP_8_3: Mlp<PAPER_FEATURES, 32, 3, 16> = specimen::mlp(2);
static MLP_8_5: Mlp<PAPER_FEATURES, 32, 5, 16> = specimen::mlp(3);
static QUEUE_8_5: Mlp<380, 32, 1, 16> = specimen::mlp(4);
static LOGISTIC_8_1: Layer<PAPER_FEATURES, 1> = specimen::layer(&mut 5);
static MLP_16_1: WideMlp<PAPER_FEATURES, 32, 16> = WideMlp::specimen(6);
static MLP_FLOAT_1: FloatMlp<PAPER_FEATURES, 32, 1, 16> = FloatMlp::specimen(7);
static MLP_FLOAT_5: FloatMlp<PAPER_FEATURES, 32, 5, 16> = FloatMlp::specimen(8);
static LOGISTIC_FLOAT_1: FloatDense<PAPER_FEATURES, 1> = FloatDense::specimen(&mut 10);
static LSTM_FLOAT_1: FloatLstm<PAPER_FEATURES, 16> = FloatLstm::specimen(11);
static STRUCTURE_8_1: Mlp<FEATURES, 32, 1, 16> = specimen::mlp(12);
static STRUCTURE_16_1: WideMlp<FEATURES, 32, 16> = WideMlp::specimen(13);
static STRUCTURE_FLOAT_1: FloatMlp<FEATURES, 32, 1, 16> = FloatMlp::specimen(14);

/// What they remember from frame to frame.
#[derive(Default)]
pub struct Rivals {
    back_3: LookBack<32, 3>,
    back_5: LookBack<32, 5>,
    queue: Queue380Box,
    float_back: [[f32; 32]; 5],
    lstm: float::LstmQueue<16>,
}

/// The paper's queue: whole features, the newest first.
struct Queue380Box(Queue380);

impl Default for Queue380Box {
    fn default() -> Self {
        Self([[0; PAPER_FEATURES]; 5])
    }
}

impl Rivals {
    /// Runs each of them once.
    pub fn run(&mut self, features: &Features) {
        black_box(tenax_kernel_mlp_structure_8_1(black_box(&STRUCTURE_8_1), features));
        black_box(tenax_kernel_mlp_structure_16_1(black_box(&STRUCTURE_16_1), features));
        black_box(tenax_kernel_mlp_structure_float_1(black_box(&STRUCTURE_FLOAT_1), features));
        let Some(features) = features.first_chunk() else { return };
        self.queue.0.rotate_right(1);
        self.queue.0[0] = *features;
        black_box(tenax_kernel_mlp_8_1(black_box(&MLP_8_1), features));
        black_box(tenax_kernel_mlp_8_3(black_box(&MLP_8_3), &mut self.back_3, features));
        black_box(tenax_kernel_mlp_8_5(black_box(&MLP_8_5), &mut self.back_5, features));
        black_box(tenax_kernel_queue_8_5(black_box(&QUEUE_8_5), &self.queue.0));
        black_box(tenax_kernel_logistic_8_1(black_box(&LOGISTIC_8_1), features));
        black_box(tenax_kernel_mlp_16_1(black_box(&MLP_16_1), features));
        let none = &mut [[0.0; 32]; 1];
        black_box(tenax_kernel_mlp_float_1(black_box(&MLP_FLOAT_1), none, features));
        black_box(tenax_kernel_mlp_float_5(black_box(&MLP_FLOAT_5), &mut self.float_back, features));
        black_box(tenax_kernel_logistic_float_1(black_box(&LOGISTIC_FLOAT_1), features));
        black_box(tenax_kernel_lstm_float_1(black_box(&LSTM_FLOAT_1), &mut self.lstm, features));
    }
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_8_1(network: &Mlp<PAPER_FEATURES, 32, 1, 16>, features: &PaperFeatures) -> i32 {
    network.judge(&[network.see(features)])
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_8_3(
    network: &Mlp<PAPER_FEATURES, 32, 3, 16>,
    back: &mut LookBack<32, 3>,
    features: &PaperFeatures,
) -> Option<i32> {
    Some(network.judge(back.push(network.see(features))?))
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_8_5(
    network: &Mlp<PAPER_FEATURES, 32, 5, 16>,
    back: &mut LookBack<32, 5>,
    features: &PaperFeatures,
) -> Option<i32> {
    Some(network.judge(back.push(network.see(features))?))
}

/// As the paper queues: five frames' features into a network of 380 inputs.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_queue_8_5(network: &Mlp<380, 32, 1, 16>, queue: &Queue380) -> Option<i32> {
    let inputs = queue.as_flattened().try_into().ok()?;
    Some(network.judge(&[network.see(inputs)]))
}

/// Also a linear SVM: both are one weighted sum.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_logistic_8_1(layer: &Layer<PAPER_FEATURES, 1>, features: &PaperFeatures) -> [i32; 1] {
    layer.sums(features)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_16_1(network: &WideMlp<PAPER_FEATURES, 32, 16>, features: &PaperFeatures) -> i64 {
    network.judge(features)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_float_1(
    network: &FloatMlp<PAPER_FEATURES, 32, 1, 16>,
    back: &mut [[f32; 32]; 1],
    features: &PaperFeatures,
) -> f32 {
    network.judge(back, &features.map(f32::from))
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_float_5(
    network: &FloatMlp<PAPER_FEATURES, 32, 5, 16>,
    back: &mut [[f32; 32]; 5],
    features: &PaperFeatures,
) -> f32 {
    network.judge(back, &features.map(f32::from))
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_logistic_float_1(
    layer: &FloatDense<PAPER_FEATURES, 1>,
    features: &PaperFeatures,
) -> [f32; 1] {
    layer.sums(&features.map(f32::from))
}

/// A 16-cell LSTM over the last ten frames and the network 16-16-1 behind it. The encoder of an autoencoder is the same
/// work: its decoder is only needed for training.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_lstm_float_1(
    network: &FloatLstm<PAPER_FEATURES, 16>,
    queue: &mut float::LstmQueue<16>,
    features: &PaperFeatures,
) -> f32 {
    network.judge(queue, &features.map(f32::from))
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_structure_8_1(network: &Mlp<FEATURES, 32, 1, 16>, features: &Features) -> i32 {
    network.judge(&[network.see(features)])
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_structure_16_1(network: &WideMlp<FEATURES, 32, 16>, features: &Features) -> i64 {
    network.judge(features)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_structure_float_1(network: &FloatMlp<FEATURES, 32, 1, 16>, features: &Features) -> f32 {
    network.judge(&mut [[0.0; 32]; 1], &features.map(f32::from))
}

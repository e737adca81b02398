//! The model beside `rigless`'s own two, register by register and interrupt by interrupt, while random things happen.

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rigless::emulator::{Error, Memory};
use rigless::mcu::Operate;
use rigless::soc::Width;
use rigless::time::VirtualNanos;

use crate::board_model::Models;
use crate::board_model::line::Line;
use crate::board_model::part::Part;

const RCC_AHB1RSTR: u64 = 0x4002_3810;
const RCC_APB2RSTR: u64 = 0x4002_3824;
const RCC_AHB1ENR: u64 = 0x4002_3830;
const RCC_APB2ENR: u64 = 0x4002_3844;
const ADC1_SR: u64 = 0x4001_2000;
const ADC1_CR1: u64 = 0x4001_2004;
const ADC1_CR2: u64 = 0x4001_2008;
const ADC1_SMPR1: u64 = 0x4001_200C;
const ADC1_SMPR2: u64 = 0x4001_2010;
const ADC1_SQR1: u64 = 0x4001_202C;
const ADC1_SQR2: u64 = 0x4001_2030;
const ADC1_SQR3: u64 = 0x4001_2034;
const ADC1_DR: u64 = 0x4001_204C;
const DMA2_LISR: u64 = 0x4002_6400;
const DMA2_LIFCR: u64 = 0x4002_6408;
const DMA2_S0CR: u64 = 0x4002_6410;
const DMA2_S0NDTR: u64 = 0x4002_6414;
const DMA2_S0PAR: u64 = 0x4002_6418;
const DMA2_S0M0AR: u64 = 0x4002_641C;

/// On, DMA with requests for ever, triggered by TIM3.
const CR2: u64 = 1 | 1 << 8 | 1 << 9 | 0x8 << 24 | 1 << 28;
/// On, every interrupt, circular, memory counts up, half words.
const S0CR: u64 = 0b1_1111 | 1 << 8 | 1 << 10 | 1 << 11 | 1 << 13;
const RING: u64 = 0x2000_1002;
const NOWHERE: u64 = 0x6000_0000;
const RING_LEN: u64 = 112;
const SCAN_NS: u64 = 125_000;

#[derive(Default)]
struct Ram(BTreeMap<u64, u8>);

impl Memory for Ram {
    fn read(&mut self, address: u64, width: Width) -> Result<u64, Error> {
        let byte = |n| u64::from(self.0.get(&(address + n)).copied().unwrap_or(0)) << (8 * n);
        Ok((0..u64::from(width.bytes())).map(byte).sum())
    }

    fn write(&mut self, address: u64, width: Width, value: u64) -> Result<(), Error> {
        for n in 0..u64::from(width.bytes()) {
            self.0.insert(address + n, (value >> (8 * n)) as u8);
        }
        Ok(())
    }
}

/// A chip, its memory, and every change of an interrupt line with its instant.
struct Bench {
    part: Part,
    ram: Ram,
    heard: Vec<(u64, String)>,
}

impl Bench {
    fn new(models: Models) -> Self {
        let mut part = Part::new(models, Line::default()).expect("the chip");
        part.chip.adc[0].set_reference(4095);
        Self { part, ram: Ram::default(), heard: Vec::new() }
    }

    fn settle(&mut self, at: u64) {
        self.part.settle(&mut self.ram).expect("memory answers");
        self.heard.extend(self.part.drain_interrupts().into_iter().map(|change| (at, format!("{change:?}"))));
    }

    fn run_to(&mut self, at: u64) {
        while let Some(next) = self.part.next_event().filter(|next| next.0 <= at) {
            self.part.advance_to(next);
            self.settle(next.0);
        }
    }

    fn write(&mut self, at: u64, address: u64, value: u64) {
        self.run_to(at);
        self.part.write(VirtualNanos(at), address, Width::W32, value).expect("a register");
        self.settle(at);
    }

    fn read(&mut self, at: u64, address: u64) -> u64 {
        self.run_to(at);
        let value = self.part.read(VirtualNanos(at), address, Width::W32).expect("a register");
        self.settle(at);
        value
    }

    fn trigger(&mut self, at: u64) {
        self.run_to(at);
        let control = self.part.peek(VirtualNanos(at), ADC1_CR2, Width::W32).expect("a register");
        if control & 1 != 0 {
            self.part.trigger(VirtualNanos(at));
        }
        self.settle(at);
    }
}

/// The two, told the same.
struct Both([Bench; 2], Vec<String>);

impl Both {
    fn new() -> Self {
        let mut both = Self([Models::Quick, Models::Rigless].map(Bench::new), Vec::new());
        both.write(100, RCC_APB2ENR, 1 << 8);
        both.write(100, RCC_AHB1ENR, 1 << 22);
        both
    }

    fn write(&mut self, at: u64, address: u64, value: u64) {
        self.1.push(format!("{at}: {address:#x} = {value:#x}"));
        self.0.iter_mut().for_each(|bench| bench.write(at, address, value));
    }

    fn trigger(&mut self, at: u64) {
        self.1.push(format!("{at}: trigger"));
        self.0.iter_mut().for_each(|bench| bench.trigger(at));
    }

    /// A scan's codes, no two channels' and no two scans' alike.
    fn put(&mut self, at: u64, scan: u64) {
        for bench in &mut self.0 {
            bench.run_to(at);
            let code = |channel| (scan * 97 + u64::from(channel) * 211) as u16 & 0xFFF;
            bench.part.put(VirtualNanos(at), (0..16).map(|channel| (channel, code(channel))));
            bench.settle(at);
        }
    }

    fn start_stream(&mut self, at: u64, ring: u64) {
        self.write(at, DMA2_S0PAR, ADC1_DR);
        self.write(at, DMA2_S0M0AR, ring);
        self.write(at, DMA2_S0NDTR, RING_LEN);
        self.write(at, DMA2_S0CR, S0CR);
    }

    /// 14 ranks that need 8.5 us each of ADCCLK's 8 MHz, 119 us of the scan's 125.
    fn start_converter(&mut self, at: u64) {
        self.write(at, ADC1_CR1, 1 << 8);
        self.write(at, ADC1_SMPR1, 0o3_333_333_333);
        self.write(at, ADC1_SMPR2, 0o3_333_333_333);
        self.write(at, ADC1_SQR1, 13 << 20 | 13 | 12 << 5);
        self.write(at, ADC1_SQR2, (0..6).map(|n| (6 + n) << (5 * n)).sum());
        self.write(at, ADC1_SQR3, (0..6).map(|n| n << (5 * n)).sum());
        self.write(at, ADC1_CR2, CR2);
    }

    fn agree(&mut self, at: u64) {
        for address in [DMA2_S0NDTR, DMA2_LISR, DMA2_S0CR, DMA2_S0M0AR, ADC1_SR, ADC1_CR2] {
            let [quick, rigless] = self.0.each_mut().map(|bench| bench.read(at, address));
            assert_eq!(
                quick,
                rigless,
                "{address:#x} at {at} ns after {:#?}",
                self.1.iter().rev().take(12).collect::<Vec<_>>()
            );
        }
        let [quick, rigless] = &self.0;
        assert!(quick.ram.0 == rigless.ram.0, "what is in memory at {at} ns");
        assert_eq!(quick.heard, rigless.heard, "interrupts by {at} ns");
    }
}

#[test]
fn it_shows_what_two_models_show_at_every_instant() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut both = Both::new();
    both.start_converter(200);
    both.start_stream(300, RING);
    for scan in 1..40 {
        let at = scan * SCAN_NS;
        both.put(at, scan);
        both.trigger(at);
        if scan % 4 == 0 {
            // Looked at in the middle, as a task is that asks how full the ring is.
            let mut looks: Vec<u64> = (0..20).map(|_| at + random.random_range(0..SCAN_NS)).collect();
            looks.sort_unstable();
            looks.into_iter().for_each(|look| both.agree(look));
            both.write(at + SCAN_NS - 1, DMA2_LIFCR, 0x30);
        }
    }
    both.agree(40 * SCAN_NS);
    assert_eq!(both.0[0].ram.0.len(), 2 * RING_LEN as usize);
    assert!(both.0[0].heard.len() > 10, "{:?}", both.0[0].heard);
}

/// Streams that stop in the middle of a scan, begin again, or are sent nowhere; a converter switched off and on, read and
/// cleared by the core; pins that change in the middle; both reset.
#[test]
fn it_fails_as_two_models_fail() {
    for seed in 0..200 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut both = Both::new();
        both.start_converter(200);
        both.start_stream(300, RING);
        for scan in 1..30 {
            let at = scan * SCAN_NS;
            both.put(at, scan);
            both.trigger(at);
            let mut when: Vec<u64> = (0..3).map(|_| at + random.random_range(0..SCAN_NS)).collect();
            when.sort_unstable();
            for at in when {
                match random.random_range(0..20) {
                    0 => both.write(at, DMA2_S0CR, S0CR & !1),
                    1 | 2 => both.start_stream(at, RING),
                    3 => both.start_stream(at, NOWHERE),
                    4 => both.write(at, ADC1_CR2, CR2 & !1),
                    5 | 6 => both.write(at, ADC1_CR2, CR2),
                    7 => both.write(at, ADC1_CR2, CR2 & !(1 << 8)),
                    8 | 9 => both.write(at, ADC1_SR, 0),
                    10 => {
                        let [quick, rigless] = both.0.each_mut().map(|bench| bench.read(at, ADC1_DR));
                        assert_eq!(quick, rigless, "the data register at {at} ns, seed {seed}");
                    }
                    11 => both.write(at, DMA2_LIFCR, 0x3D),
                    12 => {
                        both.write(at, RCC_APB2RSTR, 1 << 8);
                        both.write(at, RCC_APB2RSTR, 0);
                        both.start_converter(at);
                    }
                    13 => {
                        both.write(at, RCC_AHB1RSTR, 1 << 22);
                        both.write(at, RCC_AHB1RSTR, 0);
                    }
                    14 => both.put(at, scan + 1_000),
                    _ => {}
                }
                both.agree(at);
            }
        }
        both.agree(31 * SCAN_NS);
    }
}

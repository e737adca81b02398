//! A timer that nobody watches: it counts only when it is asked.
//!
//! TIM3's updates start scans, and `rigless` would stop the core at each for nothing: the board looks at the pulses at its
//! own stops. So the model, `rigless`'s own, lives on a bus of its own, whose events stop nobody; it catches up on them
//! whenever a register or the pulses are looked at.

use rigless::device::{Device, DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::mcu::{Operate, Single};
use rigless::soc::stm32f427::builder;
use rigless::soc::stm32f427::generated::tim2::{Register, cr1};
use rigless::soc::stm32f427::peripherals::TIMERS;
use rigless::soc::stm32f427::peripherals::tim::{General, Tim};
use rigless::soc::{Error, RegisterSpec, Width};
use rigless::time::{EventId, VirtualNanos};

/// The chip's clock out of reset, Hz.
const RESET_CLOCK_HZ: u64 = 16_000_000;
const NS_PER_S: u64 = 1_000_000_000;
/// CR2 of a timer whose TRGO is its update (RM0383, section 13.4.2).
const MMS_UPDATE: u64 = 0b010 << 4;
/// What would make it do more than count from update to update.
const AT_REST: [Register; 9] = [
    Register::Smcr,
    Register::Dier,
    Register::Ccmr1Output,
    Register::Ccmr2Output,
    Register::Ccer,
    Register::Ccr1,
    Register::Ccr2,
    Register::Ccr3,
    Register::Ccr4,
];

/// One of the chip's general timers.
#[derive(Debug)]
pub struct UnwatchedTimer {
    own: Single<Tim<General>>,
    nth: usize,
    base: u64,
    clock_hz: u64,
    known: Option<Pulses>,
}

/// Pulses that come at a fixed pace as long as nobody touches the timer.
#[derive(Clone, Copy, Debug)]
struct Pulses {
    sent: u64,
    next: VirtualNanos,
    period_ns: u64,
}

impl UnwatchedTimer {
    /// The `nth` of the chip's general timers, out of reset.
    pub fn new(nth: usize) -> Result<Self, Error> {
        let timer = &TIMERS[nth];
        let own = Single::new(builder(), timer.instance, Tim::with_clock(RESET_CLOCK_HZ, timer.counter))?;
        let base = rigless::mcu::Mcu::bus(&own).peripheral(timer.instance).map_or(0, |found| found.base);
        Ok(Self { own, nth, base, clock_hz: RESET_CLOCK_HZ, known: None })
    }

    /// As a reset of the chip leaves it.
    pub fn restarted(&mut self) {
        *self = Self::new(self.nth).expect("a timer that was built once is built again");
    }

    /// How many pulses it has sent on its TRGO by now.
    pub fn trigger_pulses(&mut self, now: VirtualNanos) -> u64 {
        if let Some(known) = self.known {
            let since_next = now.0.checked_sub(known.next.0);
            return known.sent + since_next.map_or(0, |since| since / known.period_ns + 1);
        }
        self.own.advance_to(now);
        let sent = self.own.model.trigger_output().1;
        // Before the first one, the prescaler may not be in force yet.
        let paced = if sent > 0 { self.pace(now) } else { None };
        self.known = paced.map(|(next, period_ns)| Pulses { sent, next, period_ns });
        sent
    }

    /// How long ago the last of them was, ns; 0 while their pace is not known.
    pub fn since_pulse_ns(&self, now: VirtualNanos) -> u64 {
        self.known.map_or(0, |known| (now.0 + known.period_ns).saturating_sub(known.next.0) % known.period_ns)
    }

    /// When the next pulse comes and how long after it each other, ns. None if that is not a whole number, or if it does
    /// anything but count up from update to update.
    fn pace(&mut self, now: VirtualNanos) -> Option<(VirtualNanos, u64)> {
        let (_, registers) = self.own.pair();
        let counts_up =
            registers.get(Register::Cr1) & !(cr1::URS.mask() | cr1::ARPE.mask()) == cr1::CEN.mask();
        let plain = counts_up && registers.get(Register::Cr2) == MMS_UPDATE;
        let plain = plain && AT_REST.into_iter().all(|register| registers.get(register) == 0);
        let prescale = registers.get(Register::Psc) + 1;
        let (cycles, hz) = (prescale * (registers.get(Register::Arr) + 1), self.clock_hz);
        if !plain || hz == 0 || !(cycles * NS_PER_S).is_multiple_of(hz) {
            return None;
        }
        let (next, period_ns) = (self.own.next_event()?, cycles * NS_PER_S / hz);
        // What it asks to be woken at is the update if its counter stands where it does on the way there.
        let since_ns = (now.0 + period_ns).checked_sub(next.0)?;
        let counter = self.address(Register::Cnt as usize);
        let count = self.own.peek(now, counter, Width::W32).ok()?;
        (count == since_ns * hz / NS_PER_S / prescale).then_some((next, period_ns))
    }

    /// Somebody is about to touch it.
    fn catch_up(&mut self, now: VirtualNanos) {
        self.known = None;
        self.own.advance_to(now);
    }

    fn address(&self, row: usize) -> u64 {
        self.base + u64::from(ErasedDevice::layout(&self.own.model)[row].offset)
    }

    /// What it would raise, nobody would hear.
    fn is_silent(&mut self) -> bool {
        self.own.drain_clocks().is_empty()
            && self.own.drain_requests().is_empty()
            && self.own.drain_interrupts().is_empty()
    }
}

impl ErasedDevice for UnwatchedTimer {
    fn layout(&self) -> &'static [RegisterSpec] {
        ErasedDevice::layout(&self.own.model)
    }

    fn read(
        &mut self,
        row: usize,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        let (now, address) = (context.now(), self.address(row));
        self.catch_up(now);
        self.own.read(now, address, Width::W32).ok()
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        _registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        let (now, address) = (context.now(), self.address(row));
        self.catch_up(now);
        let written = self.own.write(now, address, Width::W32, value);
        debug_assert!(written.is_ok(), "{address:#x} is a register of the timer");
        assert!(self.is_silent(), "the scan's timer drives its TRGO and nothing else");
    }

    fn on_clock(&mut self, hz: u64, _registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        let now = context.now();
        self.catch_up(now);
        self.clock_hz = hz;
        self.own.drive(now, |timer, registers, context| Device::on_clock(timer, hz, registers, context));
    }

    fn reset(&mut self) {
        self.known = None;
        self.own.reset_every_model();
    }

    fn on_event(&mut self, _: EventId, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_access(&mut self, _: u64, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_refused(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}
}

#[cfg(test)]
mod tests {
    use rigless::emulator::{Error, Memory};
    use rigless::mcu::Operate;
    use rigless::soc::Width;
    use rigless::time::VirtualNanos;

    use crate::board_model::Models;
    use crate::board_model::line::Line;
    use crate::board_model::part::Part;

    const RCC_APB1RSTR: u64 = 0x4002_3820;
    const RCC_APB1ENR: u64 = 0x4002_3840;
    const RCC_CFGR: u64 = 0x4002_3808;
    const TIM3_CR1: u64 = 0x4000_0400;
    const TIM3_CR2: u64 = 0x4000_0404;
    const TIM3_SR: u64 = 0x4000_0410;
    const TIM3_EGR: u64 = 0x4000_0414;
    const TIM3_CNT: u64 = 0x4000_0424;
    const TIM3_PSC: u64 = 0x4000_0428;
    const TIM3_ARR: u64 = 0x4000_042C;

    struct NoMemory;

    impl Memory for NoMemory {
        fn read(&mut self, address: u64, width: Width) -> Result<u64, Error> {
            Err(Error::Memory { address, width })
        }

        fn write(&mut self, address: u64, width: Width, _value: u64) -> Result<(), Error> {
            Err(Error::Memory { address, width })
        }
    }

    /// Set up as the image does, looked at every 700 ns, halted, sped up, slowed down by its clock, reset and begun again.
    #[test]
    fn it_sends_the_pulses_that_a_watched_one_sends() {
        let steps: &[(u64, &[(u64, u64)])] = &[
            (1_000, &[(RCC_APB1ENR, 2), (TIM3_PSC, 0), (TIM3_ARR, 1_999), (TIM3_CR1, 4), (TIM3_EGR, 1)]),
            (2_000, &[(TIM3_CR1, 0), (TIM3_CR2, 0x20), (TIM3_CR1, 1)]),
            (900_300, &[(TIM3_CR1, 0)]),
            (1_000_100, &[(TIM3_CR1, 1)]),
            (2_000_000, &[(TIM3_ARR, 2_999)]),
            (3_000_050, &[(TIM3_PSC, 6)]),
            (5_000_000, &[(RCC_CFGR, 0x1400)]),
            (8_000_000, &[(TIM3_EGR, 1), (TIM3_CNT, 17), (TIM3_SR, 0)]),
            (9_000_000, &[(RCC_APB1RSTR, 2), (RCC_APB1RSTR, 0)]),
            (9_100_000, &[(TIM3_ARR, 999), (TIM3_CR2, 0x20), (TIM3_CR1, 1)]),
        ];
        let mut parts = [Models::Quick, Models::Rigless]
            .map(|models| Part::new(models, Line::default()).expect("the chip"));
        let (mut steps, mut most) = (steps.iter().peekable(), 0);
        for now in (0..12_000_000).step_by(700) {
            let step = steps.next_if(|(at, _)| *at <= now);
            let [quick, rigless] = parts.each_mut().map(|part| {
                while let Some(next) = part.next_event().filter(|next| next.0 <= now) {
                    part.advance_to(next);
                }
                for &(address, value) in step.into_iter().flat_map(|(_, writes)| *writes) {
                    part.write(VirtualNanos(now), address, Width::W32, value).expect("a register");
                    part.settle(&mut NoMemory).expect("no memory is needed");
                }
                let look = |part: &mut Part, address| part.read(VirtualNanos(now), address, Width::W32).ok();
                let seen = if now.is_multiple_of(77_000) {
                    [look(part, TIM3_CNT), look(part, TIM3_SR), look(part, TIM3_ARR)]
                } else {
                    [None; 3]
                };
                (part.trigger_pulses(VirtualNanos(now)), seen)
            });
            assert_eq!(quick, rigless, "at {now} ns");
            most = most.max(quick.0);
        }
        assert!(most >= 20, "{most} pulses");
    }
}

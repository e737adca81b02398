//! The scan's own clock, and the one deadline on it: what waits for the converter waits until then at the longest.
//! It is a compare register of TIM2, which counts microseconds in 32 bits: a new deadline is one store, far less than in the time
//! driver's queue, and an old one needs no taking back.
//! Its handler runs at the scan's priority (1). Owns TIM2. Never wakes but what waits for the scan, and telemetry's beat.

use core::future::poll_fn;
use core::task::Poll;

use embassy_stm32::Peri;
use embassy_stm32::interrupt::typelevel::{self, Handler, Interrupt};
use embassy_stm32::pac;
use embassy_stm32::peripherals::TIM2;
use embassy_stm32::rcc;
use embassy_sync::waitqueue::AtomicWaker;

use crate::mail;
use crate::timing::{BEAT_US, CORE_HZ};

/// The clock, us. It wraps after 71 minutes.
pub fn clock_us() -> u32 {
    pac::TIM2.cnt().read()
}

pub static SCAN_WAKER: AtomicWaker = AtomicWaker::new();

/// An instant, us; they wrap after 71 minutes, so two of them are compared only if they are less than half of that apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Micros(u32);

impl Micros {
    pub const fn after(self, us: u32) -> Self {
        Self(self.0.wrapping_add(us))
    }

    pub const fn before(self, us: u32) -> Self {
        Self(self.0.wrapping_sub(us))
    }

    pub const fn since(self, earlier: Self) -> u32 {
        self.0.wrapping_sub(earlier.0)
    }

    pub const fn is_after(self, other: Self) -> bool {
        self.0.wrapping_sub(other.0) as i32 > 0
    }
}

pub struct Deadline {
    _timer: Peri<'static, TIM2>,
}

impl Deadline {
    pub fn new(timer: Peri<'static, TIM2>) -> Self {
        rcc::enable_and_reset::<TIM2>();
        pac::TIM2.arr().write_value(u32::MAX);
        pac::TIM2.psc().write_value((CORE_HZ / 1_000_000 - 1) as u16);
        // The update takes the prescaler up.
        pac::TIM2.egr().write(|w| w.set_ug(true));
        pac::TIM2.cr1().write(|w| w.set_cen(true));
        pac::TIM2.ccr(BEAT).write_value(BEAT_US);
        pac::TIM2.sr().write(|w| w.0 = 0);
        pac::TIM2.dier().write(|w| {
            w.set_ccie(0, true);
            w.set_ccie(BEAT, true);
        });
        // SAFETY: the handler is bound in `main`, and nothing is in a critical section yet.
        unsafe { typelevel::TIM2::enable() };
        Self { _timer: timer }
    }

    pub fn now(&self) -> Micros {
        Micros(clock_us())
    }

    /// Waits until `ready` gives something, or until after `at`: then None. Ready is asked once more at the end. Not an `async fn`: one
    /// that has an end can be asked again after it, which is a way to panic.
    pub fn until<T>(
        &self,
        at: Micros,
        mut ready: impl FnMut() -> Option<T>,
    ) -> impl Future<Output = Option<T>> {
        // Not `at` itself: at the interrupt it has to be over.
        pac::TIM2.ccr(0).write_value(at.after(1).0);
        poll_fn(move |context| {
            SCAN_WAKER.register(context.waker());
            let over = self.now().is_after(at);
            match ready() {
                Some(ready) => Poll::Ready(Some(ready)),
                None if over => Poll::Ready(None),
                None => Poll::Pending,
            }
        })
    }
}

/// TIM2's interrupt: the deadline is over.
pub struct OnDeadline;

impl Handler<typelevel::TIM2> for OnDeadline {
    unsafe fn on_interrupt() {
        let seen = pac::TIM2.sr().read();
        // Those that were seen are cleared, by writing 0.
        pac::TIM2.sr().write(|w| w.0 = !seen.0);
        SCAN_WAKER.wake();
        if seen.ccif(BEAT) {
            let (now, due) = (clock_us(), pac::TIM2.ccr(BEAT).read().wrapping_add(BEAT_US));
            // An erase stalls the core for longer: one that is over would come after 71 minutes.
            let is_over = Micros(now).is_after(Micros(due));
            pac::TIM2.ccr(BEAT).write_value(if is_over { now.wrapping_add(BEAT_US) } else { due });
            mail::counters_due();
        }
    }
}

/// The compare register of what telemetry does ten times a second.
const BEAT: usize = 2;

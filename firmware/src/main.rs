//! The image of the fingertip's microcontroller (STM32F411RE).
//! Tasks move data; what it means is decided in `tenax-logic`. [`interrupts`] has every priority, [`timing`] every time; each file's head
//! says where it runs and at which priority, what it owns and what it never does.
//!
//! Control never waits for the others: what it hands over goes into a bounded box ([`mail`]) or is dropped. If it stops,
//! the watchdog, which only it feeds, resets the chip after 0.1 s and the bridge is off from that instant. Before its first tick it is 8 s.
#![no_std]
#![no_main]

mod black_box;
mod board;
mod bridge;
mod clock;
mod control;
mod counts;
mod deadline;
mod flash;
mod halves;
mod interrupts;
mod last_words;
mod log;
mod mail;
mod scan;
mod serial;
mod store;
mod supply;
mod timing;

use core::panic::PanicInfo;
use core::ptr::addr_of;

use cortex_m::peripheral::SCB;
use embassy_executor::{InterruptExecutor, SpawnError, SpawnToken, Spawner};
use embassy_stm32::flash::Flash;
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{bind_interrupts, interrupt};
use static_cell::{ConstStaticCell, StaticCell};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::MotorBridge;
use tenax_hal_shim::wire::{Identity, ResetCause, Up};
use tenax_hal_shim::words::Fault;
use tenax_logic::rescue::{self, Rescue};
use tenax_logic::restart::{Mark, Start};
use tenax_logic::store::Erase;

use crate::board::{Button, Switches, Vibrator};
use crate::bridge::Bridge;
use crate::deadline::Deadline;
use crate::timing::{CONTROL_US, START_US, SUPPLY_LOOK_US};

bind_interrupts!(struct Irqs {
    DMA2_STREAM0 => halves::OnHalf;
    TIM2 => deadline::OnDeadline;
});

/// Runs control, above the thread executor. I2C3 itself is not used.
static CONTROL_EXECUTOR: InterruptExecutor = InterruptExecutor::new();

#[interrupt]
unsafe fn I2C3_ER() {
    // SAFETY: this is that interrupt, and it is enabled by `start` only.
    unsafe { CONTROL_EXECUTOR.on_interrupt() }
}

static SCAN_RING: ConstStaticCell<[u32; halves::RING_LEN]> = ConstStaticCell::new([0; halves::RING_LEN]);

/// Control's state, built in place and never moved: a move by value is a copy of 9 kB on the stack.
static CONTROL: StaticCell<control::Control> = StaticCell::new();

/// Not inlined: the task would keep a copy on its stack.
#[inline(never)]
fn made(new: impl FnOnce() -> control::Control) -> &'static mut control::Control {
    CONTROL.init_with(new)
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    // SAFETY: taken once more below, when this one is given up.
    let mut watchdog = IndependentWatchdog::new(unsafe { IWDG::steal() }, START_US);
    watchdog.unleash();
    let mut p = embassy_stm32::init(clock::slow());
    interrupts::set_priorities();
    // Before anything is waited for: until then the pins float.
    bridge::hold_low();
    last_words::guard_stack();
    let supplied = supply::has_risen();
    let Start { after, cause, stay_off, .. } = last_words::start();
    let switched_on = cause == ResetCause::PowerOn;
    let browned_out = cause == ResetCause::Other && after.is_some();
    if browned_out {
        black_box::why(b"brown-out");
    }
    black_box::start(after, switched_on);
    // Where the brown-out reset does not hold the chip below 2.83 V, the supply may be too low for 100 MHz.
    while !supply::has_brown_out_reset() && !supply::has_risen() {
        watchdog.pet();
    }
    let crystal = clock::start(switched_on || browned_out, &mut p.RCC);
    // Before anything that could take time: from here on both sides are held low.
    let bridge = Bridge::new(p.TIM1, p.PA8, p.PA11);
    let deadline = Deadline::new(p.TIM2);
    let (up, down) = serial::open(p.USART2, (p.PA3, p.PA2), (p.DMA1_CH5, p.DMA1_CH6));
    // The first of all messages: a hello that comes after others would look like a second start.
    let after = if supplied { after } else { after.or(Some(Fault::SupplySagged)) };
    mail::post(Up::Hello { frame_hz: FRAME_HZ as u16, after });
    spawner.spawn(once(serial::telemetry(up)));
    // Nothing moves, and nothing is programmed, before the supply can drive a motor.
    while supply::is_low() {
        deadline.until(deadline.now().after(SUPPLY_LOOK_US), || None::<()>).await;
        watchdog.pet();
    }
    supply::watch();
    // While nothing moves yet: switched on, this may erase a sector, and then the core stands still for seconds. After
    // a reset something may be held, and the wearer must be able to let go of it.
    watchdog.pet();
    let mut flash = flash::Flash(Flash::new_blocking(p.FLASH));
    let erase = if switched_on { Erase::Allowed } else { Erase::Postponed };
    let (log, found) = tenax_logic::store::open(&mut flash, erase);

    let switches = Switches::new([p.PB12.into(), p.PB13.into(), p.PB14.into(), p.PB15.into()]);
    let button = Button::new(p.PC13, p.PC6, p.PC8);
    let vibrator = Vibrator::new(p.TIM4, p.PB6);
    let watchdog = IndependentWatchdog::new(p.IWDG, CONTROL_US);
    if stay_off {
        // No control, for it may be what failed: the button opens.
        wait_for_button(&deadline, bridge, &button, watchdog).await
    }
    spawner.spawn(once(serial::commands(down)));
    let port_a = (p.PA0, p.PA1, p.PA4, p.PA5, p.PA6, p.PA7);
    let pins = (port_a, (p.PB0, p.PB1), (p.PC0, p.PC1, p.PC2, p.PC3, p.PC4, p.PC5));
    let scan = scan::Scan::new(p.ADC1, p.TIM3, p.DMA2_CH0, SCAN_RING.take(), deadline, pins);

    let control = made(|| control::Control::new((bridge, vibrator), switches, button, watchdog));
    let device = &mut control.device;
    store::restore(device, &flash, &found);
    if !switched_on {
        device.fingertip.was_reset();
    }
    if !crystal {
        device.fingertip.report(Fault::CrystalLost);
    }
    if !supply::has_brown_out_reset() {
        device.fingertip.report(Fault::BrownOutLevel);
    }
    mail::post(device.start(identity(cause)));
    if device.fingertip.config().stream_at_start {
        store::restored(&flash, &found, mail::post);
    }
    spawner.spawn(once(store::store(flash, log)));
    let urgent = CONTROL_EXECUTOR.start(interrupt::I2C3_ER);
    urgent.spawn(once(control::control(scan, control)));
}

/// The mode after too many restarts: the button opens the hand, nothing else moves it.
async fn wait_for_button(
    deadline: &Deadline,
    mut bridge: Bridge,
    button: &Button,
    mut watchdog: IndependentWatchdog<'static, IWDG>,
) -> ! {
    let mut rescue = Rescue::default();
    let mut next = deadline.now();
    loop {
        bridge.drive(rescue.step(button.is_down()));
        watchdog.pet();
        next = next.after(rescue::STEP_US);
        deadline.until(next, || None::<()>).await;
    }
}

#[repr(C)]
struct Note {
    /// The lengths of its owner's name and of itself, its kind, the name `GNU`.
    header: [u32; 4],
    build: [u8; 8],
}

unsafe extern "C" {
    static __build_id: Note;
}

fn identity(reset: ResetCause) -> Identity {
    // SAFETY: the note is in flash, is longer than this, and nobody writes it.
    let Note { header: _, build } = unsafe { addr_of!(__build_id).read() };
    let chip = embassy_stm32::uid::uid();
    let word = |n: usize| u32::from_le_bytes([chip[n], chip[n + 1], chip[n + 2], chip[n + 3]]);
    Identity { build: u64::from_be_bytes(build), chip: [word(0), word(4), word(8)], reset }
}

/// A task that is started here and nowhere else.
fn once<S>(task: Result<SpawnToken<S>, SpawnError>) -> SpawnToken<S> {
    task.expect("each task is started once")
}

/// Its message is left out: core's formatting would take 6 kB of flash.
#[panic_handler]
fn on_panic(info: &PanicInfo) -> ! {
    last_words::leave(Mark::Panicked, "");
    if let Some(place) = info.location() {
        // The end of a path says most.
        let path = place.file().as_bytes();
        let from = path.iter().rposition(|&byte| byte == b'/').map_or(0, |at| at + 1);
        black_box::why(path.get(from..).unwrap_or(path));
        black_box::why(b":");
        black_box::why_decimal(place.line());
    }
    SCB::sys_reset()
}

# Printed from wire.json by `python -m tenax.stubs`; do not edit.
from typing import List, Literal, Optional, Tuple, Union

class Tick:
    vibration: int
    o1: float
    o2: float
    drive: float
    source: Literal["nobody", "wearer", "link", "reflex", "behaviour"]
    said: int
    believed: int
    acted: int

class Frame:
    films: List[int]
    switch_a: int
    switch_b: int
    valid: bool

class MotorDrive_Coast:
    kind: Literal['Coast']

class MotorDrive_Close:
    kind: Literal['Close']
    duty: int

class MotorDrive_Open:
    kind: Literal['Open']
    duty: int

MotorDrive = Union[MotorDrive_Coast, MotorDrive_Close, MotorDrive_Open]

class Setting:
    id: int
    value: int

class Behaviour_Stroke:
    kind: Literal['Stroke']

class Behaviour_GentleGrasp:
    kind: Literal['GentleGrasp']

class Behaviour_Hold:
    kind: Literal['Hold']

class Behaviour_HandOver:
    kind: Literal['HandOver']

class Behaviour_Turn:
    kind: Literal['Turn']
    by_ddeg: int

Behaviour = Union[Behaviour_Stroke, Behaviour_GentleGrasp, Behaviour_Hold, Behaviour_HandOver, Behaviour_Turn]

Code = Literal['Minus', 'Zero', 'Plus']

class CameraView:
    age_ms: int
    moving_e4: int
    angle_ddeg: Optional[int]
    normal: List[int]
    shear: List[int]

class Down_Ping:
    kind: Literal['Ping']
    sequence: int

class Down_Drive:
    kind: Literal['Drive']
    sequence: int
    drive: MotorDrive
    hold_ms: int

class Down_Set:
    kind: Literal['Set']
    sequence: int
    id: int
    value: int

class Down_Begin:
    kind: Literal['Begin']
    sequence: int
    behaviour: Behaviour

class Down_Zero:
    kind: Literal['Zero']
    sequence: int

class Down_Samples:
    kind: Literal['Samples']
    sequence: int

class Down_Teach:
    kind: Literal['Teach']
    sequence: int
    codes: List[Code]
    age_ms: int

class Down_Network:
    kind: Literal['Network']
    sequence: int

class Down_Forget:
    kind: Literal['Forget']
    sequence: int

class Down_Save:
    kind: Literal['Save']
    sequence: int

class Down_Get:
    kind: Literal['Get']
    sequence: int
    value: int

class Down_Settings:
    kind: Literal['Settings']
    sequence: int
    value: int

class Down_Hello:
    kind: Literal['Hello']
    sequence: int

class Down_Open:
    kind: Literal['Open']
    sequence: int
    nonce: int

class Down_CalibrateEmg:
    kind: Literal['CalibrateEmg']
    sequence: int

class Down_About:
    kind: Literal['About']
    sequence: int

class Down_Stream:
    kind: Literal['Stream']
    sequence: int
    raw: bool
    senses: bool
    hold_s: int

class Down_End:
    kind: Literal['End']
    sequence: int

class Down_View:
    kind: Literal['View']
    sequence: int
    age_ms: int
    moving_e4: int
    angle_ddeg: Optional[int]
    normal: List[int]
    shear: List[int]

class Down_Last:
    kind: Literal['Last']
    sequence: int
    value: int

class Down_SetOf:
    kind: Literal['SetOf']
    sequence: int
    of: int
    n: int
    count: int
    setting: Setting

Down = Union[Down_Ping, Down_Drive, Down_Set, Down_Begin, Down_Zero, Down_Samples, Down_Teach, Down_Network, Down_Forget, Down_Save, Down_Get, Down_Settings, Down_Hello, Down_Open, Down_CalibrateEmg, Down_About, Down_Stream, Down_End, Down_View, Down_Last, Down_SetOf]

Reason = Literal['Dead', 'Saturated', 'Stuck', 'Noisy', 'NoContact', 'Hum', 'Creep', 'Flat', 'Endless']

Capability = Literal['Vibration', 'Force', 'WearerIntent']

Kept = Literal['Network', 'Zero', 'Settings', 'Emg']

class Fault_SensorLost:
    kind: Literal['SensorLost']
    channel: int
    reason: Reason

class Fault_SensorBack:
    kind: Literal['SensorBack']
    channel: int

class Fault_CapabilityLost:
    kind: Literal['CapabilityLost']
    capability: Capability

class Fault_CapabilityBack:
    kind: Literal['CapabilityBack']
    capability: Capability

class Fault_FramesLost:
    kind: Literal['FramesLost']
    count: int

class Fault_WatchdogReset:
    kind: Literal['WatchdogReset']

class Fault_PanicReset:
    kind: Literal['PanicReset']

class Fault_PressedAtBoot:
    kind: Literal['PressedAtBoot']
    channel: int

class Fault_RecordDamaged:
    kind: Literal['RecordDamaged']
    kept: Kept

class Fault_StoreFull:
    kind: Literal['StoreFull']
    kept: Kept

class Fault_StoreFailed:
    kind: Literal['StoreFailed']
    kept: Kept

class Fault_SupplySagged:
    kind: Literal['SupplySagged']

class Fault_CrystalLost:
    kind: Literal['CrystalLost']

class Fault_TooManyRestarts:
    kind: Literal['TooManyRestarts']

class Fault_NeverUnloaded:
    kind: Literal['NeverUnloaded']

class Fault_BrownOutLevel:
    kind: Literal['BrownOutLevel']

Fault = Union[Fault_SensorLost, Fault_SensorBack, Fault_CapabilityLost, Fault_CapabilityBack, Fault_FramesLost, Fault_WatchdogReset, Fault_PanicReset, Fault_PressedAtBoot, Fault_RecordDamaged, Fault_StoreFull, Fault_StoreFailed, Fault_SupplySagged, Fault_CrystalLost, Fault_TooManyRestarts, Fault_NeverUnloaded, Fault_BrownOutLevel]

GripMode = Literal['Standby', 'Wearer', 'Watch', 'Slip', 'Incipient', 'Settle']

class Forces:
    fn_mn: int
    load_mn: int
    fx_mn: int
    fy_mn: int
    ft_mn: int
    ratio_permille: Optional[int]

DetectorId = Literal['S1', 'S2', 'Hebbian', 'Mlp', 'Injected', 'Photoelastic']

Direction = Literal['Unknown', 'Down', 'Up']

DetectorHealth = Literal['Starting', 'Working', 'Blind']

class Evidence:
    slip: bool
    incipient: bool
    confidence_permille: int
    direction: Direction
    decided_at: int
    health: DetectorHealth
    raw: int

class Line_Reading:
    kind: Literal['Reading']

class Line_Armed:
    kind: Literal['Armed']
    left_s: int

class Line_Trusted:
    kind: Literal['Trusted']

Line = Union[Line_Reading, Line_Armed, Line_Trusted]

class Slow:
    frame: int
    ticks: List[Tick]
    mode: GripMode
    forces: Optional[Forces]
    shear_mrad: Optional[int]
    s2_permille: int
    flexor_mv: Optional[int]
    extensor_mv: Optional[int]
    wearer_active: bool
    lesson: Optional[List[Code]]
    evidence: List[Tuple[DetectorId, Evidence]]
    samples_sum: int
    line: Line
    behaviour: Optional[Behaviour]

class Cause_SensorsReady:
    kind: Literal['SensorsReady']

class Cause_SensorsLost:
    kind: Literal['SensorsLost']

class Cause_TakenOver:
    kind: Literal['TakenOver']

class Cause_Released:
    kind: Literal['Released']

class Cause_Slip:
    kind: Literal['Slip']
    detector_id: DetectorId

class Cause_Incipient:
    kind: Literal['Incipient']
    detector_id: DetectorId

class Cause_PulseOver:
    kind: Literal['PulseOver']

class Cause_Settled:
    kind: Literal['Settled']

Cause = Union[Cause_SensorsReady, Cause_SensorsLost, Cause_TakenOver, Cause_Released, Cause_Slip, Cause_Incipient, Cause_PulseOver, Cause_Settled]

Consent = Literal['PowerUp', 'Muscles', 'Button']

Prompt = Literal['Rest', 'Close', 'Open']

CalibrationRefusal = Literal['RestNotQuiet', 'NoClosing', 'NoOpening', 'SameDirection', 'Overlap', 'NotAMuscle', 'Saturated', 'SensorLost', 'Damaged', 'Loaded', 'Stopped']

Fit = Literal['Fits', 'Moved', 'Exchanged']

class Calibration_Asks:
    kind: Literal['Asks']
    prompt: Prompt

class Calibration_Done:
    kind: Literal['Done']
    separation_permille: int

class Calibration_Refused:
    kind: Literal['Refused']
    calibration_refusal: CalibrationRefusal

class Calibration_Fit:
    kind: Literal['Fit']
    fit: Fit

Calibration = Union[Calibration_Asks, Calibration_Done, Calibration_Refused, Calibration_Fit]

Ending = Literal['Done', 'Stopped', 'TakenOver', 'SensorLost', 'TooLong', 'Ceiling', 'Dropped', 'NoSlip', 'NotArmed']

MotorStop = Literal['ClosingStalled', 'OpeningStalled', 'Hot', 'BridgeOff']

class EventKind_Mode:
    kind: Literal['Mode']
    from_: GripMode
    to: GripMode
    cause: Cause

class EventKind_Fault:
    kind: Literal['Fault']
    fault: Fault

class EventKind_Stroke:
    kind: Literal['Stroke']
    mu_s_permille: int
    s2_permille: int

class EventKind_EventsLost:
    kind: Literal['EventsLost']
    value: int

class EventKind_Armed:
    kind: Literal['Armed']
    consent: Consent

class EventKind_Disarmed:
    kind: Literal['Disarmed']

class EventKind_LineTrusted:
    kind: Literal['LineTrusted']
    value: bool

class EventKind_Calibration:
    kind: Literal['Calibration']
    calibration: Calibration

class EventKind_NoWearer:
    kind: Literal['NoWearer']
    value: bool

class EventKind_Behaviour:
    kind: Literal['Behaviour']
    behaviour: Behaviour
    ending: Optional[Ending]

class EventKind_Motor:
    kind: Literal['Motor']
    motor_stop: Optional[MotorStop]

class EventKind_Pulse:
    kind: Literal['Pulse']
    margin_mn: Optional[int]
    said: int
    believed: int

EventKind = Union[EventKind_Mode, EventKind_Fault, EventKind_Stroke, EventKind_EventsLost, EventKind_Armed, EventKind_Disarmed, EventKind_LineTrusted, EventKind_Calibration, EventKind_NoWearer, EventKind_Behaviour, EventKind_Motor, EventKind_Pulse]

class Event:
    frame: int
    kind_: EventKind

class Counters:
    frames: int
    frames_lost: int
    overruns: int
    ticks: int
    ticks_late: int
    telemetry_dropped: int
    bad_frames: int
    commands_skipped: int
    control_us_max: int
    control_permille: int

class Refusal_OutOfRange:
    kind: Literal['OutOfRange']
    min: int
    max: int

class Refusal_Loaded:
    kind: Literal['Loaded']

class Refusal_SensorLost:
    kind: Literal['SensorLost']

class Refusal_WearerActive:
    kind: Literal['WearerActive']

class Refusal_UnknownSetting:
    kind: Literal['UnknownSetting']

class Refusal_NotArmed:
    kind: Literal['NotArmed']

class Refusal_NoSession:
    kind: Literal['NoSession']

class Refusal_Replayed:
    kind: Literal['Replayed']

class Refusal_HeldTooLong:
    kind: Literal['HeldTooLong']

class Refusal_Incomplete:
    kind: Literal['Incomplete']

Refusal = Union[Refusal_OutOfRange, Refusal_Loaded, Refusal_SensorLost, Refusal_WearerActive, Refusal_UnknownSetting, Refusal_NotArmed, Refusal_NoSession, Refusal_Replayed, Refusal_HeldTooLong, Refusal_Incomplete]

NoLesson = Literal['Absent', 'Late', 'Contradicting', 'NothingMoves', 'NoGrasp', 'Disturbed']

class NetworkState:
    frame: int
    weights: List[List[int]]
    activations: List[int]
    updates: int
    teacher_age_ms: Optional[int]
    no_lesson: Optional[NoLesson]

ResetCause = Literal['PowerOn', 'Pin', 'Software', 'Panic', 'Watchdog', 'Other']

class Identity:
    build: int
    chip: List[int]
    reset: ResetCause

class About:
    identity: Identity
    schema: int
    frames: int
    settings: List[Setting]

class Last:
    after: Optional[Fault]
    why: List[int]
    length: int
    from_: int
    bytes: List[int]

class Answer_Done:
    kind: Literal['Done']

class Answer_Refused:
    kind: Literal['Refused']
    refusal: Refusal

class Answer_Setting:
    kind: Literal['Setting']
    id: int
    value: int

class Answer_Settings:
    kind: Literal['Settings']
    value: List[Setting]

class Answer_Samples:
    kind: Literal['Samples']
    value: List[int]

class Answer_Network:
    kind: Literal['Network']
    frame: int
    weights: List[List[int]]
    activations: List[int]
    updates: int
    teacher_age_ms: Optional[int]
    no_lesson: Optional[NoLesson]

class Answer_Nonce:
    kind: Literal['Nonce']
    value: int

class Answer_About:
    kind: Literal['About']
    identity: Identity
    schema: int
    frames: int
    settings: List[Setting]

class Answer_Last:
    kind: Literal['Last']
    after: Optional[Fault]
    why: List[int]
    length: int
    from_: int
    bytes: List[int]

Answer = Union[Answer_Done, Answer_Refused, Answer_Setting, Answer_Settings, Answer_Samples, Answer_Network, Answer_Nonce, Answer_About, Answer_Last]

class Restored:
    kept: Kept
    payload: List[int]

class Raw:
    first: int
    frames: List[Frame]

class Senses:
    frame: int
    samples: List[int]
    films: List[int]

class Up_Hello:
    kind: Literal['Hello']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frame_hz: int
    after: Optional[Fault]

class Up_Slow:
    kind: Literal['Slow']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frame: int
    ticks: List[Tick]
    mode: GripMode
    forces: Optional[Forces]
    shear_mrad: Optional[int]
    s2_permille: int
    flexor_mv: Optional[int]
    extensor_mv: Optional[int]
    wearer_active: bool
    lesson: Optional[List[Code]]
    evidence: List[Tuple[DetectorId, Evidence]]
    samples_sum: int
    line: Line
    behaviour: Optional[Behaviour]

class Up_Event:
    kind: Literal['Event']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frame: int
    kind_: EventKind

class Up_Counters:
    kind: Literal['Counters']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frames: int
    frames_lost: int
    overruns: int
    ticks: int
    ticks_late: int
    telemetry_dropped: int
    bad_frames: int
    commands_skipped: int
    control_us_max: int
    control_permille: int

class Up_Answer:
    kind: Literal['Answer']
    sequence: int
    time_s: float
    host_s: Optional[float]
    of: int
    frame: int
    answer: Answer

class Up_Saved:
    kind: Literal['Saved']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frame: int
    kept: Kept

class Up_About:
    kind: Literal['About']
    sequence: int
    time_s: float
    host_s: Optional[float]
    identity: Identity
    schema: int
    frames: int
    settings: List[Setting]

class Up_Restored:
    kind: Literal['Restored']
    sequence: int
    time_s: float
    host_s: Optional[float]
    kept: Kept
    payload: List[int]

class Up_Raw:
    kind: Literal['Raw']
    sequence: int
    time_s: float
    host_s: Optional[float]
    first: int
    frames: List[Frame]

class Up_Senses:
    kind: Literal['Senses']
    sequence: int
    time_s: float
    host_s: Optional[float]
    frame: int
    samples: List[int]
    films: List[int]

class Up_Taken:
    kind: Literal['Taken']
    sequence: int
    time_s: float
    host_s: Optional[float]
    before: int
    of: int
    command: Down

Up = Union[Up_Hello, Up_Slow, Up_Event, Up_Counters, Up_Answer, Up_Saved, Up_About, Up_Restored, Up_Raw, Up_Senses, Up_Taken]

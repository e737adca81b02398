// The machine of scene and logic, away from the page's thread. Requests come as [number, request] and are answered by number; while a source
// runs, its changes are posted as they come.
let module = null, machine = null, source = "", playing = false, pace = 1, last = 0, left = 0, clock = 0;
const encoder = new TextEncoder(), decoder = new TextDecoder();
const FRAME_HZ = 2000, SLOW = 25, STEP = 200, WORK_MS = 12, EVERY_MS = 16, BEHIND_S = 0.25;

function bytes(data) {
  const at = machine.reserve(data.length);
  new Uint8Array(machine.memory.buffer, at, data.length).set(data);
}
const answer = length => JSON.parse(decoder.decode(new Uint8Array(machine.memory.buffer, machine.answer(), length)));
function ask(request) {
  bytes(encoder.encode(JSON.stringify(request)));
  return answer(machine.ask());
}
function load(data, kind) {
  bytes(data);
  return answer(machine.load(kind));
}

// As much of the scene as has become due; at most what fits between two pictures.
function bench(now) {
  if (!playing) return;
  left = pace ? Math.min(left + (now - last) / 1e3 * FRAME_HZ * pace, BEHIND_S * FRAME_HZ * pace) : Infinity;
  const until = performance.now() + WORK_MS;
  while (left >= SLOW && performance.now() < until) {
    const frames = Math.min(STEP, Math.floor(left / SLOW) * SLOW);
    left -= frames;
    const told = ask({ do: "go on", frames });
    playing = !told.scene.over;
    postMessage(told);
    if (!playing) return;
  }
}
// A machine that has stopped in the middle of something is replaced.
async function anew(error) {
  [source, playing] = ["", false];
  machine = (await WebAssembly.instantiate(module, {})).exports;
  return { error: `${error.message}: start again` };
}
async function tick() {
  const now = performance.now();
  try {
    if (source === "bench") bench(now);
    else if (source) postMessage(ask({ do: "go on", now_s: now / 1e3 }));
  } catch (error) { postMessage(await anew(error)); }
  last = now;
}

const requests = {
  open(request) {
    const told = ask({ ...request, do: "bench" });
    if (!told.error) [source, left, last] = ["bench", 0, performance.now()];
    return told;
  },
  play(request) { [playing, pace, last] = [request.playing, request.pace, performance.now()]; return {}; },
  board() { source = "board"; return ask({ do: "board", now_s: performance.now() / 1e3 }); },
  file(request) {
    const told = load(new Uint8Array(request.data), request.mcap ? 1 : 0);
    if (!told.error) source = "file";
    return told;
  },
  up(request) { return load(request.data, 2); },
  recorded(request) {
    bytes(encoder.encode(JSON.stringify(request)));
    const length = machine.ask();
    return { data: new Uint8Array(machine.memory.buffer, machine.answer(), length).slice() };
  },
  close() { source = ""; return {}; },
};
onmessage = async ({ data: [number, request] }) => {
  if (request.do === "start") {
    try {
      const started = await WebAssembly.instantiateStreaming(fetch(new URL("tenax.wasm", import.meta.url)), {});
      [module, machine] = [started.module, started.instance.exports];
      clearInterval(clock);
      clock = setInterval(tick, EVERY_MS);
      postMessage([number, {}]);
    } catch (error) { postMessage([number, { error: String(error) }]); }
    return;
  }
  const own = requests[request.do];
  try { postMessage([number, own ? own(request) : ask(request)]); } catch (error) { postMessage([number, await anew(error)]); }
};

// Where messages come from: the bench, a board or a recording in the worker's machine, or the server of `cargo tenax monitor`. Each has
// post(path), settings() and backup(), and gives its changes to `take`.

class Machine {
  #worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  #asked = new Map();
  #number = 0;
  constructor(take) {
    this.#worker.onmessage = ({ data }) => {
      if (!Array.isArray(data)) return take(data);
      const [number, told] = data, [resolve, reject] = this.#asked.get(number);
      this.#asked.delete(number);
      told.error ? reject(new Error(told.error)) : resolve(told);
    };
    this.#worker.onerror = event => take({ error: event.message || "the worker failed" });
  }
  ask(request, moved = []) {
    const number = ++this.#number;
    return new Promise((resolve, reject) => {
      this.#asked.set(number, [resolve, reject]);
      this.#worker.postMessage([number, request], moved);
    });
  }
}

let machine = null;
// The machine, started once; whoever uses it last hears from it.
let listener = () => {};
async function started(take) {
  listener = take;
  if (!machine) {
    machine = new Machine(told => listener(told));
    await machine.ask({ do: "start" });
  }
  return machine;
}

class Source {
  constructor(take) { this.take = take; }
  async begin(request, moved) {
    this.machine = await started(this.take);
    const told = await this.machine.ask(request, moved);
    this.take(told);
    return told;
  }
  post(path) { return this.machine.ask({ do: "post", path }); }
  async settings() { return this.machine.ask({ do: "settings" }); }
  async backup() { return (await this.machine.ask({ do: "backup", now_ms: Date.now() })).text; }
  close() {}
}

export class Bench extends Source {
  async scenes() { return (await started(this.take)).ask({ do: "scenes" }); }
  open(setup) { return this.begin({ ...setup, do: "open" }); }
  play(playing, pace) { return this.machine.ask({ do: "play", playing, pace }); }
}

export class Recording extends Source {
  async open(file) {
    const data = await file.arrayBuffer();
    return this.begin({ do: "file", data, mcap: /\.mcap$/i.test(file.name) }, [data]);
  }
  close() { this.machine?.ask({ do: "close" }); }
}

// A board on a serial port. What comes up goes into the machine; what the machine answers goes down.
export class Board extends Source {
  #port = null;
  #reader = null;
  #writer = null;
  recording = false;
  static get possible() { return "serial" in navigator; }
  async open() {
    this.#port = await navigator.serial.requestPort();
    await this.#port.open({ baudRate: 921600, bufferSize: 65536 });
    this.#writer = this.#port.writable.getWriter();
    const take = this.take, gone = why => take({ changes: [{ gone: String(why) }] });
    this.take = told => {
      take(told);
      if (told.send?.length) this.#writer?.write(new Uint8Array(told.send)).catch(gone);
    };
    await this.begin({ do: "board" });
    this.#read().then(() => gone("the board is unplugged"), gone);
  }
  async #read() {
    this.#reader = this.#port.readable.getReader();
    for (;;) {
      const { value, done } = await this.#reader.read();
      if (done) return;
      await this.machine.ask({ do: "up", data: value });
    }
  }
  async record() {
    await this.machine.ask({ do: "record", now_ms: Date.now() });
    this.recording = true;
  }
  // The recording (MCAP): Foxglove, PlotJuggler, `cargo tenax play` and this page read it.
  async stop() {
    this.recording = false;
    return new Blob([(await this.machine.ask({ do: "recorded" })).data]);
  }
  async close() {
    this.machine?.ask({ do: "close" });
    await this.#reader?.cancel().catch(() => {});
    this.#reader?.releaseLock();
    this.#writer?.releaseLock();
    this.#writer = null;
    await this.#port?.close().catch(() => {});
    this.#port = null;
  }
}

// The server of `cargo tenax monitor` has a line, a recording, or a served scene.
export class Monitor {
  constructor(take) {
    const events = new EventSource("events");
    // A new connection begins with the whole state.
    events.onopen = () => take({ anew: true });
    events.onmessage = message => take({ changes: JSON.parse(message.data) });
    events.onerror = () => take({ changes: [{ gone: "the tool is gone" }] });
  }
  async post(path) {
    const answer = await fetch(path.slice(1), { method: "POST" });
    return { status: answer.status, text: await answer.text() };
  }
  async settings() { return (await fetch("settings")).json(); }
  async backup() { return (await fetch("settings.toml")).text(); }
  close() {}
}

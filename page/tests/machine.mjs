// The page's machine under node: the decisions of every shipped scene are the host's, bit for bit, and the bench is as fast as it has to be.
// node page/tests/machine.mjs FOLDER, the folder of `cargo tenax page --out FOLDER`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const folder = process.argv[2], root = new URL("../../", import.meta.url);
const { instance } = await WebAssembly.instantiate(readFileSync(`${folder}/tenax.wasm`), {});
const machine = instance.exports, encoder = new TextEncoder(), decoder = new TextDecoder();
function put(bytes) {
  const at = machine.reserve(bytes.length);
  new Uint8Array(machine.memory.buffer, at, bytes.length).set(bytes);
}
const got = length => new Uint8Array(machine.memory.buffer, machine.answer(), length).slice();
function ask(request) {
  put(encoder.encode(JSON.stringify(request)));
  return JSON.parse(decoder.decode(got(machine.ask())));
}

// Golden hashes.
const lines = readFileSync(new URL("sim/tests/golden.txt", root), "utf8").split("\n").filter(line => line.startsWith("scene "));
const names = new Set(ask({ do: "scenes" }).map(([name]) => name));
let virtual_s = 0;
for (const line of lines) {
  const [, scene, seed, hash] = line.split(" ");
  assert.equal(ask({ do: "held", scene, seed: Number(seed) }).hash, hash, `${scene} ${seed} decides otherwise than on the host`);
  names.delete(scene);
}
names.delete("bench");
assert.equal(names.size, 0, `without a golden hash: ${[...names]}`);
console.log(`${lines.length} scenes decide as on the host`);

// The speed of a whole scene, with everything that the page is told.
let begun = performance.now();
let told = ask({ do: "bench", scene: "glass", seed: 1, settings: {}, beside: "" });
while (!told.scene.over) { told = ask({ do: "go on", frames: 200 }); virtual_s = told.scene.now_s; }
const speed = virtual_s * 1e3 / (performance.now() - begun);
console.log(`glass: ${speed.toFixed(0)} times real time`);
assert.ok(speed >= 10);
assert.equal(told.scene.hand.dropped, false);

// A person at the bench, and a control on the same seed.
told = ask({ do: "bench", scene: "bench", seed: 3, settings: { "s1-mv": 90 }, beside: "off" });
const events = [];
const go_on = seconds => { for (let n = 0; n < seconds * 10; n++) { told = ask({ do: "go on", frames: 200 }); for (const change of told.changes) events.push(...change.log || []); } };
const act = path => assert.equal(ask({ do: "post", path }).status, 202, path);
const value = name => ask({ do: "settings" }).settings.find(own => own.name === name).value;
go_on(1);
assert.equal(value("s1-mv"), 90);
act("/bench/g");
go_on(6);
assert.equal(told.scene.hand.carried, true);
act("/set/s1-mv/120");
go_on(3);
assert.equal(value("s1-mv"), 120);
assert.ok(events.some(line => line.includes("Armed(Button)")), "consent comes before a setting");
const before = told.scene.hand.mass_kg;
for (const key of ["h", "w"]) act(`/bench/${key}`);
go_on(3);
assert.ok(told.scene.hand.mass_kg > before + 0.09);
assert.ok(told.scene.beside.dropped && !told.scene.hand.dropped, "the reflex keeps what a passive hand loses");
for (const key of ["f", "e"]) act(`/bench/${key}`);
go_on(4);
assert.ok(events.some(line => /fault: pvdf_1/.test(line)) && events.some(line => /fault: myo_flexor/.test(line)), events.join("\n"));
assert.ok(ask({ do: "bench", scene: "nowhere" }).error.includes("nowhere"));

// A recording, compressed and not, and what is none.
const file = process.argv[3];
if (file) {
  put(readFileSync(file));
  assert.deepEqual(JSON.parse(decoder.decode(got(machine.load(1)))), {});
  let played = { changes: [] };
  for (let clock = 1; clock < 4; clock += 0.5) played = ask({ do: "go on", now_s: clock });
  assert.ok(played.changes.some(change => change.points), "the recording plays");
}
put(new Uint8Array([1, 2, 3]));
assert.match(JSON.parse(decoder.decode(got(machine.load(0)))).error, /no board's line/);

// Everything beside the traces: detectors, score, log, self-test, settings.
export const at = id => document.getElementById(id);
const text = (id, words) => { if (at(id).textContent !== words) at(id).textContent = words; };

export function append(id, lines) {
  for (const line of lines) { const div = document.createElement("div"); div.textContent = line; at(id).append(div); }
  while (at(id).childElementCount > 400) at(id).firstChild.remove();
  if (lines.length) at(id).scrollTop = at(id).scrollHeight;
}

function row(table, cells, tag = "td") {
  const tr = document.createElement("tr");
  for (const [words, kind] of cells) { const td = document.createElement(tr.childElementCount ? tag : "th"); td.textContent = words; td.className = kind || ""; tr.append(td); }
  table.append(tr);
}

// Just now for half a second, forgotten after five.
const recent = (now, frame) => frame === null || now - frame > 10000 ? null : now - frame < 1000 ? "now" : "past";

export function state(last, fates, points, arrivals) {
  text("place", last.place || ""); text("mode", last.mode || "-"); text("time", `${(last.t_s || 0).toFixed(1)} s`);
  text("line", last.line ? `line: ${last.line}` : "");
  text("gone", last.other_version ? `a board ${last.other_version}` : last.gone ? `no line: ${last.gone}` : "");
  text("why", last.why || "Nothing has closed yet.");
  const table = at("detectors");
  table.replaceChildren();
  for (const [name, , , , own] of last.detectors || []) {
    const health = !own ? "-" : own.health !== "Working" ? own.health : own.slip ? "slip" : own.incipient ? "warns" : "quiet";
    const fate = ["said", "believed", "acted"].map((word, n) => { const kind = recent(last.frame, (fates.get(name) || [])[n] ?? null); return [kind ? word : "", kind]; });
    row(table, [[name], [health], [own ? `${(own.confidence_permille / 10).toFixed(0)} %` : ""], ...fate]);
  }
  if (last.sensors && at("sensors").closest("details").open) at("sensors").replaceChildren(...last.sensors.map(([name, mv]) => {
    const both = document.createElement("span"), words = document.createElement("span");
    words.textContent = name; both.append(words, `${mv} mV`); return both;
  }));
  const mv = v => v === null || v === undefined ? "lost" : `${v} mV`, [flexor, extensor] = (points[points.length - 1] || []).slice(5, 7);
  text("muscles", `flexor ${mv(flexor)}, extensor ${mv(extensor)}: ${last.wearer_active ? "ACTIVE, the reflex is silent" : "at rest"}`);
  const [first, newest] = [arrivals[0], arrivals[arrivals.length - 1]], lasted = newest ? newest[0] - first[0] : 0, c = last.counters;
  const rate = lasted > 0.5 ? `${((newest[1] - first[1]) / lasted).toFixed(0)} frames/s, ${((arrivals.length - 1) / lasted).toFixed(1)} slow frames/s` : "no rate yet";
  text("counters", `${rate}; missed ${last.missed || 0}, bad ${last.bad_frames || 0}` + (c ? `; board: lost ${c.frames_lost}, dropped ${c.telemetry_dropped}, late ${c.ticks_late}; control ${(c.control_permille / 10).toFixed(1)} %, worst frame ${c.control_us_max} us` : ""));
  text("faults", (last.faults || []).join(", "));
}

const fate = hand => hand.broken ? "broken" : hand.dropped ? "lost" : hand.crushed ? "dented" : hand.carried ? "kept" : "not lifted yet";
const n = (value, unit) => value === null ? "-" : `${value.toFixed(1)} ${unit}`;
export function score(scene, name_beside) {
  const table = at("score");
  table.hidden = !scene;
  if (!scene) return;
  const hands = [scene.hand, scene.beside].filter(own => own);
  table.replaceChildren(table.caption);
  row(table, [[""], ["with the reflex"], ...(scene.beside ? [[name_beside]] : [])], "th");
  const rows = [
    ...(scene.first.width_mm ? [["the object is", fate]] : []), ["it slid", own => n(own.slipped_mm, "mm")], ["slips", own => String(own.slips)],
    ["highest force", own => n(own.peak_n, "N")], ["force beyond need, mean", own => n(own.beyond_n, "N")],
  ];
  for (const [name, of] of rows) row(table, [[name], ...hands.map(own => [of(own), of === fate && ["lost", "broken", "dented"].includes(of(own)) ? "bad" : ""])]);
}

let offered = "";
export function keys(all, control, post) {
  const offer = JSON.stringify([all, control]);
  if (offer === offered) return;
  offered = offer;
  at("keys").replaceChildren(...(all || []).map(([act, what]) => {
    const button = document.createElement("button"), key = act === "button" ? "Enter" : act.length === 1 ? act : "";
    if (key) { const kbd = document.createElement("kbd"); kbd.textContent = key; button.append(kbd); }
    button.append(what); button.dataset.key = key; button.disabled = !control;
    button.onclick = () => post("/bench/" + act.replaceAll(" ", "/"));
    return button;
  }));
}

// Self-test.
let tested = [];
export function selftest(test, can_touch) {
  const goes_on = test && !test.over && !test.failed, level = goes_on && test.level;
  at("test").hidden = at("test-stop").hidden = !test;
  at("test-skip").hidden = !level;
  at("test-touch").hidden = !level || !can_touch;
  if (!test) { tested = []; return; }
  if (test.lines.length < tested.length) tested = [];
  if (!tested.length) { at("lines").replaceChildren(); text("verdict", ""); }
  const fresh = test.lines.slice(tested.length);
  tested = test.lines;
  append("lines", fresh);
  text("prompt", test.failed || (test.over ? test.lines[test.lines.length - 1] : test.prompt));
  at("prompt").className = test.failed || (test.over && !test.passes) ? "bad" : test.over ? "good" : "";
  at("level").hidden = at("verdict").hidden = !goes_on;
  at("level").value = level ? level.moved_mv / level.needed_mv : 0;
  text("levels", level ? `${level.mv.toFixed(0)} mV; moved by ${level.moved_mv.toFixed(0)} mV, a touch is ${level.needed_mv.toFixed(0)} mV` : "");
  for (const line of fresh.filter(line => line.startsWith("   "))) { text("verdict", line.trim()); at("verdict").className = line.includes("FAIL") ? "bad" : "good"; }
  at("results").replaceChildren(...test.results.map(([name, input, passes, words]) => {
    const span = document.createElement("span");
    span.textContent = (passes === null ? "\u00b7 " : passes ? "\u2713 " : "\u2717 ") + name; span.title = `${input}: ${words || "not tested"}`;
    span.className = passes === null ? "past" : passes ? "good" : "bad"; return span;
  }));
}

// Settings, with the difference to a file and undo.
export class Settings {
  values = {};
  control = false;
  #against = {};
  #undone = [];
  #source = null;
  #changed = () => {};
  constructor(changed) {
    this.#changed = changed;
    at("against").onchange = async () => {
      const file = await at("against").files[0].text();
      this.#against = Object.fromEntries([...file.matchAll(/^\s*([a-z0-9-]+)\s*=\s*(-?\d+)/gm)].map(([, name, value]) => [name, Number(value)]));
      this.refresh();
    };
    at("as-file").onclick = async () => {
      for (const [name, value] of Object.entries(this.#against)) if (this.values[name] !== undefined && this.values[name] !== value) await this.set(name, value);
    };
    at("shown").onchange = () => this.refresh();
    at("undo").onclick = () => { const [name, value] = this.#undone.pop(); this.set(name, value, false); };
    at("backup").onclick = async () => save(new Blob([await this.#source.backup() || ""], { type: "application/toml" }), "settings.toml");
    setInterval(() => this.refresh(), 2000);
  }
  of(source) {
    [this.#source, this.#undone, this.values, this.control] = [source, [], {}, false];
    at("undo").disabled = true;
    return this.refresh();
  }
  async set(name, value, undoable = true) {
    const before = this.values[name];
    value = Math.round(value);
    const answer = await this.#source?.post(`/set/${name}/${value}`);
    if (!answer) return;
    text("refused", answer.status < 300 ? "" : answer.text);
    if (undoable && before !== undefined && before !== null) this.#undone.push([name, before]);
    at("undo").disabled = !this.#undone.length;
    this.#changed(name, value);
    setTimeout(() => this.refresh(), 900);
  }
  async refresh() {
    const source = this.#source, told = await source?.settings().catch(() => null);
    if (!told?.settings || source !== this.#source) return;
    this.control = told.control;
    this.values = Object.fromEntries(told.settings.map(s => [s.name, s.value]));
    text("readonly", told.control ? "A board changes a setting with consent only: press its button before. The bench's hand presses it by itself." : "Read only: start with --control.");
    at("undo").hidden = !told.control;
    const differs = s => this.#against[s.name] !== undefined && this.#against[s.name] !== s.value;
    at("as-file").hidden = !told.control || !told.settings.some(differs);
    const table = at("settings").firstElementChild, which = at("shown").value;
    if (!at("settings-box").open || table.contains(document.activeElement)) return;
    table.replaceChildren(...told.settings.filter(s => !which || (which === "file" ? differs(s) : s.value !== s.default)).map(s => this.#row(s, differs(s))));
  }
  #row(s, differs) {
    const tr = document.createElement("tr"), name = tr.insertCell(), input = document.createElement("input"), range = tr.insertCell(), meaning = document.createElement("div");
    name.textContent = s.name; name.className = s.value === s.default ? "" : "changed";
    Object.assign(input, { type: "number", value: s.value ?? "", min: s.min, max: s.max, disabled: !this.control });
    input.setAttribute("aria-label", s.name);
    input.onchange = () => this.set(s.name, input.value).then(() => input.blur());
    const cell = document.createElement("td");
    cell.append(input); cell.className = differs ? "differs" : ""; range.before(cell);
    meaning.textContent = s.meaning;
    range.append(`${s.unit}, ${s.min} to ${s.max}, default ${s.default}` + (differs ? `, file ${this.#against[s.name]}` : ""), meaning);
    return tr;
  }
}

export function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

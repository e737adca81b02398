// The page: one source at a time, its state, and the pictures made from it.
import { Bench, Board, Monitor, Recording } from "./sources.js";
import { append, at, keys, save, score, selftest, Settings, state } from "./panels.js";
import * as plots from "./plots.js";
import * as stage from "./stage.js";

const { traces } = plots;
const served = document.documentElement.hasAttribute("data-monitor");
const calm = matchMedia("(prefers-reduced-motion: reduce)");
// The state of the board, merged from its changes; when each detector said, was believed and acted on; slow frames that came.
let last = {}, fates = new Map(), arrivals = [], scene = null, source = null, kind = "", playing = false, still = false, dirty = true, colours = plots.recolour();
const setup = { scene: "glass", seed: 1, beside: "none", newtons: "", pace: 1, settings: {} };
const NAMES = { off: "reflex off", constant: "constant grip" };
const PACES = [[0.1, "1/10"], [0.25, "1/4"], [0.5, "1/2"], [1, "real time"], [2, "2 x"], [5, "5 x"], [10, "10 x"], [0, "fastest"]];
const settings = new Settings((name, value) => { if (kind === "bench") { setup.settings[name] = value; link(); } });

// The place of the page holds scene, seed and settings.
function link() {
  const own = { scene: setup.scene, seed: setup.seed, ...(setup.beside !== "none" && { beside: setup.beside }), ...(setup.newtons && { newtons: setup.newtons }), ...(setup.pace !== 1 && { pace: setup.pace }), ...setup.settings };
  history.replaceState(null, "", "#" + new URLSearchParams(own));
}
function from_link() {
  const own = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  for (const [name, value] of Object.entries(own)) {
    if (name === "scene" || name === "beside" || name === "newtons") setup[name] = value;
    else if (name === "seed" || name === "pace") setup[name] = Number(value) || 0;
    else if (Number.isInteger(Number(value))) setup.settings[name] = Number(value);
  }
}

function forget() {
  [last, fates, arrivals, scene] = [{}, new Map(), [], null];
  traces.points.length = traces.truths.length = traces.beside.length = 0;
  at("log").replaceChildren();
  for (const id of ["refused", "title"]) at(id).textContent = "";
  selftest(null);
}

function take(told) {
  dirty = true;
  if (told.error) at("refused").textContent = told.error;
  if (told.anew) forget();
  for (const change of told.changes || []) merge(change);
  if (told.scene) {
    for (const [hand, all] of [[told.scene.hand, traces.truths], [told.scene.beside, traces.beside]]) {
      if (!hand) continue;
      all.push(...hand.trace);
      hand.now = hand.trace[hand.trace.length - 1] ?? scene?.[hand === told.scene.hand ? "hand" : "beside"]?.now;
    }
    // The object as it was at first: what is poured in or wet shows against it.
    told.scene.first = scene?.first ?? { ...told.scene.hand };
    scene = told.scene;
    if (scene.over && playing) play(false);
  }
  plots.drop_old();
}

function merge(change) {
  Object.assign(last, change);
  const { points } = traces;
  if (change.restarted || change.gone) { fates.clear(); arrivals.length = 0; }
  if (change.restarted || change.points && points.length && change.t_s < points[points.length - 1][0]) points.length = 0;
  if (change.points) points.push(...change.points);
  if (change.points?.length === 1) {
    arrivals.push([performance.now() / 1e3, change.frame]);
    while (arrivals[arrivals.length - 1][0] - arrivals[0][0] > 2) arrivals.shift();
  }
  for (const [name, ...flags] of change.detectors || []) {
    const before = fates.get(name) || [null, null, null];
    fates.set(name, before.map((frame, n) => flags[n] ? change.frame : frame));
  }
  append("log", change.log || []);
  if ("selftest" in change) selftest(change.selftest, last.bench && can());
  if (change.playing) player(change.playing);
}

const can = () => settings.control && kind !== "file";
const post = async path => { if (!source) return; const answer = await source.post(path); at("refused").textContent = answer.status < 300 ? "" : answer.text; dirty = true; };

// Pictures: as often as the screen is drawn anew, words ten times a second; all twice a second where the system asks for no motion.
let drawn = 0, read = 0, unread = false, pictures = 0;
function picture(now) {
  requestAnimationFrame(picture);
  if (!(dirty || unread) || still || (calm.matches && now - drawn < 500)) return;
  const beside = NAMES[setup.beside];
  if (dirty) {
    [dirty, drawn] = [false, now];
    document.body.dataset.pictures = ++pictures;
    stage.draw(at("stage"), scene, colours, beside);
    plots.draw(last, can());
  }
  unread = now - read < 100;
  if (unread) return;
  read = now;
  state(last, fates, traces.points, arrivals);
  score(scene, beside);
  keys(last.bench, can(), post);
  if (scene) { at("done").value = scene.now_s / scene.of_s; at("stage").setAttribute("aria-label", `fingers ${scene.hand.opening_mm.toFixed(0)} mm apart, object at ${scene.hand.object_mm.toFixed(0)} mm, to scale`); }
}

// Sources.
function show(name) {
  kind = name;
  const bars = { "bench-bar": "bench", "board-bar": "board", "player-bar": "file" };
  for (const [id, own] of Object.entries(bars)) at(id).hidden = name !== own;
  for (const [id, own] of [["to-bench", "bench"], ["to-board", "board"], ["to-file", "file"]]) at(id).setAttribute("aria-pressed", String(name === own));
  at("stage").hidden = at("done").hidden = name !== "bench";
  at("keys").hidden = name !== "bench";
  at("selftest-box").hidden = name === "file";
}
// One change of the source after the other.
let turn = Promise.resolve();
const change = (name, begin) => { turn = turn.then(() => changed(name, begin)); return turn; };
async function changed(name, begin) {
  try {
    if (kind === "bench" && playing) await play(false);
    source?.close();
    for (const id of ["keep", "zero", "calibrate", "test-start"]) at(id).disabled = true;
    forget();
    show(name);
    await begin();
    for (const id of ["zero", "calibrate", "test-start"]) at(id).disabled = !source;
    await settings.of(source);
  } catch (error) {
    if (error.name !== "NotFoundError") at("refused").textContent = error.message;
  }
  dirty = true;
}

async function open_bench() {
  source = new Bench(take);
  if (!at("scene").options.length) {
    const all = await source.scenes();
    at("scene").replaceChildren(...all.map(([name, title, length_s]) => { const option = new Option(name, name); option.title = `${title}, ${length_s} s`; return option; }));
  }
  const titles = Object.fromEntries([...at("scene").options].map(option => [option.value, option.title]));
  if (!titles[setup.scene]) setup.scene = "glass";
  [at("scene").value, at("seed").value, at("beside").value, at("newtons").value, at("pace").value] = [setup.scene, setup.seed, setup.beside, setup.newtons, setup.pace];
  at("newtons-label").hidden = setup.beside !== "constant";
  at("title").textContent = titles[setup.scene];
  const beside = setup.beside === "constant" ? `constant ${setup.newtons}` : setup.beside;
  await source.open({ scene: setup.scene, seed: setup.seed, beside, settings: setup.settings });
  link();
}
const bench = begins => change("bench", async () => { await open_bench(); if (begins) await play(true); });
async function play(on) {
  playing = on;
  at("play").textContent = on ? "pause" : "play";
  await source.play(on, setup.pace);
}

const file = chosen => change("file", () => { source = new Recording(take); at("place").textContent = chosen.name; return source.open(chosen); });
function player(now) {
  if (kind !== "file") { show("file"); }
  at("seek").max = now.of_s; at("stopped").textContent = now.paused ? "play" : "pause"; at("loop").checked = now.repeat;
  at("played").textContent = `${now.at_s.toFixed(1)} of ${now.of_s.toFixed(1)} s`;
  if (document.activeElement !== at("seek")) at("seek").value = now.at_s;
  if (document.activeElement !== at("player-pace")) at("player-pace").value = now.speed;
}

function wire() {
  plots.build(at("plots"), (name, value) => settings.set(name, value));
  at("pace").replaceChildren(...PACES.map(([pace, words]) => new Option(words, pace)));
  at("player-pace").replaceChildren(...[0.1, 0.25, 0.5, 1, 2, 4, 10, 50].map(pace => new Option(`${pace} x`, pace)));
  for (const id of ["scene", "seed", "beside", "newtons"]) at(id).onchange = () => {
    const value = at(id).value;
    setup[id] = id === "seed" ? Math.max(0, Math.trunc(Number(value))) : value;
    bench(!calm.matches);
  };
  at("pace").onchange = () => { setup.pace = Number(at("pace").value); link(); play(playing); };
  at("play").onclick = () => scene?.over ? bench(true) : play(!playing);
  at("restart").onclick = () => bench(true);
  at("share").onclick = async () => { await navigator.clipboard?.writeText(location.href).catch(() => {}); at("share").textContent = "copied"; setTimeout(() => { at("share").textContent = "copy link"; }, 1500); };
  at("to-bench").onclick = () => bench(!calm.matches);
  at("to-board").onclick = () => { change("board", async () => { source = null; }); at("board-note").textContent = Board.possible ? "The board's messages stay in this page." : "This browser has no Web Serial: use Chromium, Chrome or Edge, or `cargo tenax monitor`."; at("connect").disabled = !Board.possible; };
  at("connect").onclick = () => change("board", async () => { source = new Board(take); await source.open(); at("keep").disabled = false; });
  at("keep").onclick = async () => {
    if (source.recording) save(await source.stop(), `tenax-${new Date().toISOString().slice(0, 19).replace(/[-:]/g, "")}Z.mcap`);
    else await source.record();
    at("keep").textContent = source.recording ? "save the recording" : "record";
  };
  at("zero").onclick = () => post("/zero");
  at("calibrate").onclick = () => post("/calibrate");
  at("to-file").onclick = () => at("file").click();
  at("file").onchange = () => at("file").files[0] && file(at("file").files[0]);
  if (!served) document.ondragover = event => { event.preventDefault(); document.body.classList.add("dragging"); };
  document.ondragleave = event => { if (!event.relatedTarget) document.body.classList.remove("dragging"); };
  if (!served) document.ondrop = event => { event.preventDefault(); document.body.classList.remove("dragging"); if (event.dataTransfer.files[0]) file(event.dataTransfer.files[0]); };
  at("stopped").onclick = () => post("/play/pause");
  at("loop").onchange = () => post("/play/loop");
  at("seek").onchange = () => { post("/play/" + at("seek").value); at("seek").blur(); };
  at("player-pace").onchange = () => { post("/play/x" + at("player-pace").value); at("player-pace").blur(); };
  at("still").onclick = () => { still = !still; dirty = true; at("still").textContent = still ? "go on" : "pause traces"; };
  at("test-start").onclick = () => post(["/selftest/start", ...at("test-of").value.split(/\s+/).filter(word => word)].join("/"));
  at("test-skip").onclick = () => post("/selftest/skip");
  at("test-stop").onclick = () => post("/selftest/stop");
  at("test-touch").onclick = () => post("/bench/" + at("prompt").textContent.split(" ").slice(0, 2).join("/").replace(/[,:]/g, ""));
  at("settings-box").ontoggle = () => settings.refresh();
  document.onkeydown = event => {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT|BUTTON|SUMMARY/.test(event.target.tagName)) return;
    const button = event.key === " " ? at("play") : event.key === "r" ? at("restart") : [...at("keys").children].find(own => own.dataset.key === event.key);
    if (button?.offsetParent) { event.preventDefault(); button.click(); }
  };
  matchMedia("(prefers-color-scheme: dark)").onchange = () => { colours = plots.recolour(); dirty = true; };
  onresize = () => { dirty = true; };
}

wire();
requestAnimationFrame(picture);
from_link();
if (served) {
  show("monitor");
  for (const id of ["to-bench", "to-board", "to-file"]) at(id).hidden = true;
  source = new Monitor(take);
  settings.of(source);
} else {
  bench(!calm.matches);
  // Once loaded, it works without a network.
  navigator.serviceWorker?.register("offline.js").catch(() => {});
}

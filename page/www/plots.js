// Traces over time, drawn on canvases.
const LEFT = 46, ABOVE = 6, BELOW = 18, KEEP_S = 120;
export const traces = { points: [], truths: [], beside: [], span_s: 10 };

// Time (s), vibration (mV), Ft/Fn, S2, load (N), flexor, extensor (mV), shear (rad), margin (N) come from the board; time, slide (mm/s), need,
// grip and margin (N) from the scene.
const PLOTS = [
  { name: "vibration", title: "vibration", unit: "mV", own: p => p[1], limit: last => last.s1_mv, least: last => 1.3 * (last.s1_mv || 100), limit_name: "S1", setting: "s1-mv", scale: 1, step: 1 },
  { name: "ratio", title: "Ft/Fn", unit: "", own: p => p[2], limit: (_, p) => p?.[3], least: (_, p) => 1.3 * (p ? p[3] : 0.3), limit_name: "S2", setting: "s2-permille", scale: 1000, step: 0.01 },
  { name: "grip", title: "grip of a finger", unit: "N", own: p => p[4], truth: t => t[2] || null, truth_name: "needed", beside: t => t[3], least: () => 2 },
  { name: "margin", title: "margin", unit: "N", own: p => p[8], truth: t => t[4], truth_name: "in truth", least: () => 1, below: true },
  { name: "slide", title: "sliding in truth", unit: "mm/s", truth: t => t[1], truth_name: "this hand", beside: t => t[1], least: () => 5, scene: true },
  { name: "muscles", title: "muscles", unit: "mV", own: p => p[5], other: p => p[6], own_name: "flexor", other_name: "extensor", limit: last => last.emg_on_mv, least: last => 1.3 * (last.emg_on_mv || 160), limit_name: "consent", setting: "emg-on-mv", scale: 1, step: 1 },
];

let colours = {};
export function recolour() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(["own", "other", "truth", "limit", "soft", "rule", "ink", "object", "water", "finger", "paper"].map(name => [name, style.getPropertyValue("--" + name).trim()]));
  return colours;
}

// A canvas in the screen's pixels, cleared; its width and height in CSS pixels.
export function begun(canvas) {
  const ratio = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight, c = canvas.getContext("2d");
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  return [c, width, height];
}

const round = step => { const ten = 10 ** Math.floor(Math.log10(step)); return [1, 2, 5, 10].map(n => n * ten).find(n => n >= step * 0.999); };
const digits = step => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

export function build(box, set) {
  for (const plot of PLOTS) {
    const div = document.createElement("div"), head = document.createElement("div"), title = document.createElement("b");
    div.className = "plot";
    title.textContent = plot.title + (plot.unit ? `, ${plot.unit}` : "");
    plot.now = document.createElement("span");
    plot.now.className = "number";
    head.append(title, plot.now);
    const key = (kind, text) => { const span = document.createElement("span"); span.className = `key ${kind}`; span.textContent = text; head.append(span); return span; };
    if (plot.own) key("own", plot.own_name || "measured");
    if (plot.other) key("other", plot.other_name);
    if (plot.truth) plot.truth_key = key("truth", plot.truth_name);
    if (plot.beside) plot.beside_key = key("other", "beside it");
    plot.canvas = document.createElement("canvas");
    plot.canvas.setAttribute("role", "img");
    plot.canvas.setAttribute("aria-label", `trace of ${plot.title}`);
    if (plot.setting) {
      const label = document.createElement("label");
      plot.field = Object.assign(document.createElement("input"), { type: "number", step: plot.step, min: 0 });
      plot.field.onchange = () => { set(plot.setting, plot.field.value * plot.scale); plot.field.blur(); };
      label.append(`${plot.limit_name} `, plot.field);
      head.append(label);
      drag(plot, set);
    }
    plot.canvas.addEventListener("wheel", event => {
      event.preventDefault();
      traces.span_s = Math.min(KEEP_S, Math.max(0.5, traces.span_s * (event.deltaY > 0 ? 1.25 : 0.8)));
    }, { passive: false });
    div.append(head, plot.canvas);
    plot.box = div;
    box.append(div);
  }
}

function drag(plot, set) {
  const canvas = plot.canvas, near = event => plot.control && plot.shown && Math.abs(plot.y(plot.shown) - event.offsetY) < 10;
  canvas.onpointerdown = event => { if (near(event)) { plot.dragged = plot.shown; canvas.setPointerCapture(event.pointerId); } };
  canvas.onpointermove = event => {
    canvas.style.cursor = plot.dragged !== undefined || near(event) ? "ns-resize" : "";
    if (plot.dragged !== undefined) plot.dragged = Math.max(0, plot.value(event.offsetY));
  };
  canvas.onpointerup = () => {
    if (plot.dragged === undefined) return;
    set(plot.setting, plot.dragged * plot.scale);
    delete plot.dragged;
  };
}

export function drop_old() {
  for (const all of [traces.points, traces.truths, traces.beside]) {
    let first = 0;
    while (first < all.length && all[all.length - 1][0] - all[first][0] > KEEP_S) first++;
    if (first > 200) all.splice(0, first);
  }
}

export function draw(last, control) {
  const { points, truths, beside } = traces;
  const newest = points[points.length - 1], end = Math.max(traces.span_s, newest?.[0] ?? 0, truths[truths.length - 1]?.[0] ?? 0), begin = end - traces.span_s;
  const since = all => { let n = all.length; while (n > 0 && all[n - 1][0] >= begin) n--; return all.slice(Math.max(0, n - 1)); };
  const shown = [since(points), since(truths), since(beside)];
  for (const plot of PLOTS) {
    plot.box.hidden = plot.scene && !truths.length;
    plot.control = control;
    if (plot.truth_key) plot.truth_key.hidden = !truths.length;
    if (plot.beside_key) plot.beside_key.hidden = !beside.length;
    if (!plot.box.hidden) one(plot, last, newest, shown, begin, end);
  }
}

function one(plot, last, newest, [points, truths, beside], begin, end) {
  const [c, width, height] = begun(plot.canvas), deep = height - BELOW - ABOVE;
  const lines = [[plot.beside, beside, "other", [2, 4]], [plot.truth, truths, "truth", [7, 4]], [plot.other, points, "other", [2, 4]], [plot.own, points, "own", []]].filter(([of]) => of);
  let top = plot.least(last, newest), bottom = 0;
  for (const [of, all] of lines) for (const p of all) { const v = of(p); if (v > top) top = v; else if (plot.below && v < bottom) bottom = v; }
  const limit = plot.limit?.(last, newest);
  plot.shown = plot.dragged ?? limit;
  const x = t => LEFT + (t - begin) / (end - begin) * (width - LEFT), y = v => height - BELOW - (v - bottom) / (top - bottom) * deep;
  Object.assign(plot, { y, value: pixel => bottom + (height - BELOW - pixel) / deep * (top - bottom) });
  const tall = round((top - bottom) / 3), long = round((end - begin) / Math.max(2, width / 100));
  c.font = "11px system-ui, sans-serif"; c.lineWidth = 1; c.strokeStyle = colours.rule; c.fillStyle = colours.soft;
  c.beginPath(); c.textAlign = "right"; c.textBaseline = "middle";
  for (let v = Math.ceil(bottom / tall) * tall; v <= top; v += tall) { c.moveTo(LEFT, y(v)); c.lineTo(width, y(v)); c.fillText(v.toFixed(digits(tall)), LEFT - 5, Math.max(7, y(v))); }
  c.textAlign = "center"; c.textBaseline = "alphabetic";
  for (let t = Math.ceil(begin / long) * long; t <= end; t += long) {
    c.moveTo(x(t), ABOVE); c.lineTo(x(t), height - BELOW);
    if (x(t) < width - 16) c.fillText(t.toFixed(digits(long)) + " s", x(t), height - 4);
  }
  c.stroke();
  c.save();
  c.beginPath(); c.rect(LEFT, 0, width - LEFT, height - BELOW + 1); c.clip();
  if (plot.below) { c.strokeStyle = colours.soft; c.beginPath(); c.moveTo(LEFT, y(0)); c.lineTo(width, y(0)); c.stroke(); }
  for (const [of, all, colour, dash] of lines) {
    c.strokeStyle = colours[colour]; c.lineWidth = 1.8; c.setLineDash(dash); c.beginPath();
    let before = -9;
    // Where there is no value there is a gap.
    for (const p of all) { const v = of(p); if (v === null || v === undefined) continue; p[0] - before < 0.3 ? c.lineTo(x(p[0]), y(v)) : c.moveTo(x(p[0]), y(v)); before = p[0]; }
    c.stroke();
  }
  if (plot.shown) {
    c.strokeStyle = colours.limit; c.setLineDash([10, 5]); c.lineWidth = 1.6;
    c.beginPath(); c.moveTo(LEFT, y(plot.shown)); c.lineTo(width, y(plot.shown)); c.stroke();
  }
  c.restore();
  if (plot.field) {
    plot.field.disabled = !plot.control;
    if (document.activeElement !== plot.field) plot.field.value = plot.shown ? Number(plot.shown.toFixed(digits(plot.step))) : "";
  }
  const now = plot.own && newest ? plot.own(newest) : truths.length ? plot.truth?.(truths[truths.length - 1]) : null;
  plot.now.textContent = now === null || now === undefined ? "-" : now.toFixed(top < 3 ? 3 : 1);
}

// The hand, the object and the table, to scale: millimetres of the scene, one scale for both directions.
import { begun } from "./plots.js";

const PAD_MM = 18, FINGER_MM = 14, SHOWN_MM = 190;

export function draw(canvas, scene, colours, name_beside) {
  const [c, width, height] = begun(canvas);
  if (!scene?.hand) return;
  const hands = scene.beside ? [[scene.hand, "with the reflex"], [scene.beside, name_beside]] : [[scene.hand, ""]];
  const wide = width / hands.length;
  hands.forEach(([hand, title], n) => {
    c.save();
    c.beginPath(); c.rect(n * wide, 0, wide, height); c.clip();
    c.translate(n * wide, 0);
    one(c, wide, height, hand, title, colours, scene);
    c.restore();
  });
  if (hands.length > 1) { c.strokeStyle = colours.rule; c.lineWidth = 1; c.beginPath(); c.moveTo(wide, 0); c.lineTo(wide, height); c.stroke(); }
}

function one(c, wide, height, hand, title, colours, scene) {
  const first = scene.first, tall_mm = Math.min(150, Math.max(40, 1.5 * first.width_mm));
  // From the table to over the hand at its highest; words stand in the band below.
  const band = 44, top_mm = 242, scale = Math.min((height - band - 22) / (top_mm + tall_mm / 2), wide / SHOWN_MM), table = height - band;
  const x = mm => wide / 2 + mm * scale, y = mm => table - (mm + tall_mm / 2) * scale;
  c.font = "12px system-ui, sans-serif"; c.textBaseline = "alphabetic";
  if (!hand.width_mm) return probe(c, wide, height, hand, colours, scale);
  // The table, and a ruler of 50 mm.
  c.fillStyle = colours.rule; c.fillRect(0, table, wide, band);
  c.strokeStyle = c.fillStyle = colours.soft; c.lineWidth = 1.5; c.textAlign = "right";
  c.beginPath(); c.moveTo(wide - 8 - 50 * scale, height - 7); c.lineTo(wide - 8, height - 7); c.stroke(); c.fillText("50 mm", wide - 8, height - 12);
  object(c, x, y, scale, hand, first, tall_mm, colours);
  fingers(c, x, y, scale, hand, colours);
  const now = hand.now;
  c.fillStyle = colours.ink; c.textAlign = "left";
  if (now) c.fillText(`grip ${now[3].toFixed(1)} N` + (now[2] > 0 ? `, needs ${now[2].toFixed(1)} N` : ""), 8, table + 18);
  c.fillText(`${(hand.mass_kg * 1e3).toFixed(0)} g` + (hand.mu_s < 0.95 * first.mu_s ? ", wet" : ""), 8, table + 35);
  if (title) { c.font = "600 13px system-ui, sans-serif"; c.fillText(title, 8, 18); }
  const fate = hand.broken ? "BROKEN" : hand.crushed ? "DENTED" : hand.dropped ? "LOST" : now && Math.abs(now[1]) > 1 && now[3] > 0.1 && hand.carried ? "slides" : "";
  if (fate) { c.fillStyle = colours.limit; c.font = "600 14px system-ui, sans-serif"; c.textAlign = "right"; c.fillText(fate, wide - 8, 18); }
}

function object(c, x, y, scale, hand, first, tall_mm, colours) {
  const half = hand.width_mm / 2;
  c.save();
  c.translate(x(0), y(hand.object_mm)); c.rotate(-hand.pitch_rad); c.scale(scale, -scale);
  c.fillStyle = colours.object; c.globalAlpha = 0.55;
  c.fillRect(-half, -tall_mm / 2, 2 * half, tall_mm);
  // Water that was poured in, in a round glass of this width.
  const poured_mm3 = Math.max(0, hand.mass_kg - first.mass_kg) * 1e6, level_mm = Math.min(tall_mm, poured_mm3 / (Math.PI * half * half));
  c.globalAlpha = 0.9; c.fillStyle = colours.water; c.fillRect(-half + 1, -tall_mm / 2, 2 * half - 2, level_mm);
  c.globalAlpha = 1; c.strokeStyle = colours.ink; c.lineWidth = 1.2 / scale; c.strokeRect(-half, -tall_mm / 2, 2 * half, tall_mm);
  if (hand.mu_s < 0.95 * first.mu_s) {
    // Drops on the wall.
    for (const side of [-1, 1]) for (let n = 0; n < 5; n++) { c.beginPath(); c.ellipse(side * (half + 1), -30 + n * 15, 2, 4.5, 0, 0, 7); c.fill(); }
  }
  c.restore();
}

function fingers(c, x, y, scale, hand, colours) {
  const half = hand.opening_mm / 2, force = hand.now?.[3] ?? 0;
  for (const side of [-1, 1]) {
    const inner = x(side * half), outer = x(side * (half + FINGER_MM));
    c.fillStyle = colours.finger;
    c.beginPath(); c.roundRect(Math.min(inner, outer), y(hand.hand_mm + 62), FINGER_MM * scale, (62 + PAD_MM / 2 + 6) * scale, 5 * scale); c.fill();
    c.fillStyle = colours.other;
    c.fillRect(side > 0 ? inner : inner - 3 * scale, y(hand.hand_mm + PAD_MM / 2), 3 * scale, PAD_MM * scale);
    if (force > 0.05) {
      // The force of the finger, 3 mm for a newton.
      const from = x(side * (half + FINGER_MM + 4)), to = x(side * (half + FINGER_MM + 4 + Math.min(45, 3 * force))), at = y(hand.hand_mm);
      c.strokeStyle = colours.own; c.lineWidth = 3; c.beginPath(); c.moveTo(to, at); c.lineTo(from, at); c.moveTo(from + side * 7, at - 5); c.lineTo(from, at); c.lineTo(from + side * 7, at + 5); c.stroke();
    }
  }
  // The palm.
  c.fillStyle = colours.finger;
  c.beginPath(); c.roundRect(x(-50 - FINGER_MM), y(hand.hand_mm + 74), (100 + 2 * FINGER_MM) * scale, 16 * scale, 6 * scale); c.fill();
}

function probe(c, wide, height, hand, colours, scale) {
  const at = wide / 2 + ((hand.object_mm * scale) % (wide * 0.4)), floor = height * 0.7;
  c.fillStyle = colours.rule; c.fillRect(0, floor, wide, height);
  c.fillStyle = colours.finger; c.beginPath(); c.roundRect(at - 9 * scale, floor - 70 * scale, 18 * scale, 70 * scale, 6 * scale); c.fill();
  c.fillStyle = colours.other; c.fillRect(at - 9 * scale, floor - 3 * scale, 18 * scale, 3 * scale);
  c.fillStyle = colours.ink; c.textAlign = "left";
  c.fillText(`a probe strokes a surface: ${hand.object_mm.toFixed(1)} mm, ${(hand.now?.[3] ?? 0).toFixed(1)} N`, 8, 20);
}

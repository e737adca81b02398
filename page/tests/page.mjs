// The page in Chromium: bench, recording, a board through a stand-in of Web Serial, and the server of `tenax monitor`.
// node page/tests/page.mjs FOLDER RECORDING TOOLS; the programs are those in target/release.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { connect } from "node:net";
import { createInterface } from "node:readline";
import { resolve } from "node:path";

const [folder, recording, tools, shots] = process.argv.slice(2);
const { chromium } = createRequire(resolve(tools, "x"))("playwright-core");
const KINDS = { html: "text/html; charset=utf-8", js: "text/javascript", css: "text/css", svg: "image/svg+xml", wasm: "application/wasm" };
const ended = [];

function serve() {
  const server = createServer((request, answer) => {
    const name = request.url === "/" ? "/index.html" : request.url;
    try {
      const file = readFileSync(folder + name);
      answer.writeHead(200, { "Content-Type": KINDS[name.split(".").pop()] }).end(file);
    } catch { answer.writeHead(404).end(); }
  });
  ended.push(() => server.close());
  return new Promise(done => server.listen(0, "127.0.0.1", () => done(`http://127.0.0.1:${server.address().port}/`)));
}

// A program, and the group of the first line of its output that fits the pattern.
function started(program, args, pattern) {
  const child = spawn(`target/release/${program}`, args, { stdio: ["pipe", "pipe", "pipe"] });
  ended.push(() => child.kill());
  return new Promise((done, fail) => {
    for (const stream of [child.stdout, child.stderr]) createInterface(stream).on("line", line => {
      const found = line.match(pattern);
      if (found) done([found[1], child]);
    });
    child.on("exit", code => fail(new Error(`${program} ended: ${code}`)));
  });
}

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
ended.push(() => browser.close());
const url = await serve();

// A page that may say nothing on its console and ask no other address.
async function opened(place, options = {}, before = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  page.on("console", message => assert.fail(`console: ${message.text()}`));
  page.on("pageerror", error => assert.fail(`page: ${error.message}`));
  page.on("request", request => assert.ok(request.url().startsWith(new URL(place).origin), `asks ${request.url()}`));
  await before(page);
  page.begun = performance.now();
  await page.goto(place);
  page.loaded_ms = performance.now() - page.begun;
  page.until = (what, is_so, value, timeout = 30_000) => page.waitForFunction(is_so, value, { timeout, polling: 50 }).catch(async () => assert.fail(`never ${what}: ${await page.textContent("#log").catch(() => "")}`));
  page.shot = async name => { if (shots) await page.screenshot({ path: `${shots}/${name}.png`, fullPage: true }); };
  return page;
}
const time = page => page.until("a trace", () => parseFloat(document.querySelector("#time").textContent) > 0.1);
const says = (page, words) => page.until(words, words => document.querySelector("#log").textContent.includes(words), words);

try {
  // The bench in real time.
  let page, first_ms = Infinity;
  // The best of three, each without a cache: other programs run on this machine, too.
  for (let n = 0; n < 3 && !(page?.loaded_ms < 2_000 && first_ms < 3_000); n++) {
    await page?.context().close();
    page = await opened(url);
    await time(page);
    first_ms = performance.now() - page.begun;
    console.log(`loaded in ${page.loaded_ms.toFixed(0)} ms, first trace after ${first_ms.toFixed(0)} ms`);
  }
  assert.ok(page.loaded_ms < 2_000 && first_ms < 3_000);
  const count = () => page.evaluate(() => [Number(document.body.dataset.pictures), performance.now()]);
  const [before, from_ms] = await count();
  await page.waitForTimeout(3_000);
  const [after, to_ms] = await count();
  console.log(`${((after - before) * 1e3 / (to_ms - from_ms)).toFixed(0)} pictures a second in real time`);
  assert.ok(after - before > 30);

  // As fast as it goes, with a control beside it, from a link.
  await page.context().close();
  page = await opened(`${url}#scene=glass&seed=1&beside=off&pace=0`);
  await time(page);
  const begun = performance.now();
  await page.until("the scene's end", () => document.querySelector("#done").value > 0.999, null, 60_000);
  console.log(`glass and a control, drawn: ${(60_000 / (performance.now() - begun)).toFixed(0)} times real time`);
  const [reflex, off] = await page.locator("#score tr:nth-child(3) td").allTextContents();
  assert.deepEqual([reflex, off], ["kept", "lost"]);
  assert.match(await page.textContent("#why"), /the reflex closed the hand, because/);
  await page.shot("glass");
  // Keys alone: another scene, a wet glass, a threshold.
  await page.selectOption("#pace", "1");
  await page.selectOption("#scene", "bench");
  await page.until("the link", () => location.hash.includes("scene=bench"));
  await time(page);
  // The dashed line of S1, from 100 mV to about 60.
  const { x, y } = await page.locator(".plot canvas").first().boundingBox();
  await page.mouse.move(x + 200, y + 20);
  await page.mouse.down();
  await page.mouse.move(x + 200, y + 39, { steps: 4 });
  await page.mouse.up();
  await page.until("a dragged threshold", () => /> s1-mv = [56]\d mV/.test(document.querySelector("#log").textContent));
  await page.locator("#log").focus();
  await page.keyboard.press("g");
  await says(page, "at the bench: g");
  await page.until("a grip", () => document.querySelector("#score tr:nth-child(6) td").textContent !== "0.0 N");
  await page.locator(".plot input").first().fill("120");
  await page.keyboard.press("Enter");
  await says(page, "> s1-mv = 120 mV");
  await page.until("the setting in the link", () => location.hash.includes("s1-mv=120"));
  await page.locator("#log").focus();
  await page.keyboard.press(" ");
  assert.equal(await page.textContent("#play"), "play");
  // Every control can be reached by Tab.
  const reached = new Set();
  for (let n = 0; n < 60; n++) { await page.keyboard.press("Tab"); reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.textContent)); }
  for (const id of ["scene", "seed", "beside", "pace", "play", "restart", "share", "to-file"]) assert.ok(reached.has(id), `Tab reaches ${id}: ${[...reached]}`);

  // A recording.
  await page.setInputFiles("#file", recording);
  await page.until("the player", () => parseFloat(document.querySelector("#played").textContent) > 1.5);
  await page.shot("recording");
  await page.context().close();

  // A small screen, light and dark; no motion where the system asks for none.
  for (const [name, width, height, colorScheme] of [["phone", 390, 844, "light"], ["phone-dark", 390, 844, "dark"], ["desk-dark", 1280, 900, "dark"]]) {
    page = await opened(`${url}#scene=glass&beside=constant&newtons=8&pace=10`, { viewport: { width, height }, colorScheme });
    await time(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name} is wider than its screen`);
    await page.until("something happens", () => parseFloat(document.querySelector("#time").textContent) > 15);
    await page.shot(name);
    await page.context().close();
  }
  // Without a network, once it was loaded.
  page = await opened(url);
  await time(page);
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.context().setOffline(true);
  await page.reload();
  await time(page);
  await page.context().close();
  page = await opened(url, { reducedMotion: "reduce" });
  await page.until("the keys", () => document.querySelector("#keys").childElementCount > 3);
  await page.waitForTimeout(500);
  assert.equal(await page.textContent("#play"), "play");
  assert.ok(parseFloat(await page.textContent("#time")) < 0.1, "it waits to be started");
  await page.context().close();

  // A board: a served bench behind a stand-in of Web Serial.
  const [line, { stdin: bench }] = await started("tenax-sim", ["run", "--host", "--scene", "bench", "--serve-tcp", "0"], /serving on tcp:127\.0\.0\.1:(\d+)/);
  const socket = connect(Number(line));
  ended.push(() => socket.destroy());
  const board = async page => {
    await page.exposeFunction("board_down", bytes => { socket.write(Uint8Array.from(bytes)); });
    await page.addInitScript(() => {
      let up;
      const port = {
        open: async () => {
          port.readable = new ReadableStream({ start(controller) { up = controller; } });
          port.writable = new WritableStream({ write: bytes => window.board_down([...bytes]) });
        },
        close: async () => {},
      };
      window.board_up = text => up?.enqueue(Uint8Array.from(atob(text), own => own.charCodeAt(0)));
      Object.defineProperty(navigator, "serial", { value: { requestPort: async () => port } });
    });
  };
  page = await opened(url, {}, board);
  await page.click("#to-board");
  await page.click("#connect");
  let came = [];
  socket.on("data", data => came.push(data));
  const bridge = setInterval(() => {
    if (came.length) page.evaluate(text => window.board_up(text), Buffer.concat(came).toString("base64")).catch(() => {});
    came = [];
  }, 40);
  await time(page);
  bench.write("button\n");
  await says(page, "Armed(Button)");
  await page.locator(".plot input").first().fill("130");
  await page.keyboard.press("Enter");
  await says(page, "> s1-mv = 130 mV");
  await page.click("#keep");
  await page.locator("#selftest-box summary").click();
  await page.fill("#test-of", "fsr_a");
  await page.click("#test-start");
  await page.until("what to press", () => document.querySelector("#prompt").textContent.startsWith("press fsr_a"));
  // Again and again: a touch that comes too late is asked for once more.
  bench.write("press fsr_a\n");
  const touches = setInterval(() => bench.write("press fsr_a\n"), 7_000);
  await page.until("a verdict", () => document.querySelector("#prompt").textContent.endsWith("channels pass"));
  clearInterval(touches);
  assert.equal(await page.textContent("#prompt"), "1 of 1 channels pass");
  await page.shot("board");
  const download = page.waitForEvent("download");
  await page.click("#keep");
  const kept = await (await download).path();
  const tables = `${resolve(tools, "..")}/board`, mcap = `${tables}.mcap`;
  copyFileSync(kept, mcap);
  execFileSync("target/release/tenax", ["play", mcap, "--csv", tables], { stdio: "ignore" });
  assert.ok(readFileSync(`${tables}/state.csv`).length > 1_000, "the tool reads what the page recorded");
  clearInterval(bridge);
  await page.context().close();

  // The same page by the server of `tenax monitor`.
  const [place] = await started("tenax", ["monitor", "--port", `tcp:127.0.0.1:${line}`, "--control", "--web", "0"], /(http:\/\/[0-9.:]+\/)/);
  page = await opened(place);
  await time(page);
  bench.write("button\n");
  await says(page, "Armed(Button)");
  await page.locator(".plot input").first().fill("110");
  await page.keyboard.press("Enter");
  await says(page, "> s1-mv = 110 mV");
  await page.shot("monitor");
  console.log("bench, recording, board and monitor work");
} finally {
  for (const end of ended.reverse()) await end();
}
process.exit(0);

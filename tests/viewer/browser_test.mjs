// The viewer in Chromium during a simulated run. Arguments: the program, the publisher of an ailing device's status, the
// browser, the viewer's package.json (where playwright-core is installed beside), a folder for pictures to look at.
// A busy machine may be slow: what must come true is waited for, what must not change is looked at after the page drew.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import { createRequire } from "node:module";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";

const [program, ailingStatus, chromiumPath, packageFile, pictures] = process.argv.slice(2);
const { chromium } = createRequire(packageFile)("playwright-core");
const PORT = 8123;
const ADDRESS = `http://127.0.0.1:${PORT}/`;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "pliant_viewer_"));
const config = path.join(folder, "depth.toml");
fs.writeFileSync(config, "[lcm]\npublish_depth = true\n");
const otherConfig = path.join(folder, "other.toml");
fs.writeFileSync(otherConfig, "[lcm]\nprefix = \"OTHER\"\n");
fs.mkdirSync(pictures, { recursive: true });

let browser, blank, viewer, tracker;
const foreign = [];
const faults = [];

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

async function until(what, probe, seconds = 90) {
  const end = Date.now() + 1000 * seconds;
  let last;
  while (Date.now() < end) {
    try {
      last = await probe();
      if (last) return last;
    } catch (fault) {
      last = fault;
    }
    await sleep(100);
  }
  assert.fail(`${what} did not come true within ${seconds} s (last: ${last})`);
}

const children = new Set();

function start(file, ...words) {
  const child = spawn(file, words, { stdio: ["ignore", "pipe", "pipe"] });
  children.add(child);
  child.text = "";
  child.stdout.on("data", (data) => { child.text += data; });
  child.stderr.on("data", (data) => { child.text += data; });
  child.ended = new Promise((done) => child.on("exit", (code, signal) => {
    children.delete(child);
    done(code ?? signal);
  }));
  return child;
}

const startProgram = (...words) => start(program, ...words);

async function stop(child, signal = "SIGTERM") {
  if (!child || child.exitCode !== null || child.signalCode !== null) return;
  child.kill(signal);
  await child.ended;
}

async function startViewer(...words) {
  const child = startProgram("view", "--port", String(PORT), ...words);
  await until("the viewer's address", () => child.text.match(/open (http:\S+)/));
  return child;
}

const startTracker = (file = config) => startProgram("run", "--config", file, "--source",
  "simulated:cushion?width=320&height=240&frames=100000", "--pace", "realtime", "--lcm-url",
  "udpm://239.255.76.67:7667?ttl=0");

async function openPage(options = { viewport: { width: 1100, height: 720 } }) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.protocol !== "data:" && url.host !== `127.0.0.1:${PORT}`) foreign.push(request.url());
  });
  page.on("pageerror", (fault) => faults.push(String(fault)));
  await page.goto(ADDRESS);
  return page;
}

const frameOf = async (page) => Number((await page.textContent("#frame")).replace(/\D/g, "") || -1);
const stateOf = (page) => page.getAttribute("#state", "data-state");
/** After the page drew what it knew before. */
const drawn = (page) => page.evaluate(() => new Promise((done) =>
  requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
const tracking = (page) => until("tracking", async () => (await stateOf(page)) === "tracking" && (await frameOf(page)) > 5);

/** Ends the tracker, whatever it does, and starts another. */
async function restartTracker(file) {
  await stop(tracker);
  tracker = startTracker(file);
}

/** The picture of the scene as the screen shows it: shares of pixels by colour, and the pixels' own text. */
async function look(page, name) {
  await drawn(page);
  const png = await page.locator("#scene").screenshot();
  if (name) fs.writeFileSync(path.join(pictures, `${name}.png`), png);
  return blank.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
    let blue = 0, grey = 0, left = image.width, right = 0, hash = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = pixels.subarray(i, i + 3);
      const x = (i / 4) % image.width;
      if (b > 70 && b > 1.35 * g && b > 2.5 * r) { // the base region's colour, light or dark
        ++blue;
        left = Math.min(left, x);
        right = Math.max(right, x);
      }
      if (Math.abs(r - g) < 4 && Math.abs(g - b) < 4 && r > 28) ++grey; // depth readings
      hash = (Math.imul(hash, 31) + (r << 16 | g << 8 | b)) | 0;
    }
    const all = pixels.length / 4;
    return { blue: blue / all, grey: grey / all, middle: (left + right) / 2 / image.width, hash };
  }, png.toString("base64"));
}

before(async () => {
  browser = await chromium.launch({ executablePath: chromiumPath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  blank = await browser.newPage();
  viewer = await startViewer();
});

after(async () => {
  for (const child of children) child.kill("SIGKILL");
  await browser?.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

test("says what is missing, and the names of other trackers that are there", async () => {
  const page = await openPage();
  await until("the notice", async () => (await page.isVisible("#notice")) &&
    (await page.textContent("#notice")).includes("Nothing is published on PLIANT_*"));
  assert.match(await page.textContent("#notice"), /pliant run --source 'simulated:cushion\?frames=100000' --pace realtime/);
  assert.match(await page.textContent("#notice"), /ttl=1/);
  const other = startTracker(otherConfig);
  await until("the other tracker's name", async () => (await page.textContent("#notice")).includes("--prefix OTHER"));
  await stop(other);
  await page.context().close();
});

let page;
test("shows the object, the depth and numbers that change", async () => {
  page = await openPage();
  tracker = startTracker();
  await tracking(page);
  await until("no notice", async () => !(await page.isVisible("#notice")));
  const seen = await until("the object in the picture", async () => {
    const now = await look(page, "desktop");
    return now.blue > 0.02 && now.grey > 0.1 && now;
  });
  assert.ok(Math.abs(seen.middle - 0.5) < 0.25, `the object is at ${seen.middle}, not in the middle`);
  const first = await frameOf(page);
  await until("newer frames", async () => (await frameOf(page)) > first + 20);
  await until("a rate", async () => Number(await page.textContent("#rate-now")) > 0);
  await until("a latency", async () => parseFloat(await page.textContent("#latency-now")) > 0);
  await until("the device", async () => /streaming/.test(await page.textContent("#numbers")));
  assert.match(await page.textContent("#regions"), /base\d+ points, rms/);
  assert.match(await page.textContent("#stage-key"), /surface.*total/);
  await until("the legend", async () => /points? deformed/.test(await page.textContent("#legend")));
  await until("three curves", () => page.evaluate(() => [...document.querySelectorAll(".plot")].every((plot) => {
    const { data } = plot.getContext("2d").getImageData(0, 0, plot.width, plot.height);
    return data.some((value, i) => i % 4 === 3 && value > 0);
  })));
  await page.screenshot({ path: path.join(pictures, "page.png") });
});

test("pausing holds the picture and the numbers, by key and by button", async () => {
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#pause", "aria-pressed"), "true");
  await drawn(page);
  const [frame, picture, numbers] = [await frameOf(page), await look(page), await page.textContent("#numbers")];
  await sleep(1500);
  assert.equal(await frameOf(page), frame);
  assert.equal((await look(page)).hash, picture.hash);
  assert.equal(await page.textContent("#numbers"), numbers);
  await page.keyboard.press("Space");
  await until("going on", async () => (await frameOf(page)) > frame + 10);
  // By pointer, then by key: the button must not keep the focus and take the key for itself.
  await page.click("#pause");
  assert.equal(await page.getAttribute("#pause", "aria-pressed"), "true");
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#pause", "aria-pressed"), "false");
  // By keyboard alone: the space bar on the focused button counts once.
  await page.focus("#pause");
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#pause", "aria-pressed"), "true");
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#pause", "aria-pressed"), "false");
  await page.evaluate(() => document.activeElement.blur());
});

test("orbits by pointer and keys, and goes back", async () => {
  await page.keyboard.press("Space");
  await page.keyboard.press("r");
  const start = await look(page);
  await page.mouse.move(400, 400);
  await page.mouse.down();
  await page.mouse.move(520, 430, { steps: 5 });
  await page.mouse.up();
  const dragged = await look(page, "orbited");
  assert.notEqual(dragged.hash, start.hash);
  await page.keyboard.press("ArrowLeft");
  assert.notEqual((await look(page)).hash, dragged.hash);
  await page.keyboard.press("r");
  await until("the first view again", async () => (await look(page)).hash === start.hash);
  await page.keyboard.press("d");
  await until("less grey without depth", async () => (await look(page)).grey < 0.5 * start.grey);
  assert.equal(await page.getAttribute("#depth", "aria-pressed"), "false");
  await page.keyboard.press("d");
  await page.click("#help");
  assert.equal(await page.isVisible("#keys"), true);
  await page.keyboard.press("?");
  assert.equal(await page.isVisible("#keys"), false);
  await page.keyboard.press("Space");
});

test("two viewers see the same tracker", async () => {
  const second = await openPage({ viewport: { width: 700, height: 500 } });
  await tracking(second);
  const [a, b] = [await frameOf(page), await frameOf(second)];
  await until("both going on", async () => (await frameOf(page)) > a + 10 && (await frameOf(second)) > b + 10);
  await second.context().close();
});

test("a phone's screen shows all of it", async () => {
  const phone = await openPage({ viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await tracking(phone);
  await until("the object", async () => (await look(phone)).blue > 0.02);
  const layout = await phone.evaluate(() => ({
    overflow: document.documentElement.scrollWidth - innerWidth,
    scene: document.getElementById("scene").getBoundingClientRect().toJSON(),
    buttons: [...document.querySelectorAll("#tools button")].map((b) => b.getBoundingClientRect().toJSON()),
  }));
  assert.ok(layout.overflow <= 0, `${layout.overflow} pixels too wide`);
  assert.ok(layout.scene.width >= 380 && layout.scene.height >= 400, JSON.stringify(layout.scene));
  for (const button of layout.buttons) assert.ok(button.height >= 32 && button.right <= 390, JSON.stringify(button));
  await phone.tap("#pause");
  assert.equal(await phone.getAttribute("#pause", "aria-pressed"), "true");
  await phone.tap("#pause");
  await phone.screenshot({ path: path.join(pictures, "phone.png") });
  await phone.locator("#plot-stages").scrollIntoViewIfNeeded();
  assert.ok(await phone.locator("#plot-stages").isVisible());
  await phone.context().close();
});

test("the tracker's end is said, its restart is followed", async () => {
  await stop(tracker);
  await until("the silence", async () => (await stateOf(page)) === "silent" && (await page.isVisible("#notice")));
  tracker = startTracker();
  await until("tracking again", async () => (await stateOf(page)) === "tracking" && !(await page.isVisible("#notice")));
  await until("the object again", async () => (await look(page)).blue > 0.02);
});

test("the server's restart is followed", async () => {
  await stop(viewer, "SIGKILL");
  await until("the notice", async () => (await page.textContent("#notice")).includes("does not answer"));
  viewer = await startViewer();
  await until("going on", async () => (await stateOf(page)) === "tracking" && !(await page.isVisible("#notice")));
});

test("what ails the stream is told, and that no depth is published", async (t) => {
  fs.writeFileSync(path.join(folder, "plain.toml"), "");
  await restartTracker(path.join(folder, "plain.toml"));
  await until("the note", async () => /No depth picture is published/.test(await page.textContent("#legend")));
  await stop(tracker);
  const ailing = start(ailingStatus);
  t.after(() => stop(ailing));
  const numbers = await until("the faults", async () => {
    assert.equal(ailing.exitCode, null);
    const text = await page.textContent("#numbers");
    return /frames empty/.test(text) && text;
  });
  assert.match(numbers, /devicestalled, frames empty/);
  assert.match(numbers, /bad frames30: 11 empty, 12 repeated, 3 late, 4 broken/);
  assert.match(numbers, /frames at too low a rate5/);
  assert.match(numbers, /stalls \/ opened again6 \/ 8/);
  await page.screenshot({ path: path.join(pictures, "faults.png") });
  await stop(ailing);
  await restartTracker();
  await until("tracking again", async () => (await stateOf(page)) === "tracking" && !(await page.isVisible("#notice")));
});

/** Resident bytes of a process. */
function resident(pid) {
  return Number(fs.readFileSync(`/proc/${pid}/status`, "utf8").match(/VmRSS:\s+(\d+)/)[1]) * 1024;
}

/** How many bytes the server has for each of these sockets that it does not take, as the kernel counts them. */
function untaken(sockets) {
  const waiting = new Map();
  for (const line of fs.readFileSync("/proc/net/tcp", "utf8").split("\n").slice(1)) {
    const [, from, to, state, queues] = line.trim().split(/\s+/);
    if (state !== "01" || parseInt(from.split(":")[1], 16) !== PORT) continue; // 01: established
    waiting.set(parseInt(to.split(":")[1], 16), parseInt(queues.split(":")[0], 16));
  }
  return sockets.map((socket) => waiting.get(socket.localPort) ?? 0);
}

/** What waits for each of these sockets once nothing more goes there; false while something does. */
async function stuck(sockets) {
  const earlier = untaken(sockets);
  await sleep(300);
  const now = untaken(sockets);
  return now.every((bytes, i) => bytes > 0 && bytes === earlier[i]) && now;
}

/** Seconds until the page has shown `count` more frames; infinitely many where it has not within a minute. */
async function secondsFor(count) {
  const begin = performance.now();
  const shown = await page.evaluate((wanted) => new Promise((done) => {
    let frames = 0;
    const observer = new MutationObserver(() => { if (++frames >= wanted) end(); });
    const end = () => {
      observer.disconnect();
      done(frames);
    };
    observer.observe(document.getElementById("frame"), { childList: true, characterData: true, subtree: true });
    setTimeout(end, 60000);
  }), count);
  return shown < count ? Infinity : (performance.now() - begin) / 1000;
}

test("browsers that ask and never read slow nobody and cost nothing", async (t) => {
  if ((await stateOf(page)) !== "tracking") await restartTracker();
  await tracking(page);
  const earlier = resident(viewer.pid);
  let tried;
  // The machine's other work comes and goes: a slow round beside quick ones is none of theirs unless it comes again.
  for (let round = 0; round < 5; ++round) {
    const before = await secondsFor(12);
    const sockets = [];
    t.after(() => sockets.forEach((socket) => socket.destroy()));
    for (let i = 0; i < 4; ++i) {
      const socket = net.connect(PORT, "127.0.0.1");
      socket.on("error", () => {});
      socket.pause();
      socket.write(`GET /stream HTTP/1.1\r\nHost: 127.0.0.1:${PORT}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n");
      await sleep(200);
      const wish = Buffer.from("next depth");
      // Masked with zeros.
      const ask = Buffer.concat([Buffer.from([0x81, 0x80 | wish.length, 0, 0, 0, 0]), wish]);
      socket.write(Buffer.concat(Array(3000).fill(ask)));
      sockets.push(socket);
    }
    const waiting = await until("answers that nobody takes", () => stuck(sockets));
    const beside = await secondsFor(12);
    // When the kernel asks again whether there is room it may find some, so that more waits; less would have been taken.
    const still = untaken(sockets).every((bytes, i) => bytes >= waiting[i]);
    const grown = resident(viewer.pid) - earlier;
    assert.ok(grown < 8e6, `the server grew by ${grown} bytes`);
    for (const socket of sockets) socket.destroy();
    const after = await secondsFor(12);
    tried = `12 frames took ${before.toFixed(1)} s, ${beside.toFixed(1)} s beside them (still stuck: ${still}), ${after.toFixed(1)} s again`;
    t.diagnostic(tried);
    if (still && Number.isFinite(before + after) && beside < 2 * Math.max(before, after)) return;
  }
  assert.fail(`the other browser is slowed: ${tried}`);
});

function get(port, headers, target = "/") {
  return new Promise((done, failed) => {
    http.get({ host: "127.0.0.1", port, path: target, headers }, (response) => {
      response.resume();
      done(response);
    }).on("error", failed);
  });
}

test("foreign names are refused, and other addresses ask for the token", async () => {
  assert.equal((await get(PORT, {})).statusCode, 200);
  assert.equal((await get(PORT, { Host: "evil.example" })).statusCode, 403);
  assert.equal((await get(PORT, {}, "/../main.cpp")).statusCode, 404);
  const policy = (await get(PORT, {})).headers["content-security-policy"];
  assert.match(policy, /default-src 'self'/);
  const open = startProgram("view", "--port", "0", "--bind", "0.0.0.0");
  const [, port, token] = await until("its address", () => open.text.match(/open http:\S+:(\d+)\/\?token=([0-9a-f]{32})/));
  assert.equal((await get(port, {})).statusCode, 403);
  assert.equal((await get(port, {}, "/main.js")).statusCode, 403);
  const allowed = await get(port, {}, `/?token=${token}`);
  assert.equal(allowed.statusCode, 200);
  const cookie = allowed.headers["set-cookie"][0].split(";")[0];
  assert.equal((await get(port, { Cookie: cookie }, "/main.js")).statusCode, 200);
  await stop(open);
  const taken = startProgram("view", "--port", String(PORT));
  assert.equal(await taken.ended, 2);
  assert.match(taken.text, /^pliant: cannot listen on port 8123/);
});

test("nothing was asked of any other machine, and no script failed", () => {
  assert.deepEqual(foreign, []);
  assert.deepEqual(faults, []);
});

// Drives the page in a browser: once behind the program's server, once as the file that runs by itself.
//
// usage: node run.mjs SNAKE LIVE_HTML APPLE_PNG TRUTH_CSV OUT
// SNAKE: the program; LIVE_HTML: the page with its engine inside, or "-" to leave it out; OUT: folder for screenshots.

import { spawn } from "node:child_process";
import { mkdtempSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [snake, html, apple, truth, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const browserPath = process.env.CHROMIUM || "/usr/bin/chromium";
const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

let failed = 0;
let done = 0;

function must(what, words) {
  if (!what) throw new Error(words);
}

async function test(name, run) {
  const began = Date.now();
  try {
    await run();
    done++;
    console.log(`ok    ${name} (${Date.now() - began} ms)`);
  } catch (error) {
    failed++;
    console.log(`FAILED ${name}: ${error.stack || error}`);
  }
}

/** The program with that open; the address it prints. */
function serve(...files) {
  const folder = mkdtempSync(join(tmpdir(), "snakes-"));
  const child = spawn(snake, ["live", "--no-open", ...files], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  const address = new Promise((resolve, reject) => {
    let said = "";
    child.stdout.on("data", (data) => {
      said += data;
      if (said.includes("\n")) resolve(said.split("\n")[0]);
    });
    let wrong = "";
    child.stderr.on("data", (data) => (wrong += data));
    child.on("exit", (code) => reject(new Error(`the program ended with ${code}: ${wrong}`)));
  });
  const stop = () => new Promise((resolve) => {
    child.on("exit", resolve);
    child.kill("SIGINT");
  });
  return { address, stop, folder, child };
}

const browser = await chromium.launch({ executablePath: browserPath, args: flags });

async function window(url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.wrong = [];
  page.on("pageerror", (error) => page.wrong.push(String(error)));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  await page.goto(url);
  await until(page, "true");
  return page;
}

/** A value of the page once it is something. */
async function until(page, expression, most = 20000) {
  const end = Date.now() + most;
  for (;;) {
    const value = await page.evaluate(`Promise.resolve(window.snakes && (${expression}))`);
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${most} ms: ${expression}`);
    await page.waitForTimeout(30);
  }
}

/** Where on the screen a place of the world is. */
async function screen(page, x, y) {
  const [a, b] = await page.evaluate(([x, y]) => snakes.camera.screen(x, y), [x, y]);
  const box = await page.locator("#canvas").boundingBox();
  return [box.x + a, box.y + b];
}

/** Let the program's answers to what was done come. */
const settle = (page) => page.evaluate(async () => {
  for (let i = 0; i < 3; i++) await snakes.engine.call({ ask: { kind: "about" } });
});

function table(text) {
  return text.split("\n").map((line) => line.split(",").map(Number)).filter((row) => row.length > 1 && row.slice(0, 2).every(Number.isFinite)).map(([x, y]) => [x, y]);
}

/** Mean distance of points to a closed line. */
function away(points, line) {
  let sum = 0;
  for (const [x, y] of points) {
    let best = Infinity;
    line.forEach(([ax, ay], i) => {
      const [bx, by] = line[(i + 1) % line.length];
      const [dx, dy] = [bx - ax, by - ay];
      const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      best = Math.min(best, Math.hypot(x - ax - t * dx, y - ay - t * dy));
    });
    sum += best;
  }
  return sum / points.length;
}

async function save(page, format) {
  await page.click("#export");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-format="${format}"]`)]);
  const stream = await download.createReadStream();
  const parts = [];
  for await (const part of stream) parts.push(part);
  return { name: download.suggestedFilename(), bytes: Buffer.concat(parts) };
}

/** What both engines do alike; `open` gives a page with a scene or a picture open. */
async function both(kind, open) {
  await test(`${kind}: a ball is thrown against the wall, pinned, undone and redone`, async () => {
    const page = await open("soft-ball");
    await until(page, "snakes.scene && snakes.scene.snakes.length === 1");
    await page.evaluate(() => snakes.playing && snakes.act({ kind: "pause" }));
    const [cx, cy] = await page.evaluate(() => snakes.scene.snakes[0].center);
    await page.evaluate(() => snakes.act({ kind: "play" }));
    const from = await screen(page, cx, cy);
    await page.mouse.move(...from);
    await page.mouse.down();
    await until(page, "snakes.scene.drag !== null");
    for (let i = 1; i <= 12; i++) {
      await page.mouse.move(from[0] - 12 * i, from[1] - 4 * i);
      await page.waitForTimeout(30);
    }
    await page.screenshot({ path: join(out, `${kind}-throw.png`) });
    await page.mouse.up();
    await until(page, "snakes.scene.drag === null");
    // it meets the wall at x = 0 and does not pass it
    await until(page, "Math.min(...snakes.scene.snakes[0].points.filter((_, i) => i % 2 === 0)) < 0.15", 20000);
    const least = await page.evaluate(() => Math.min(...snakes.scene.snakes[0].points.filter((_, i) => i % 2 === 0)));
    must(least > -0.3, `a node is at x = ${least}, behind the wall`);
    await page.evaluate(() => snakes.act({ kind: "pause" }));
    await settle(page);
    await page.keyboard.press("p");
    const [nx, ny] = await page.evaluate(() => [...snakes.scene.snakes[0].points.slice(0, 2)]);
    await page.mouse.click(...(await screen(page, nx, ny)));
    await until(page, "(snakes.scene.snakes[0].pins || []).length === 1");
    await page.click("#undo");
    await until(page, "(snakes.scene.snakes[0].pins || []).length === 0");
    await page.click("#redo");
    await until(page, "(snakes.scene.snakes[0].pins || []).length === 1");
    const step = await page.evaluate(() => snakes.scene.step);
    await page.click("#step");
    await until(page, `snakes.scene.step === ${step + 1}`);
    await page.click("#back");
    await until(page, `snakes.scene.step === ${step}`);
    must(!page.wrong.length, page.wrong.join("\n"));
    await page.context().close();
  });

  await test(`${kind}: clicks about the apple find its outline, which is saved and read back`, async () => {
    const page = await open("apple.png");
    await until(page, "snakes.picture !== null && snakes.about && snakes.about.size");
    await page.waitForTimeout(400);
    await page.keyboard.press("s");
    for (let i = 0; i < 9; i++) {
      const angle = (i * 2 * Math.PI) / 9;
      await page.mouse.click(...(await screen(page, 252 + 207 * Math.cos(angle), 278 + 218 * Math.sin(angle))));
    }
    await until(page, "snakes.preview && snakes.preview.points.length > 60");
    await page.screenshot({ path: join(out, `${kind}-start.png`) });
    await page.keyboard.press("Enter");
    await until(page, "snakes.picture.outlines.length === 1");
    await page.waitForTimeout(120);
    await page.screenshot({ path: join(out, `${kind}-apple-on-its-way.png`) });
    await until(page, "!snakes.playing && !snakes.picture.outlines[0].arriving");
    const points = await page.evaluate(() => {
      const x = [...snakes.picture.outlines[0].points];
      return x.flatMap((v, i) => (i % 2 ? [] : [[v, x[i + 1]]]));
    });
    const line = table(readFileSync(truth, "utf8"));
    const off = away(points, line);
    must(off < 4, `the outline is ${off} pixels from the truth in the mean`);
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(out, `${kind}-apple.png`) });
    const saved = await save(page, "csv");
    must(saved.name === "apple.csv", saved.name);
    const again = table(saved.bytes.toString());
    must(Math.abs(again.length - points.length) <= 1, `${again.length} nodes were saved of ${points.length}`);
    await page.locator("#file").setInputFiles({ name: saved.name, mimeType: "text/csv", buffer: saved.bytes });
    await until(page, "snakes.picture.outlines.length === 2");
    must(!page.wrong.length, page.wrong.join("\n"));
    await page.context().close();
  });

  await test(`${kind}: a stretch is mended, an edge is let go, and all is taken back`, async () => {
    const page = await open("apple.png");
    await until(page, "snakes.picture !== null && snakes.about && snakes.about.size");
    await page.keyboard.press("i");
    await page.mouse.click(...(await screen(page, 256, 270)));
    await until(page, "snakes.picture.outlines.length === 1 && !snakes.playing");
    const before = await page.evaluate(() => [...snakes.picture.outlines[0].points]);
    await page.keyboard.press("m");
    // the topmost node, pulled up
    const [x, y] = await page.evaluate(() => {
      const p = snakes.picture.outlines[0].points;
      let top = 0;
      for (let i = 0; i < p.length; i += 2) if (p[i + 1] < p[top + 1]) top = i;
      return [p[top], p[top + 1]];
    });
    const at = await screen(page, x, y);
    await page.mouse.move(...at);
    await page.mouse.down();
    for (let i = 1; i <= 10; i++) {
      await page.mouse.move(at[0] + i, at[1] - 2.5 * i);
      await page.waitForTimeout(40);
    }
    await page.screenshot({ path: join(out, `${kind}-mend.png`) });
    await page.mouse.up();
    await until(page, "!snakes.playing && snakes.picture.pull === null");
    await settle(page);
    const after = await page.evaluate(() => [...snakes.picture.outlines[0].points]);
    must(before.length === after.length && before.some((v, i) => v !== after[i]), "the stretch has not moved");
    const same = before.filter((v, i) => v === after[i]).length / before.length;
    must(same > 0.5, `only ${same} of the outline stayed`);
    await page.keyboard.press("Control+z");
    await page.waitForTimeout(150);
    await settle(page);
    const back = await page.evaluate(() => [...snakes.picture.outlines[0].points]);
    must(back.length === before.length && back.every((v, i) => v === before[i]), "undo has not brought the outline back");
    await page.click('[data-tool="not-edge"]');
    await page.mouse.click(...(await screen(page, before[0], before[1])));
    await page.waitForTimeout(200);
    await settle(page);
    must(!page.wrong.length, page.wrong.join("\n"));
    await page.context().close();
  });

  await test(`${kind}: by the keyboard alone, and every control has a name`, async () => {
    const page = await open("apple.png");
    await until(page, "snakes.picture !== null && snakes.about && snakes.about.size");
    await page.locator("#canvas").focus();
    await page.keyboard.press("Shift+ArrowLeft");
    await page.keyboard.press("Shift+ArrowRight");
    await page.keyboard.press("Enter");
    await page.keyboard.press("Enter");
    await until(page, "snakes.picture.outlines.length === 1");
    const nameless = await page.evaluate(() => [...document.querySelectorAll("button, input, select, canvas")]
      .filter((e) => !e.hidden && !(e.getAttribute("aria-label") || e.textContent.trim() || e.title || (e.labels && e.labels.length) || e.getAttribute("aria-hidden")))
      .map((e) => e.outerHTML.slice(0, 120)));
    must(!nameless.length, `without a name: ${nameless.join("\n")}`);
    await page.keyboard.press("?");
    await page.waitForSelector("dialog[open]");
    await page.screenshot({ path: join(out, `${kind}-help.png`) });
    await page.keyboard.press("Escape");
    must(!page.wrong.length, page.wrong.join("\n"));
    await page.context().close();
  });
}

// behind the server
const stops = [];
await both("server", async (what) => {
  const served = serve(what === "apple.png" ? apple : what);
  stops.push(served);
  const page = await window(await served.address);
  page.served = served;
  return page;
});
for (const served of stops) await served.stop();

await test("server: two windows see the same, a dropped socket is taken up again and loses nothing", async () => {
  const served = serve("soft-ball");
  const url = await served.address;
  const [one, two] = [await window(url), await window(url)];
  await until(one, "snakes.scene");
  await until(two, "snakes.scene");
  await one.evaluate(() => snakes.act({ kind: "step", steps: 7 }));
  await until(two, "snakes.scene.step === 7");
  await one.evaluate(async () => {
    snakes.engine.socket.close();
    // said while there is no connection
    await snakes.act({ kind: "step", steps: 4 });
  });
  await until(one, "snakes.scene.step >= 11");
  must((await one.evaluate(() => snakes.scene.step)) === 11, "a step was made twice");
  await until(two, "snakes.scene.step === 11");
  must(!(await one.isVisible("#lost")), "the page still says that the connection is lost");
  await one.context().close();
  await two.context().close();
  await served.stop();
});

await test("server: it says when it is gone, and what was not saved is kept and replays", async () => {
  const served = serve("soft-ball");
  const page = await window(await served.address);
  await until(page, "snakes.scene");
  await page.evaluate(() => snakes.act({ kind: "body", do: "gravity", g: [0.2, 0.1] }));
  await page.evaluate(() => snakes.act({ kind: "step", steps: 50 }));
  await until(page, "snakes.scene.step === 50");
  const points = await page.evaluate(() => [...snakes.scene.snakes[0].points]);
  await served.stop();
  await page.waitForSelector("#lost:not([hidden])");
  const file = join(served.folder, "soft-ball.snakes.json");
  must(readFileSync(file, "utf8").includes("snakes-session"), "no session was kept");
  const run = spawn(snake, ["run", file, "--out", "-", "--quiet"], { stdio: ["ignore", "pipe", "inherit"] });
  let text = "";
  run.stdout.on("data", (data) => (text += data));
  await new Promise((resolve) => run.on("exit", resolve));
  const replayed = table(text).flat();
  must(replayed.length === points.length, `${replayed.length} numbers of ${points.length}`);
  must(replayed.every((v, i) => Math.abs(v - points[i]) < 1e-4), "the session led elsewhere");
  await page.context().close();
});

await test("server: all scenes from the menu, a phone's width, the dark", async () => {
  const served = serve();
  const page = await window(await served.address, { colorScheme: "dark" });
  await page.waitForSelector(".scenes button");
  await page.waitForTimeout(2500);
  await page.screenshot({ path: join(out, "scenes.png") });
  await page.click('[data-scene="pile"]');
  await until(page, "snakes.scene && snakes.scene.snakes.length > 10");
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(out, "pile-dark.png") });
  await page.setViewportSize({ width: 390, height: 800 });
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(out, "phone.png") });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  must(wide <= 390, `the page is ${wide} pixels wide on a phone of 390`);
  must(!page.wrong.length, page.wrong.join("\n"));
  await page.context().close();
  await served.stop();
});

// as a file, without any program
if (html !== "-") {
  await both("file", async (what) => {
    const page = await window(pathToFileURL(html).href);
    if (what === "apple.png") {
      await page.waitForSelector(".scenes button");
      await page.evaluate(() => document.getElementById("dialog").close());
      await page.locator("#file").setInputFiles(apple);
    } else {
      await page.click(`[data-scene="${what}"]`);
    }
    return page;
  });
}

await browser.close();
writeFileSync(join(out, "summary.txt"), `${done} passed, ${failed} failed\n`);
console.log(`${done} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);

// Measures the window: frames a second and the time from a drag to the frame that knows it, with an outline of some
// 2000 nodes in a picture of 2048 by 2048 pixels, and what memory the program holds after so many seconds of running.
//
// usage: node bench.mjs SNAKE SECONDS

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [snake, seconds] = [process.argv[2], Number(process.argv[3] || 30)];
const side = 2048;
const folder = mkdtempSync(join(tmpdir(), "snakes-bench-"));
const pixels = Buffer.alloc(side * side);
for (let y = 0; y < side; y++) {
  for (let x = 0; x < side; x++) {
    const away = Math.hypot(x - 1024, y - 1024);
    pixels[y * side + x] = 60 + 120 * Math.min(Math.max(318.5 - away, 0), 1) + ((x * 7919 + y * 104729) % 13);
  }
}
const file = join(folder, "disc.pgm");
writeFileSync(file, Buffer.concat([Buffer.from(`P5 ${side} ${side} 255 `), pixels]));

const child = spawn(snake, ["live", "--no-open", file], { cwd: folder, stdio: ["ignore", "pipe", "ignore"] });
const url = await new Promise((resolve) => {
  let said = "";
  child.stdout.on("data", (data) => {
    said += data;
    if (said.includes("\n")) resolve(said.split("\n")[0]);
  });
});
const memory = () => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${child.pid}/status`, "utf8"))[1]) / 1024;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
await page.goto(url);
await page.waitForTimeout(1500);
await page.evaluate(() => snakes.act({ kind: "outline", do: "start", drawn: "ellipse", points: [[690, 690], [1360, 1360]] }));
await page.waitForTimeout(3000);
const nodes = await page.evaluate(() => snakes.picture.outlines[0].points.length / 2);
const begin = memory();
const seen = await page.evaluate(async (seconds) => {
  const late = [];
  let frames = 0;
  let drawn = 0;
  const engine = snakes.engine;
  const own = engine.onframe;
  /** @type {Map<number, number>} */
  const sent = new Map();
  engine.onframe = (frame) => {
    frames++;
    const pull = frame.head.frame && frame.head.frame.pull;
    if (pull) {
      const key = Math.round(pull.to[0] * 1000);
      if (sent.has(key)) {
        late.push(performance.now() - sent.get(key));
        sent.delete(key);
      }
    }
    own(frame);
  };
  const count = () => {
    drawn++;
    requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
  const began = performance.now();
  let i = 0;
  while (performance.now() - began < 1000 * seconds) {
    const to = [1024 + 318 + 20 * Math.sin(i / 15) + i * 0.001, 1024];
    sent.set(Math.round(to[0] * 1000), performance.now());
    snakes.act({ kind: "outline", do: "drag", id: 1, node: 0, to, reach: 60 }, false);
    i++;
    await new Promise((resolve) => setTimeout(resolve, 16));
  }
  const time = (performance.now() - began) / 1000;
  late.sort((a, b) => a - b);
  const at = (share) => late[Math.floor(share * (late.length - 1))];
  return { frames: frames / time, drawn: drawn / time, median: at(0.5), most: at(0.95), count: late.length };
}, seconds);
console.log(`nodes ${nodes}, picture ${side} x ${side}`);
console.log(`frames from the engine ${seen.frames.toFixed(1)} /s, drawn ${seen.drawn.toFixed(1)} /s`);
console.log(`drag to frame: median ${seen.median.toFixed(1)} ms, 95 of 100 within ${seen.most.toFixed(1)} ms (${seen.count} drags)`);
console.log(`memory of the program: ${begin.toFixed(0)} MiB at the start, ${memory().toFixed(0)} MiB after ${seconds} s of dragging`);
await browser.close();
child.kill("SIGINT");

// Plots as SVG, each of which can be saved as a picture or a table.

import { ofObject } from "./colors.js";

/** Size of a plot. */
const [WIDTH, HEIGHT] = [320, 150];
const [LEFT, RIGHT, TOP, BOTTOM] = [44, 8, 8, 22];

/**
 * A line of a plot.
 * @typedef {{name: string, x: number[], y: number[], color?: string}} Line
 */

/** @param {number} value */
export function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}

/**
 * Round values along an axis.
 * @param {number} low
 * @param {number} high
 */
function ticks(low, high) {
  const span = high - low || 1;
  const raw = span / 4;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw) || raw;
  const out = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * span; v += step) out.push(Math.abs(v) < 1e-12 * span ? 0 : v);
  return out;
}

/** @param {string} text */
const safe = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

export class Plot {
  /**
   * @param {HTMLElement} parent
   * @param {string} name what it shows, for people and for file names
   */
  constructor(parent, name) {
    this.name = name;
    this.box = document.createElement("div");
    this.box.className = "plot";
    const save = document.createElement("div");
    save.className = "save";
    for (const [kind, words] of [["svg", "SVG"], ["csv", "CSV"]]) {
      const button = document.createElement("button");
      button.textContent = words;
      button.setAttribute("aria-label", `Save ${name} as ${words}`);
      button.onclick = () => this.save(kind);
      save.append(button);
    }
    this.picture = document.createElement("div");
    this.box.append(this.picture, save);
    parent.append(this.box);
    this.table = "";
    this.drawn = "";
  }

  /** Show nothing. */
  clear() {
    this.picture.replaceChildren();
    this.table = "";
    this.drawn = "";
  }

  /** @param {string} kind */
  save(kind) {
    const text = kind === "svg" ? this.standalone() : this.table;
    download(`${this.name.replace(/\W+/g, "-")}.${kind}`, new Blob([text], { type: kind === "svg" ? "image/svg+xml" : "text/csv" }));
  }

  /** The drawing with colors of its own, since a file has no page about it. */
  standalone() {
    const style = getComputedStyle(document.documentElement);
    return this.drawn.replace(/var\((--[a-z-]+)\)/g, (_, name) => style.getPropertyValue(name).trim())
      .replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ');
  }

  /** @param {string} inside */
  put(inside) {
    this.drawn = `<svg viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img" aria-label="${safe(this.name)}" font-family="sans-serif" font-size="10">${inside}</svg>`;
    this.picture.innerHTML = this.drawn;
  }

  /**
   * Axes and the functions that place values.
   * @param {[number, number]} xs
   * @param {[number, number]} ys
   * @param {string} xname
   */
  axes([x0, x1], [y0, y1], xname) {
    if (!(y1 > y0)) [y0, y1] = [y0 - 0.5, y1 + 0.5];
    if (!(x1 > x0)) x1 = x0 + 1;
    const px = (/** @type {number} */ x) => LEFT + ((x - x0) / (x1 - x0)) * (WIDTH - LEFT - RIGHT);
    const py = (/** @type {number} */ y) => HEIGHT - BOTTOM - ((y - y0) / (y1 - y0)) * (HEIGHT - TOP - BOTTOM);
    let out = "";
    for (const y of ticks(y0, y1)) {
      out += `<line x1="${LEFT}" x2="${WIDTH - RIGHT}" y1="${py(y)}" y2="${py(y)}" stroke="var(--line)"/>`;
      out += `<text x="${LEFT - 4}" y="${py(y) + 3}" text-anchor="end" fill="var(--soft)">${short(y)}</text>`;
    }
    for (const x of ticks(x0, x1)) {
      out += `<text x="${px(x)}" y="${HEIGHT - BOTTOM + 12}" text-anchor="middle" fill="var(--soft)">${short(x)}</text>`;
    }
    out += `<text x="${WIDTH - RIGHT}" y="${HEIGHT - 2}" text-anchor="end" fill="var(--soft)">${safe(xname)}</text>`;
    return { out, px, py };
  }

  /**
   * @param {Line[]} lines
   * @param {string} xname
   */
  lines(lines, xname) {
    const xs = lines.flatMap((l) => l.x);
    const ys = lines.flatMap((l) => l.y).filter(Number.isFinite);
    if (!xs.length) return;
    const range = (/** @type {number[]} */ v) => /** @type {[number, number]} */ ([v.reduce((a, b) => Math.min(a, b)), v.reduce((a, b) => Math.max(a, b))]);
    const { out, px, py } = this.axes(range(xs), range(ys.length ? ys : [0, 1]), xname);
    let inside = out;
    lines.forEach((line, k) => {
      const color = line.color || ofObject(k);
      const points = line.x.map((x, i) => `${px(x).toFixed(1)},${py(line.y[i]).toFixed(1)}`).join(" ");
      inside += `<polyline points="${points}" fill="none" stroke="${color}" stroke-width="1.5"/>`;
    });
    inside += legend(lines.map((line, k) => [line.name, line.color || ofObject(k)]));
    this.put(inside);
    this.table = table(xname, lines);
  }

  /**
   * Parts that add up, above and below zero.
   * @param {string[]} names
   * @param {number[]} x
   * @param {number[][]} rows for each x a value of each name
   * @param {string} xname
   */
  stacked(names, x, rows, xname) {
    if (!x.length) return;
    const used = names.map((_, k) => k).filter((k) => rows.some((row) => Math.abs(row[k]) > 0));
    let [low, high] = [0, 0];
    const sums = rows.map((row) => {
      let [up, down] = [0, 0];
      const spans = used.map((k) => {
        const v = row[k];
        if (v >= 0) return [up, (up += v)];
        return [down, (down += v)];
      });
      [low, high] = [Math.min(low, down), Math.max(high, up)];
      return spans;
    });
    const { out, px, py } = this.axes([x[0], x[x.length - 1]], [low, high], xname);
    let inside = out;
    used.forEach((k, layer) => {
      const upper = x.map((t, i) => `${px(t).toFixed(1)},${py(sums[i][layer][1]).toFixed(1)}`);
      const lower = x.map((t, i) => `${px(t).toFixed(1)},${py(sums[i][layer][0]).toFixed(1)}`).reverse();
      inside += `<polygon points="${upper.concat(lower).join(" ")}" fill="${ofObject(layer)}" fill-opacity=".75"><title>${safe(names[k])}</title></polygon>`;
    });
    const total = x.map((t, i) => `${px(t).toFixed(1)},${py(rows[i].reduce((a, b) => a + b, 0)).toFixed(1)}`).join(" ");
    inside += `<polyline points="${total}" fill="none" stroke="var(--ink)" stroke-dasharray="3 2"/>`;
    inside += legend(used.map((k, layer) => /** @type {[string, string]} */ ([names[k], ofObject(layer)])).concat([["sum", "var(--ink)"]]));
    this.put(inside);
    this.table = [[xname, ...names, "sum"].join(","), ...x.map((t, i) => [t, ...rows[i], rows[i].reduce((a, b) => a + b, 0)].join(","))].join("\n") + "\n";
  }

  /**
   * A bar for each value.
   * @param {number[]} values
   * @param {string} xname
   */
  bars(values, xname) {
    const most = values.reduce((a, b) => Math.max(a, b), 0);
    const { out, px, py } = this.axes([-0.5, values.length - 0.5], [0, most || 1], xname);
    const wide = Math.max(1, 0.8 * (px(1) - px(0)));
    const bars = values.map((v, k) => `<rect x="${(px(k) - wide / 2).toFixed(1)}" y="${py(v).toFixed(1)}" width="${wide.toFixed(1)}" height="${(py(0) - py(v)).toFixed(1)}" fill="${ofObject(0)}"><title>${k}: ${short(v)}</title></rect>`);
    this.put(out + bars.join(""));
    this.table = [`${xname},value`, ...values.map((v, k) => `${k},${v}`)].join("\n") + "\n";
  }
}

/** @param {[string, string][]} entries */
function legend(entries) {
  return entries.map(([name, color], k) =>
    `<rect x="${LEFT + 6 + 88 * (k % 3)}" y="${TOP + 2 + 12 * Math.floor(k / 3)}" width="8" height="8" fill="${color}"/>` +
    `<text x="${LEFT + 17 + 88 * (k % 3)}" y="${TOP + 10 + 12 * Math.floor(k / 3)}" fill="var(--ink)">${safe(name)}</text>`).join("");
}

/**
 * @param {string} xname
 * @param {Line[]} lines
 */
function table(xname, lines) {
  const rows = lines.flatMap((line) => line.x.map((x, i) => `${line.name},${x},${line.y[i]}`));
  return [`line,${xname},value`, ...rows].join("\n") + "\n";
}

/**
 * Give the user a file.
 * @param {string} name
 * @param {Blob} blob
 */
export function download(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Colors of regimes: rings, mixed, creeps, zigzags, blows up. */
const REGIMES = ["#56b4e9", "#009e73", "#e69f00", "#cc79a7", "#7a1f1f"];

export class Atlas extends Plot {
  /**
   * @param {HTMLElement} parent
   * @param {(mass: number, damping: number, end: boolean) => void} move told where the present point is dragged to
   */
  constructor(parent, move) {
    super(parent, "Damping atlas");
    this.move = move;
    /** @type {any} */
    this.data = null;
    this.dragging = false;
    this.picture.tabIndex = 0;
    this.picture.setAttribute("role", "application");
    this.picture.setAttribute("aria-label", "Plane of mass and damping. Arrow keys move the present point.");
    const at = (/** @type {PointerEvent} */ event) => {
      const box = this.picture.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * WIDTH;
      const y = ((event.clientY - box.top) / box.height) * HEIGHT;
      return this.values(x, y);
    };
    this.picture.onpointerdown = (event) => {
      if (!this.data) return;
      this.dragging = true;
      this.picture.setPointerCapture(event.pointerId);
      this.set(at(event), false);
    };
    this.picture.onpointermove = (event) => {
      if (this.dragging) this.set(at(event), false);
    };
    this.picture.onpointerup = (event) => {
      if (!this.dragging) return;
      this.dragging = false;
      this.set(at(event), true);
    };
    this.picture.onkeydown = (event) => {
      const way = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [0.9, 1], ArrowRight: [1.11, 1], ArrowUp: [1, 1.11], ArrowDown: [1, 0.9] })[event.key];
      if (!way || !this.data) return;
      event.preventDefault();
      event.stopPropagation();
      const [m, d] = this.data.now;
      this.set([m * way[0], Math.max(d, this.data.critical * 1e-3) * way[1]], true);
    };
  }

  /**
   * @param {[number, number]} to
   * @param {boolean} end
   */
  set([mass, damping], end) {
    this.data.now = [mass, damping];
    this.draw(this.data);
    this.move(mass, damping, end);
  }

  /**
   * Mass and damping at a place of the drawing.
   * @param {number} x
   * @param {number} y
   * @returns {[number, number]}
   */
  values(x, y) {
    const share = (/** @type {number} */ v, /** @type {number} */ a, /** @type {number} */ b) => Math.min(Math.max((v - a) / (b - a), 0), 1);
    const { mass, damping } = this.data;
    const u = share(x, LEFT, WIDTH - RIGHT);
    const v = share(y, HEIGHT - BOTTOM, TOP);
    return [mass[0] * (mass[1] / mass[0]) ** u, damping[0] * (damping[1] / damping[0]) ** v];
  }

  /** @param {any} data */
  draw(data) {
    this.data = data;
    const { columns, rows, cells, mass, damping, now, regimes } = data;
    const [w, h] = [(WIDTH - LEFT - RIGHT) / columns, (HEIGHT - TOP - BOTTOM) / rows];
    let out = "";
    for (let r = 0; r < rows; r++) {
      // neighbors of one kind as one rectangle
      for (let c = 0; c < columns;) {
        const kind = cells[r * columns + c];
        let end = c + 1;
        while (end < columns && cells[r * columns + end] === kind) end++;
        out += `<rect x="${(LEFT + c * w).toFixed(2)}" y="${(HEIGHT - BOTTOM - (r + 1) * h).toFixed(2)}" width="${((end - c) * w + 0.3).toFixed(2)}" height="${(h + 0.3).toFixed(2)}" fill="${REGIMES[kind]}" fill-opacity=".8"/>`;
        c = end;
      }
    }
    const px = LEFT + (Math.log(now[0] / mass[0]) / Math.log(mass[1] / mass[0])) * (WIDTH - LEFT - RIGHT);
    const share = Math.max(0, Math.log(Math.max(now[1], damping[0]) / damping[0]) / Math.log(damping[1] / damping[0]));
    const py = HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM);
    out += `<circle cx="${px}" cy="${py}" r="6" fill="var(--paper)" stroke="var(--ink)" stroke-width="2.5"/>`;
    const corner = (/** @type {number} */ v) => short(v);
    out += `<text x="${LEFT}" y="${HEIGHT - 10}" fill="var(--soft)">${corner(mass[0])}</text><text x="${WIDTH - RIGHT}" y="${HEIGHT - 10}" text-anchor="end" fill="var(--soft)">mass μ ${corner(mass[1])}</text>`;
    out += `<text x="${LEFT - 4}" y="${HEIGHT - BOTTOM}" text-anchor="end" fill="var(--soft)">${corner(damping[0])}</text><text x="${LEFT - 4}" y="${TOP + 8}" text-anchor="end" fill="var(--soft)">γ ${corner(damping[1])}</text>`;
    this.put(out);
    this.table = ["mass,damping,regime", ...cells.map((/** @type {number} */ k, /** @type {number} */ i) => {
      const [c, r] = [i % columns, Math.floor(i / columns)];
      return [mass[0] * (mass[1] / mass[0]) ** ((c + 0.5) / columns), damping[0] * (damping[1] / damping[0]) ** ((r + 0.5) / rows), `"${regimes[k]}"`].join(",");
    })].join("\n") + "\n";
  }
}

/** What the colors of the atlas mean. @param {string[]} regimes */
export function regimeLegend(regimes) {
  return regimes.map((words, k) => `<span><span class="chip" style="background:${REGIMES[k]}"></span>${safe(words)}</span>`).join("<br>");
}

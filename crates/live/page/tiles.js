// The picture as tiles, fetched as they come into sight and kept while there is room.

/** Pixels of a tile along each side, and tiles that are kept. */
const SIDE = 256;
const MOST = 320;

export class Tiles {
  /**
   * @param {import("./socket.js").Engine} engine
   * @param {() => void} redraw
   */
  constructor(engine, redraw) {
    this.engine = engine;
    this.redraw = redraw;
    /** @type {Map<string, {bitmap: ImageBitmap | null, used: number}>} */
    this.kept = new Map();
    /** @type {[number, number] | null} */
    this.size = null;
    this.tones = [0, 255, 1];
    this.version = 0;
    this.turn = 0;
    this.key = "";
    /** @type {Map<string, {bitmap: ImageBitmap | null, used: number}> | null} */
    this.stale = null;
    /** @type {[number, number] | null} */
    this.last = null;
    this.asked = 0;
  }

  /**
   * Another picture, or the same with another part that counts.
   * @param {[number, number] | null} size
   * @param {string} version
   */
  open(size, version) {
    const key = JSON.stringify([size, version]);
    if (key === this.key) return;
    this.key = key;
    this.size = size;
    // tiles of the picture before are shown until those of this one are there
    this.stale = size && this.last && this.last[0] === size[0] && this.last[1] === size[1] ? this.kept : null;
    this.last = size;
    this.kept = new Map();
    this.version++;
  }

  /** @param {number[]} tones */
  tone(tones) {
    if (tones.every((t, i) => t === this.tones[i])) return;
    this.tones = tones;
    this.stale = this.kept;
    this.kept = new Map();
    this.version++;
    this.redraw();
  }

  /**
   * @param {CanvasRenderingContext2D} to
   * @param {import("./camera.js").Camera} camera
   */
  draw(to, camera) {
    if (!this.size) return;
    this.turn++;
    const [width, height] = this.size;
    const level = Math.max(0, Math.min(16, Math.floor(Math.log2(1 / (camera.scale * devicePixelRatio)) + 0.5)));
    const span = SIDE * 2 ** level;
    const [[left, top], [right, bottom]] = camera.seen();
    const first = [Math.max(0, Math.floor((left + 0.5) / span)), Math.max(0, Math.floor((top + 0.5) / span))];
    const last = [
      Math.min(Math.ceil(width / span) - 1, Math.floor((right + 0.5) / span)),
      Math.min(Math.ceil(height / span) - 1, Math.floor((bottom + 0.5) / span)),
    ];
    to.imageSmoothingEnabled = camera.scale < 1;
    const one = (/** @type {ImageBitmap} */ bitmap, /** @type {number} */ l, /** @type {number} */ x, /** @type {number} */ y) => {
      const s = SIDE * 2 ** l;
      const [a, b] = [camera.screen(x * s - 0.5, y * s - 0.5), camera.screen((x + 1) * s - 0.5, (y + 1) * s - 0.5)];
      to.save();
      if (camera.up) {
        to.translate(a[0], a[1]);
        to.scale(1, -1);
        to.drawImage(bitmap, 0, 0, b[0] - a[0], a[1] - b[1]);
      } else {
        to.drawImage(bitmap, a[0], a[1], b[0] - a[0], b[1] - a[1]);
      }
      to.restore();
    };
    for (let y = first[1]; y <= last[1]; y++) {
      for (let x = first[0]; x <= last[0]; x++) {
        const kept = this.kept.get(`${level} ${x} ${y}`);
        if (kept && kept.bitmap) {
          kept.used = this.turn;
          one(kept.bitmap, level, x, y);
          continue;
        }
        const old = this.stale && this.stale.get(`${level} ${x} ${y}`);
        if (old && old.bitmap) one(old.bitmap, level, x, y);
        else {
          // a coarser one meanwhile
          for (let up = 1; up <= 4; up++) {
            const coarse = this.kept.get(`${level + up} ${x >> up} ${y >> up}`);
            if (coarse && coarse.bitmap) {
              to.save();
              to.beginPath();
              const [a, b] = [camera.screen(x * span - 0.5, y * span - 0.5), camera.screen((x + 1) * span - 0.5, (y + 1) * span - 0.5)];
              to.rect(a[0], a[1], b[0] - a[0], b[1] - a[1]);
              to.clip();
              one(coarse.bitmap, level + up, x >> up, y >> up);
              to.restore();
              break;
            }
          }
        }
        this.fetch(level, x, y);
      }
    }
    this.drop();
  }

  /**
   * @param {number} level
   * @param {number} x
   * @param {number} y
   */
  async fetch(level, x, y) {
    const key = `${level} ${x} ${y}`;
    if (this.kept.has(key) || this.asked > 5) return;
    const [kept, [low, high, gamma]] = [this.kept, this.tones];
    const tile = { bitmap: /** @type {ImageBitmap | null} */ (null), used: this.turn };
    kept.set(key, tile);
    this.asked++;
    try {
      const answer = await this.engine.call({ ask: { kind: "tile", level, x, y, low, high, gamma } });
      const pixels = new Uint8ClampedArray(answer.rest.slice().buffer, 0, 4 * SIDE * SIDE);
      tile.bitmap = await createImageBitmap(new ImageData(pixels, SIDE, SIDE));
    } catch {
      kept.delete(key);
    } finally {
      this.asked--;
      this.redraw();
    }
  }

  drop() {
    if (this.kept.size <= MOST) return;
    const old = [...this.kept.entries()].sort((a, b) => a[1].used - b[1].used);
    for (const [key, tile] of old.slice(0, this.kept.size - MOST)) {
      if (tile.used === this.turn || !tile.bitmap) continue;
      tile.bitmap.close();
      this.kept.delete(key);
    }
  }
}

// From the world to the screen and back: where one looks, and how closely.

/** @typedef {[number, number]} Pair */

export class Camera {
  constructor() {
    /** The world's place in the middle of the screen. */
    this.middle = /** @type {Pair} */ ([0, 0]);
    /** Pixels of the screen for one of the world. */
    this.scale = 1;
    /** Whether y grows upwards. */
    this.up = false;
    /** Size of the screen. */
    this.size = /** @type {Pair} */ ([1, 1]);
  }

  /**
   * A place on the screen.
   * @param {number} x
   * @param {number} y
   * @returns {Pair}
   */
  screen(x, y) {
    const sense = this.up ? -1 : 1;
    return [
      this.size[0] / 2 + (x - this.middle[0]) * this.scale,
      this.size[1] / 2 + sense * (y - this.middle[1]) * this.scale,
    ];
  }

  /**
   * The place in the world of one on the screen.
   * @param {number} x
   * @param {number} y
   * @returns {Pair}
   */
  world(x, y) {
    const sense = this.up ? -1 : 1;
    return [
      this.middle[0] + (x - this.size[0] / 2) / this.scale,
      this.middle[1] + (sense * (y - this.size[1] / 2)) / this.scale,
    ];
  }

  /**
   * Show all of a rectangle.
   * @param {[Pair, Pair]} corners
   */
  show([[a, b], [c, d]]) {
    const width = Math.max(Math.abs(c - a), 1e-9);
    const height = Math.max(Math.abs(d - b), 1e-9);
    this.middle = /** @type {Pair} */ ([(a + c) / 2, (b + d) / 2]);
    this.scale = 0.94 * Math.min(this.size[0] / width, this.size[1] / height);
  }

  /**
   * Look more closely, or less, about a place on the screen that stays.
   * @param {number} factor
   * @param {Pair} about
   */
  zoom(factor, about) {
    const before = this.world(...about);
    this.scale = Math.min(Math.max(this.scale * factor, 1e-6), 1e6);
    const after = this.world(...about);
    this.middle = /** @type {Pair} */ ([this.middle[0] + before[0] - after[0], this.middle[1] + before[1] - after[1]]);
  }

  /**
   * Move what one sees by so many pixels of the screen.
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    const sense = this.up ? -1 : 1;
    this.middle = /** @type {Pair} */ ([this.middle[0] - dx / this.scale, this.middle[1] - (sense * dy) / this.scale]);
  }

  /**
   * The corners of the world that are seen, the lower first.
   * @returns {[Pair, Pair]}
   */
  seen() {
    const [a, b] = [this.world(0, 0), this.world(...this.size)];
    return [
      [Math.min(a[0], b[0]), Math.min(a[1], b[1])],
      [Math.max(a[0], b[0]), Math.max(a[1], b[1])],
    ];
  }
}

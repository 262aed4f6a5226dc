// What the pointer does: tools for scenes and for pictures.

import { floats } from "./packet.js";

/** @typedef {import("./main.js").App} App */
/** @typedef {[number, number]} Pair */

/**
 * A tool: its name, key, and what it is for.
 * @typedef {{name: string, key: string, words: string, hint: string}} Tool
 */

/** @type {Record<string, Tool[]>} */
export const TOOLS = {
  scene: [
    { name: "hand", key: "h", words: "Hand", hint: "Take a curve and pull it by a spring; let go while you move, and it flies." },
    { name: "pin", key: "p", words: "Pin", hint: "Click a node to hold it where it is; once more to let it go." },
    { name: "push", key: "u", words: "Push", hint: "Press: everything near the pointer is pushed away." },
    { name: "throw", key: "w", words: "Throw", hint: "Drag from a snake: it gets that velocity." },
    { name: "ball", key: "b", words: "Add a ball", hint: "Draw around: one more ball of that outline." },
    { name: "wall", key: "l", words: "Wall", hint: "Drag to draw a wall: things stay on the left of it. Drag a wall near its line to move it." },
    { name: "gravity", key: "g", words: "Gravity", hint: "Drag: the arrow is gravity. A click turns it off." },
    { name: "erase", key: "e", words: "Erase", hint: "Click a snake or a wall to take it away." },
    { name: "look", key: "k", words: "Look around", hint: "Drag to move what you see." },
  ],
  picture: [
    { name: "click", key: "i", words: "Click", hint: "Click inside an object: its outline is found." },
    { name: "spline", key: "s", words: "Curve", hint: "Click around an object; double click or Enter ends the curve. Escape gives it up." },
    { name: "line", key: "d", words: "Draw", hint: "Draw around an object by hand." },
    { name: "box", key: "b", words: "Box", hint: "Drag a box around an object." },
    { name: "ellipse", key: "o", words: "Ellipse", hint: "Drag an ellipse around an object." },
    { name: "mend", key: "m", words: "Mend", hint: "Take a stretch and pull it by a spring; it settles on the edge where you let go." },
    { name: "pin", key: "p", words: "Pin", hint: "Click a node to hold it; once more to let it go." },
    { name: "freeze", key: "f", words: "Freeze", hint: "Drag along an outline: that stretch stays where it is." },
    { name: "not-edge", key: "x", words: "Not this edge", hint: "Click an edge: it no longer pulls, and outlines on it are found anew." },
    { name: "forbid", key: "u", words: "Keep out", hint: "Drag a disc that outlines stay out of." },
    { name: "redraw", key: "e", words: "Redraw", hint: "Draw from one place of an outline to another: that stretch is new." },
    { name: "cut", key: "c", words: "Cut", hint: "Drag from one place of an outline to another: it becomes two." },
    { name: "join", key: "j", words: "Join", hint: "Drag from one outline to another that overlaps it: they become one." },
    { name: "add-node", key: "n", words: "Add node", hint: "Click an outline between two nodes." },
    { name: "drop-node", key: "q", words: "Drop node", hint: "Click a node to take it out." },
    { name: "erase", key: "y", words: "Erase", hint: "Click an outline to take it away." },
    { name: "look", key: "k", words: "Look around", hint: "Drag to move what you see." },
  ],
  empty: [],
};

/** How near on the screen a curve is meant. */
const NEAR = 14;

/** Length of the stretch that follows the hand, on the screen at the least and in pixels of the picture. */
const STRETCH = 24;

/**
 * The curve and the node nearest to a place on the screen.
 * @param {App} app
 * @param {Pair} at
 * @param {number} [near]
 * @returns {{id: number, node: number, far: number} | null}
 */
export function nearest(app, at, near = NEAR) {
  const curves = app.kind === "scene" ? app.scene && app.scene.snakes : app.picture && app.picture.outlines;
  /** @type {{id: number, node: number, far: number} | null} */
  let best = null;
  for (const { id, points } of curves || []) {
    for (let i = 0; i < points.length; i += 2) {
      const [x, y] = app.camera.screen(points[i], points[i + 1]);
      const far = Math.hypot(x - at[0], y - at[1]);
      if (far < near && (!best || far < best.far)) best = { id, node: i / 2, far };
    }
  }
  return best;
}

/**
 * The closed curve that a place of the world is in.
 * @param {App} app
 * @param {Pair} at
 */
function inside(app, [px, py]) {
  const curves = app.kind === "scene" ? app.scene && app.scene.snakes : app.picture && app.picture.outlines;
  for (const { id, points, closed } of curves || []) {
    if (!closed) continue;
    let odd = false;
    const n = points.length;
    for (let i = 0, j = n - 2; i < n; j = i, i += 2) {
      const [ax, ay, bx, by] = [points[i], points[i + 1], points[j], points[j + 1]];
      if (ay > py !== by > py && px < ax + ((py - ay) / (by - ay)) * (bx - ax)) odd = !odd;
    }
    if (odd) return id;
  }
  return null;
}

/**
 * The wall nearest to a place on the screen.
 * @param {App} app
 * @param {Pair} at
 */
function wallAt(app, at) {
  const [x, y] = app.camera.world(...at);
  let best = -1;
  let far = NEAR / app.camera.scale;
  app.scene.walls.forEach((/** @type {any} */ { point, normal }, /** @type {number} */ k) => {
    const away = Math.abs((x - point[0]) * normal[0] + (y - point[1]) * normal[1]);
    if (away < far) [best, far] = [k, away];
  });
  return best;
}

/** What the pointer does now. */
export class Hand {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {any} */
    this.held = null;
    /** @type {Pair[]} */
    this.drawn = [];
    /** @type {Pair[]} */
    this.clicks = [];
  }

  /** Give up what is half done. */
  stop() {
    this.held = null;
    this.drawn = [];
    this.clicks = [];
    this.app.preview = null;
    this.app.redraw();
  }

  /** @param {Pair} at a place on the screen */
  down(at) {
    const { app } = this;
    const world = app.camera.world(...at);
    const near = nearest(app, at);
    const tool = app.tool;
    if (app.kind === "scene") this.downScene(tool, at, world, near);
    else if (app.kind === "picture") this.downPicture(tool, at, world, near);
  }

  /**
   * @param {string} tool
   * @param {Pair} at
   * @param {Pair} world
   * @param {{id: number, node: number} | null} near
   */
  downScene(tool, at, world, near) {
    const { app } = this;
    const body = (/** @type {any} */ change, end = true) => app.act({ kind: "body", ...change }, end);
    if (tool === "hand") {
      let found = near || nearest(app, at, 60);
      const within = inside(app, world);
      if (!near && within !== null) found = nearestOf(app, within, at);
      if (!found) return;
      app.choose(found.id);
      this.held = { tool, snake: found.id, node: found.node };
      if (!app.playing) app.say("It stands still: Run, or Space, and it follows the hand.");
      body({ do: "drag", snake: found.id, node: found.node, to: world }, false);
    } else if (tool === "pin" && near) {
      const one = app.scene.snakes.find((/** @type {any} */ s) => s.id === near.id);
      const pinned = (one.pins || []).includes(near.node);
      body({ do: pinned ? "unpin" : "pin", snake: near.id, node: near.node });
    } else if (tool === "push") {
      this.held = { tool, reach: 70 / app.camera.scale };
      body({ do: "push", at: world, reach: this.held.reach }, false);
    } else if (tool === "throw") {
      const id = near ? near.id : inside(app, world);
      if (id !== null) this.held = { tool, snake: id, from: world };
    } else if (tool === "ball") {
      this.held = { tool };
      this.drawn = [world];
    } else if (tool === "wall") {
      const index = wallAt(app, at);
      this.held = { tool, from: world, index };
      this.drawn = [world];
    } else if (tool === "gravity") {
      this.held = { tool, from: world };
    } else if (tool === "erase") {
      const id = near ? near.id : inside(app, world);
      if (id !== null) body({ do: "delete", snake: id });
      else {
        const index = wallAt(app, at);
        if (index >= 0) body({ do: "no-wall", index });
      }
    }
  }

  /**
   * @param {string} tool
   * @param {Pair} at
   * @param {Pair} world
   * @param {{id: number, node: number} | null} near
   */
  downPicture(tool, at, world, near) {
    const { app } = this;
    const outline = (/** @type {any} */ change, end = true) => app.act({ kind: "outline", ...change }, end);
    if (tool === "click") {
      const [width, height] = app.about.size;
      if (world[0] < -0.5 || world[1] < -0.5 || world[0] > width - 0.5 || world[1] > height - 0.5) {
        app.say("Click inside the picture.");
        return;
      }
      outline({ do: "start", drawn: "click", points: [world] });
    } else if (tool === "spline") {
      const last = this.clicks[this.clicks.length - 1];
      const again = last && Math.hypot(...minus(app.camera.screen(...last), at)) < 4;
      const first = this.clicks.length > 2 && Math.hypot(...minus(app.camera.screen(...this.clicks[0]), at)) < 8;
      if (again || first) this.finish();
      else {
        this.clicks.push(world);
        this.preview("spline", this.clicks);
      }
    } else if (["line", "box", "ellipse", "forbid"].includes(tool)) {
      this.held = { tool, from: world };
      this.drawn = [world];
    } else if (tool === "mend") {
      const found = near || nearest(app, at, 40);
      if (!found) return;
      app.choose(found.id);
      const reach = Math.max(STRETCH, 48 / app.camera.scale);
      this.held = { tool, id: found.id, node: found.node, reach };
      outline({ do: "drag", id: found.id, node: found.node, to: world, reach }, false);
    } else if (tool === "pin" && near) {
      const one = app.picture.outlines.find((/** @type {any} */ o) => o.id === near.id);
      app.choose(near.id);
      outline({ do: one.pins.includes(near.node) ? "unpin" : "pin", id: near.id, node: near.node });
    } else if (["freeze", "redraw", "cut", "join"].includes(tool)) {
      const found = near || nearest(app, at, 30);
      if (!found) return;
      app.choose(found.id);
      this.held = { tool, id: found.id, node: found.node };
      this.drawn = [world];
    } else if (tool === "not-edge") {
      outline({ do: "not-this-edge", at: world, reach: Math.max(20, 60 / app.camera.scale) });
    } else if (tool === "add-node" && near) {
      outline({ do: "add-node", id: near.id, node: near.node });
    } else if (tool === "drop-node" && near) {
      outline({ do: "delete-node", id: near.id, node: near.node });
    } else if (tool === "erase") {
      const id = near ? near.id : inside(app, world);
      if (id !== null) outline({ do: "delete", id });
    } else if (near) {
      app.choose(near.id);
    }
  }

  /** @param {Pair} at a place on the screen */
  move(at) {
    const { app, held } = this;
    const world = app.camera.world(...at);
    if (app.kind === "picture" && !held) {
      const near = nearest(app, at, 10);
      if (near && app.pictures) app.pictures.over(near.id, near.node);
      if (app.tool === "spline" && this.clicks.length) this.preview("spline", [...this.clicks, world]);
    }
    if (!held) return;
    if (held.tool === "hand") app.act({ kind: "body", do: "drag", snake: held.snake, node: held.node, to: world }, false);
    else if (held.tool === "mend") app.act({ kind: "outline", do: "drag", id: held.id, node: held.node, to: world, reach: held.reach }, false);
    else if (held.tool === "push") app.act({ kind: "body", do: "push", at: world, reach: held.reach }, false);
    else if (held.tool === "gravity") this.gravity(held.from, world, false);
    else if (held.tool === "wall" && held.index >= 0) {
      const { normal } = app.scene.walls[held.index];
      app.act({ kind: "body", do: "wall", index: held.index, point: world, normal }, false);
    } else if (held.tool === "box" || held.tool === "ellipse") this.preview(held.tool, [held.from, world]);
    else if (held.tool === "forbid") {
      const radius = Math.hypot(world[0] - held.from[0], world[1] - held.from[1]);
      this.preview("ellipse", [[held.from[0] - radius, held.from[1] - radius], [held.from[0] + radius, held.from[1] + radius]]);
    } else {
      const last = this.drawn[this.drawn.length - 1];
      if (["throw", "cut", "join", "wall"].includes(held.tool)) this.drawn = [this.drawn[0] || held.from, world];
      else if (!last || Math.hypot(world[0] - last[0], world[1] - last[1]) * app.camera.scale > 3) this.drawn.push(world);
      app.preview = { points: this.drawn.flat(), closed: held.tool === "line" || held.tool === "ball", clicks: [] };
      app.redraw();
    }
  }

  /** @param {Pair} at a place on the screen */
  up(at) {
    const { app, held } = this;
    if (!held) return;
    const world = app.camera.world(...at);
    const body = (/** @type {any} */ change) => app.act({ kind: "body", ...change });
    const outline = (/** @type {any} */ change) => app.act({ kind: "outline", ...change });
    const drawn = this.drawn;
    this.held = null;
    this.drawn = [];
    app.preview = null;
    app.redraw();
    if (held.tool === "hand") body({ do: "drop" });
    else if (held.tool === "mend") outline({ do: "drop" });
    else if (held.tool === "push") body({ do: "leave" });
    else if (held.tool === "gravity") this.gravity(held.from, world, true);
    else if (held.tool === "throw") {
      // as far as drawn in a quarter of a second of looking
      const rate = 4 / Math.max(app.scene.rate, 1e-12);
      body({ do: "throw", snake: held.snake, velocity: [(world[0] - held.from[0]) * rate, (world[1] - held.from[1]) * rate] });
    } else if (held.tool === "ball" && drawn.length > 4) body({ do: "ball", points: drawn });
    else if (held.tool === "wall" && held.index < 0) {
      const [dx, dy] = minus(world, held.from);
      if (Math.hypot(dx, dy) * app.camera.scale > 12) body({ do: "wall", index: null, point: held.from, normal: app.camera.up ? [-dy, dx] : [dy, -dx] });
    } else if (held.tool === "line" && drawn.length > 4) outline({ do: "start", drawn: "line", points: drawn });
    else if (held.tool === "box" || held.tool === "ellipse") {
      if (Math.abs(world[0] - held.from[0]) > 2 && Math.abs(world[1] - held.from[1]) > 2) outline({ do: "start", drawn: held.tool, points: [held.from, world] });
    } else if (held.tool === "forbid") {
      const radius = Math.max(Math.hypot(world[0] - held.from[0], world[1] - held.from[1]), 3 / app.camera.scale);
      outline({ do: "forbid", at: held.from, radius });
    } else if (["freeze", "redraw", "cut", "join"].includes(held.tool)) this.endAt(held, at, drawn);
  }

  /**
   * @param {any} held
   * @param {Pair} at
   * @param {Pair[]} drawn
   */
  endAt(held, at, drawn) {
    const { app } = this;
    if (held.tool === "join") {
      const other = nearest(app, at, 30);
      const id = other && other.id !== held.id ? other.id : inside(app, app.camera.world(...at));
      if (id !== null && id !== held.id) app.act({ kind: "outline", do: "join", id: held.id, other: id });
      return;
    }
    const end = nearestOf(app, held.id, at);
    if (!end || end.node === held.node) return;
    const one = app.picture.outlines.find((/** @type {any} */ o) => o.id === held.id);
    const n = one.points.length / 2;
    // the shorter way round
    const [from, to] = one.closed && (end.node - held.node + n) % n > n / 2 ? [end.node, held.node] : [held.node, end.node];
    const turned = from !== held.node;
    if (held.tool === "freeze") app.act({ kind: "outline", do: "freeze", id: held.id, from, to });
    else if (held.tool === "cut") app.act({ kind: "outline", do: "cut", id: held.id, from, to });
    else app.act({ kind: "outline", do: "redraw", id: held.id, from, to, points: turned ? [...drawn].reverse() : drawn });
  }

  /**
   * @param {Pair} from
   * @param {Pair} to
   * @param {boolean} end
   */
  gravity(from, to, end) {
    const { app } = this;
    const long = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (long * app.camera.scale < 6) {
      if (end) app.act({ kind: "body", do: "gravity", g: [0, 0] });
      return;
    }
    // falls as far as drawn in a second of looking
    const rate = 2 / Math.max(app.scene.rate, 1e-12) ** 2;
    app.act({ kind: "body", do: "gravity", g: [(to[0] - from[0]) * rate, (to[1] - from[1]) * rate] }, end);
  }

  /** A curve of clicks is at its end. */
  finish() {
    const clicks = this.clicks;
    this.clicks = [];
    this.app.preview = null;
    this.app.redraw();
    if (clicks.length >= 3) this.app.act({ kind: "outline", do: "start", drawn: "spline", points: clicks });
  }

  /** Take the last click back. */
  unclick() {
    this.clicks.pop();
    if (this.clicks.length) this.preview("spline", this.clicks);
    else this.stop();
  }

  /**
   * Show a start as it will be.
   * @param {string} drawn
   * @param {Pair[]} points
   */
  async preview(drawn, points) {
    const { app } = this;
    const clicks = drawn === "spline" ? points : [];
    if (drawn === "spline" && points.length < 3) {
      app.preview = { points: points.flat(), closed: false, clicks };
      app.redraw();
      return;
    }
    try {
      const answer = await app.engine.call({ ask: { kind: "preview", drawn, points } });
      if (!this.held && !this.clicks.length) return;
      app.preview = { points: floats(answer, answer.head.ok.x, 2), closed: answer.head.ok.closed, clicks };
      app.redraw();
    } catch {
      // two clicks in one place: the next place makes a curve
    }
  }
}

/**
 * The node of a curve nearest to a place on the screen.
 * @param {App} app
 * @param {number} id
 * @param {Pair} at
 */
function nearestOf(app, id, at) {
  const curves = app.kind === "scene" ? app.scene.snakes : app.picture.outlines;
  const one = curves.find((/** @type {any} */ c) => c.id === id);
  if (!one) return null;
  let best = { id, node: 0, far: Infinity };
  for (let i = 0; i < one.points.length; i += 2) {
    const far = Math.hypot(...minus(app.camera.screen(one.points[i], one.points[i + 1]), at));
    if (far < best.far) best = { id, node: i / 2, far };
  }
  return best;
}

/**
 * @param {Pair} a
 * @param {Pair} b
 * @returns {Pair}
 */
const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];

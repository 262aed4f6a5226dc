// What is open, drawn: curves, walls, forces, outlines, the hand.

import { ofObject, ofPage, ofStrength } from "./colors.js";

/** @typedef {import("./main.js").App} App */
/** @typedef {[number, number]} Pair */

/** Half the width of an error band at most, in pixels of the picture: beyond it nothing is known. */
const WIDEST = 8;

/** Moments of a trail. */
const TRAIL = 240;

/** Steps from weak to strong that are drawn in colors of their own. */
const LEVELS = 16;

/**
 * Draw everything.
 * @param {App} app
 */
export function draw(app) {
  const { canvas, camera } = app;
  const to = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const ratio = devicePixelRatio;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  camera.size = [width, height];
  to.setTransform(ratio, 0, 0, ratio, 0, 0);
  to.clearRect(0, 0, width, height);
  app.tiles.draw(to, camera);
  if (app.show.field) field(to, app);
  if (app.kind === "scene" && app.scene) scene(to, app);
  if (app.kind === "picture" && app.picture) picture(to, app);
  if (app.cursor) cursor(to, app);
}

/**
 * A path through places of the world.
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {ArrayLike<number>} x pairs
 * @param {boolean} closed
 */
function path(to, app, x, closed) {
  to.beginPath();
  for (let i = 0; i < x.length; i += 2) {
    const [a, b] = app.camera.screen(x[i], x[i + 1]);
    if (i === 0) to.moveTo(a, b);
    else to.lineTo(a, b);
  }
  if (closed) to.closePath();
}

/**
 * An arrow on the screen.
 * @param {CanvasRenderingContext2D} to
 * @param {Pair} from
 * @param {Pair} way pixels of the screen
 */
function arrow(to, [x, y], [dx, dy]) {
  const long = Math.hypot(dx, dy);
  if (!(long > 1)) return;
  const head = Math.min(6, 0.4 * long);
  const [ux, uy] = [dx / long, dy / long];
  to.beginPath();
  to.moveTo(x, y);
  to.lineTo(x + dx, y + dy);
  to.lineTo(x + dx - head * (ux - 0.5 * uy), y + dy - head * (uy + 0.5 * ux));
  to.moveTo(x + dx, y + dy);
  to.lineTo(x + dx - head * (ux + 0.5 * uy), y + dy - head * (uy - 0.5 * ux));
  to.stroke();
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 */
function field(to, app) {
  const arrows = app.arrows;
  if (!arrows || !arrows.most) return;
  const { camera } = app;
  const sense = camera.up ? -1 : 1;
  const step = arrows.at.length > 3 ? Math.abs(arrows.at[2] - arrows.at[0]) * camera.scale : 16;
  for (let i = 0; i < arrows.at.length; i += 2) {
    const [fx, fy] = [arrows.f[i], arrows.f[i + 1]];
    const share = Math.hypot(fx, fy) / arrows.most;
    if (share < 0.004) continue;
    // lengths by the root, so that weak forces are seen; magnitude by color
    const long = (0.95 * step * Math.sqrt(share)) / (share * arrows.most);
    to.strokeStyle = ofStrength(0.15 + 0.85 * Math.sqrt(share));
    to.lineWidth = 1.2;
    arrow(to, camera.screen(arrows.at[i], arrows.at[i + 1]), [fx * long, sense * fy * long]);
  }
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 */
function scene(to, app) {
  const { camera, scene, show } = app;
  if (!scene) return;
  const [ink, soft, bad, accent] = ["--ink", "--soft", "--bad", "--accent"].map(ofPage);
  const sense = camera.up ? -1 : 1;
  walls(to, app, soft);
  if (show.trails) {
    to.lineWidth = 1;
    for (const [id, trail] of app.trails) {
      to.strokeStyle = ofObject(id);
      to.globalAlpha = 0.55;
      path(to, app, trail, false);
      to.stroke();
    }
    to.globalAlpha = 1;
  }
  for (const one of scene.snakes) {
    const color = ofObject(one.id);
    path(to, app, one.points, one.closed);
    if (one.closed) {
      to.fillStyle = color;
      to.globalAlpha = scene.hasPicture ? 0 : 0.13;
      to.fill();
      to.globalAlpha = 1;
    }
    to.lineJoin = "round";
    to.strokeStyle = scene.hasPicture ? "rgb(255 255 255 / .75)" : "transparent";
    to.lineWidth = 4;
    to.stroke();
    to.strokeStyle = color;
    to.lineWidth = app.chosen === one.id ? 3 : 2;
    to.stroke();
    const spaced = one.points.length > 2
      ? Math.hypot(one.points[2] - one.points[0], one.points[3] - one.points[1]) * camera.scale : 0;
    if (show.nodes || spaced > 7) {
      to.fillStyle = color;
      for (let i = 0; i < one.points.length; i += 2) {
        const [x, y] = camera.screen(one.points[i], one.points[i + 1]);
        to.beginPath();
        to.arc(x, y, 2.2, 0, 7);
        to.fill();
        if (show.numbers) {
          to.fillStyle = ink;
          to.font = "10px system-ui";
          to.fillText(String(i / 2), x + 4, y - 4);
          to.fillStyle = color;
        }
      }
    }
    for (const pin of one.pins || []) {
      const [x, y] = camera.screen(one.points[2 * pin], one.points[2 * pin + 1]);
      to.fillStyle = bad;
      to.fillRect(x - 4, y - 4, 8, 8);
    }
    if (show.center) {
      const [x, y] = camera.screen(one.center[0], one.center[1]);
      to.strokeStyle = ink;
      to.lineWidth = 1;
      to.beginPath();
      to.moveTo(x - 5, y);
      to.lineTo(x + 5, y);
      to.moveTo(x, y - 5);
      to.lineTo(x, y + 5);
      to.stroke();
    }
    if (show.velocities && one.velocities) vectors(to, app, one.points, one.velocities, app.scales.velocity, accent);
    if (show.forces && one.forces) {
      one.forces.forEach((/** @type {any} */ force, /** @type {number} */ k) => {
        vectors(to, app, one.points, force.f, app.scales.force, ofObject(k + 4));
      });
    }
  }
  gravity(to, app, soft);
  if (scene.drag) {
    const held = scene.snakes.find((/** @type {any} */ s) => s.id === scene.drag.snake);
    if (held) {
      const a = camera.screen(held.points[2 * scene.drag.node], held.points[2 * scene.drag.node + 1]);
      spring(to, a, camera.screen(scene.drag.to[0], scene.drag.to[1]), accent);
    }
  }
  if (scene.push) {
    const [x, y] = camera.screen(scene.push.at[0], scene.push.at[1]);
    to.strokeStyle = accent;
    to.setLineDash([4, 4]);
    to.beginPath();
    to.arc(x, y, scene.push.reach * camera.scale, 0, 7);
    to.stroke();
    to.setLineDash([]);
  }
  if (scene.end && scene.end.node) {
    const [x, y] = camera.screen(scene.end.node[1][0], scene.end.node[1][1]);
    to.strokeStyle = bad;
    to.lineWidth = 3;
    to.beginPath();
    to.arc(x, y, 12, 0, 7);
    to.stroke();
  }
  void sense;
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {string} color
 */
function walls(to, app, color) {
  const { camera } = app;
  const far = 2 * Math.hypot(...camera.size) / camera.scale;
  to.strokeStyle = color;
  for (const { point, normal } of app.scene.walls) {
    const along = [-normal[1], normal[0]];
    // the part of the line next to what is seen
    const t = (camera.middle[0] - point[0]) * along[0] + (camera.middle[1] - point[1]) * along[1];
    const at = [point[0] + t * along[0], point[1] + t * along[1]];
    const a = camera.screen(at[0] - far * along[0], at[1] - far * along[1]);
    const b = camera.screen(at[0] + far * along[0], at[1] + far * along[1]);
    to.lineWidth = 2.5;
    to.beginPath();
    to.moveTo(...a);
    to.lineTo(...b);
    to.stroke();
    // hatched on the side where nothing may be
    const sense = camera.up ? -1 : 1;
    const [nx, ny] = [normal[0], sense * normal[1]];
    const [ux, uy] = [(b[0] - a[0]), (b[1] - a[1])];
    const long = Math.hypot(ux, uy);
    const [ex, ey] = [ux / long, uy / long];
    const m = camera.screen(at[0], at[1]);
    to.lineWidth = 1;
    to.beginPath();
    for (let s = -1600; s < 1600; s += 14) {
      const [x, y] = [m[0] + s * ex, m[1] + s * ey];
      if (x < -20 || y < -20 || x > camera.size[0] + 20 || y > camera.size[1] + 20) continue;
      to.moveTo(x, y);
      to.lineTo(x - 9 * nx - 7 * ex, y - 9 * ny - 7 * ey);
    }
    to.stroke();
  }
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {string} color
 */
function gravity(to, app, color) {
  const [gx, gy] = app.scene.gravity;
  const size = Math.hypot(gx, gy);
  const at = /** @type {Pair} */ ([app.camera.size[0] - 44, 44]);
  to.strokeStyle = color;
  to.fillStyle = color;
  to.lineWidth = 2;
  to.beginPath();
  to.arc(at[0], at[1], 30, 0, 7);
  to.globalAlpha = 0.4;
  to.stroke();
  to.globalAlpha = 1;
  const sense = app.camera.up ? -1 : 1;
  if (size > 0) arrow(to, at, [(28 * gx) / size, (sense * 28 * gy) / size]);
  to.font = "11px system-ui";
  to.textAlign = "center";
  to.fillText(size > 0 ? `g ${size.toPrecision(3)}` : "no gravity", at[0], at[1] + 44);
  to.textAlign = "start";
}

/**
 * A spring from one place on the screen to another.
 * @param {CanvasRenderingContext2D} to
 * @param {Pair} a
 * @param {Pair} b
 * @param {string} color
 */
function spring(to, a, b, color) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const long = Math.hypot(dx, dy) || 1;
  const turns = 9;
  to.strokeStyle = color;
  to.lineWidth = 2;
  to.beginPath();
  to.moveTo(...a);
  for (let i = 1; i < 2 * turns; i++) {
    const s = i / (2 * turns);
    const side = (i % 2 ? 5 : -5) / long;
    to.lineTo(a[0] + s * dx - side * dy, a[1] + s * dy + side * dx);
  }
  to.lineTo(...b);
  to.stroke();
  to.beginPath();
  to.arc(b[0], b[1], 5, 0, 7);
  to.stroke();
}

/**
 * Vectors at nodes, the longest of all a fixed length on the screen.
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {ArrayLike<number>} at
 * @param {ArrayLike<number>} v
 * @param {{most: number}} scale
 * @param {string} color
 */
function vectors(to, app, at, v, scale, color) {
  let most = 0;
  for (let i = 0; i < v.length; i += 2) most = Math.max(most, Math.hypot(v[i], v[i + 1]));
  // the scale rises at once and falls slowly, so that arrows do not jump
  scale.most = Math.max(most, 0.995 * scale.most);
  if (!(scale.most > 0)) return;
  const long = 60 / scale.most;
  const sense = app.camera.up ? -1 : 1;
  to.strokeStyle = color;
  to.lineWidth = 1.2;
  for (let i = 0; i < v.length; i += 2) {
    arrow(to, app.camera.screen(at[i], at[i + 1]), [v[i] * long, sense * v[i + 1] * long]);
  }
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 */
function picture(to, app) {
  const { camera, picture, show } = app;
  if (!picture) return;
  const [bad, accent] = ["--bad", "--accent"].map(ofPage);
  for (const { at, radius } of picture.forbidden) {
    const [x, y] = camera.screen(at[0], at[1]);
    to.strokeStyle = bad;
    to.fillStyle = bad;
    to.beginPath();
    to.arc(x, y, radius * camera.scale, 0, 7);
    to.globalAlpha = 0.18;
    to.fill();
    to.globalAlpha = 1;
    to.stroke();
  }
  if (app.details && app.chosen !== null && show.candidates) {
    to.setLineDash([3, 4]);
    to.lineWidth = 1.2;
    to.strokeStyle = "#ffffff";
    for (const curve of app.details.candidates) {
      path(to, app, curve, true);
      to.stroke();
    }
    to.strokeStyle = accent;
    path(to, app, app.details.start, true);
    to.stroke();
    to.setLineDash([]);
  }
  for (const one of picture.outlines) {
    outline(to, app, one, bad);
  }
  if (picture.pull) {
    const held = picture.outlines.find((/** @type {any} */ o) => o.id === picture.pull.id);
    if (held) {
      const a = camera.screen(held.points[2 * picture.pull.node], held.points[2 * picture.pull.node + 1]);
      spring(to, a, camera.screen(picture.pull.to[0], picture.pull.to[1]), accent);
    }
  }
  if (app.preview && app.preview.points.length) {
    to.strokeStyle = "#ffffff";
    to.lineWidth = 3;
    path(to, app, app.preview.points, app.preview.closed);
    to.stroke();
    to.strokeStyle = accent;
    to.lineWidth = 1.6;
    to.setLineDash([6, 4]);
    to.stroke();
    to.setLineDash([]);
    to.fillStyle = accent;
    for (const [x, y] of app.preview.clicks) {
      const [a, b] = camera.screen(x, y);
      to.beginPath();
      to.arc(a, b, 4, 0, 7);
      to.fill();
    }
  }
}

/**
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {any} one
 * @param {string} bad
 */
function outline(to, app, one, bad) {
  const { camera, show } = app;
  const x = one.points;
  const n = x.length / 2;
  const chosen = app.chosen === one.id;
  if (show.bands && one.errors && one.errors.length === n) band(to, app, one);
  path(to, app, x, one.closed);
  to.lineJoin = "round";
  to.strokeStyle = "rgb(255 255 255 / .7)";
  to.lineWidth = chosen ? 5.5 : 4;
  to.stroke();
  if (show.strength && one.strengths && one.strengths.length === n) {
    to.lineWidth = chosen ? 3.2 : 2.2;
    const edges = one.closed ? n : n - 1;
    // a line for each of few colors, not one for each edge: thousands of nodes are drawn in every frame
    const levels = Array.from(one.strengths, (/** @type {number} */ share) => Math.round(LEVELS * Math.min(Math.max(share, 0), 1)));
    for (let level = 0; level <= LEVELS; level++) {
      to.beginPath();
      let any = false;
      let on = false;
      for (let i = 0; i < edges; i++) {
        if (levels[i] !== level) {
          on = false;
          continue;
        }
        const j = (i + 1) % n;
        if (!on) to.moveTo(...camera.screen(x[2 * i], x[2 * i + 1]));
        to.lineTo(...camera.screen(x[2 * j], x[2 * j + 1]));
        any = on = true;
      }
      if (!any) continue;
      to.strokeStyle = ofStrength(level / LEVELS);
      to.stroke();
    }
  } else {
    to.strokeStyle = one.sure ? ofObject(one.id) : bad;
    to.lineWidth = chosen ? 3 : 2;
    if (!one.sure) to.setLineDash([7, 4]);
    to.stroke();
    to.setLineDash([]);
  }
  const spaced = n > 1 ? Math.hypot(x[2] - x[0], x[3] - x[1]) * camera.scale : 0;
  if (show.nodes && spaced > 3) {
    to.fillStyle = ofObject(one.id);
    for (let i = 0; i < n; i++) {
      const [a, b] = camera.screen(x[2 * i], x[2 * i + 1]);
      to.fillRect(a - 2, b - 2, 4, 4);
      if (show.numbers && spaced > 14) {
        to.font = "10px system-ui";
        to.fillText(String(i), a + 4, b - 4);
      }
    }
  }
  for (const pin of one.pins) {
    if (2 * pin >= x.length) continue;
    const [a, b] = camera.screen(x[2 * pin], x[2 * pin + 1]);
    to.fillStyle = bad;
    to.strokeStyle = "#ffffff";
    to.lineWidth = 1;
    to.fillRect(a - 4, b - 4, 8, 8);
    to.strokeRect(a - 4, b - 4, 8, 8);
  }
  if (chosen || app.picture.outlines.length < 40) {
    let top = 0;
    for (let i = 1; i < n; i++) if (x[2 * i + 1] < x[2 * top + 1]) top = i;
    if (n) {
      const [a, b] = camera.screen(x[2 * top], x[2 * top + 1]);
      to.font = "12px system-ui";
      to.lineWidth = 3;
      to.strokeStyle = "rgb(0 0 0 / .6)";
      to.fillStyle = "#ffffff";
      const words = one.sure ? one.label : `${one.label} (unsure)`;
      to.strokeText(words, a + 4, b - 6);
      to.fillText(words, a + 4, b - 6);
    }
  }
}

/**
 * Where the outline lies by 95 of 100: two standard errors to either side, each node along its normal.
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 * @param {any} one
 */
function band(to, app, one) {
  const x = one.points;
  const n = x.length / 2;
  const quad = (/** @type {number} */ i, /** @type {number} */ sense) => {
    const [before, behind] = one.closed ? [(i + n - 1) % n, (i + 1) % n] : [Math.max(i - 1, 0), Math.min(i + 1, n - 1)];
    const [dx, dy] = [x[2 * behind] - x[2 * before], x[2 * behind + 1] - x[2 * before + 1]];
    const long = Math.hypot(dx, dy) || 1;
    const wide = (sense * Math.min(1.96 * Math.max(one.errors[i], 0), WIDEST)) / long;
    return app.camera.screen(x[2 * i] - wide * dy, x[2 * i + 1] + wide * dx);
  };
  to.fillStyle = "#f0e442";
  to.globalAlpha = 0.55;
  const last = one.closed ? n : n - 1;
  for (let first = 0; first < last; ) {
    if (one.errors[first] < 0) {
      first++;
      continue;
    }
    // a stretch of nodes with an error is one area
    let end = first;
    while (end < last && one.errors[(end + 1) % n] >= 0) end++;
    if (end > first) {
      to.beginPath();
      to.moveTo(...quad(first, 1));
      for (let i = first + 1; i <= end; i++) to.lineTo(...quad(i % n, 1));
      for (let i = end; i >= first; i--) to.lineTo(...quad(i % n, -1));
      to.fill();
    }
    first = end + 1;
  }
  to.globalAlpha = 1;
}

/**
 * The pointer that the keyboard moves.
 * @param {CanvasRenderingContext2D} to
 * @param {App} app
 */
function cursor(to, app) {
  if (!app.cursor) return;
  const [x, y] = app.cursor;
  to.strokeStyle = ofPage("--accent");
  to.lineWidth = 2;
  to.beginPath();
  to.arc(x, y, app.pressed ? 5 : 9, 0, 7);
  to.moveTo(x - 14, y);
  to.lineTo(x + 14, y);
  to.moveTo(x, y - 14);
  to.lineTo(x, y + 14);
  to.stroke();
}

/**
 * Remember where centers have been.
 * @param {App} app
 */
export function remember(app) {
  if (!app.scene) return;
  // one has gone back, or begun anew: those ways are not gone
  if (app.scene.t < app.reached) app.trails.clear();
  app.reached = app.scene.t;
  const known = app.scene.snakes.map((/** @type {any} */ one) => one.id);
  for (const id of app.trails.keys()) if (!known.includes(id)) app.trails.delete(id);
  for (const one of app.scene.snakes) {
    const trail = app.trails.get(one.id) || [];
    trail.push(one.center[0], one.center[1]);
    if (trail.length > 2 * TRAIL) trail.splice(0, trail.length - 2 * TRAIL);
    app.trails.set(one.id, trail);
  }
}

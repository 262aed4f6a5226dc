// Scenes with small pictures, files that are opened, files that are saved, help.

import { dialog, make } from "./parts.js";
import { download } from "./plots.js";
import { floats } from "./packet.js";
import { ofObject, ofPage } from "./colors.js";
import { Camera } from "./camera.js";

/** @typedef {import("./main.js").App} App */

/** @param {App} app */
export async function scenes(app) {
  const list = make("div", { className: "scenes" });
  dialog("Scenes of the report, and more", list);
  const { head } = await app.engine.call({ ask: { kind: "menu" } });
  const shown = head.ok.map((/** @type {any} */ one) => {
    const small = make("canvas", { width: 200, height: 150, "aria-hidden": "true" });
    const button = make("button", { "data-scene": one.name }, small, make("span", {}, one.title), make("small", {}, one.report || one.name));
    button.onclick = () => {
      /** @type {HTMLDialogElement} */ (document.getElementById("dialog")).close();
      app.open({ kind: "scene", name: one.name });
    };
    list.append(button);
    return { name: one.name, small };
  });
  const box = /** @type {HTMLDialogElement} */ (document.getElementById("dialog"));
  for (const { name, small } of shown) {
    if (!box.open || !list.isConnected) return;
    try {
      const answer = await app.engine.call({ ask: { kind: "thumb", name } });
      thumb(small, answer);
    } catch {
      // a scene without a drawing is opened all the same
    }
  }
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {import("./packet.js").Packet} answer
 */
function thumb(canvas, answer) {
  const { curves, walls, window, picture, ...rest } = answer.head.ok;
  const camera = new Camera();
  camera.up = rest["y-up"];
  camera.size = [canvas.width, canvas.height];
  const points = curves.map((/** @type {any} */ c) => floats(answer, c.x, 2));
  const xs = points.flatMap((/** @type {Float32Array} */ p) => [...p].filter((_, i) => i % 2 === 0)).concat(walls.map((/** @type {any} */ w) => w.point[0]));
  const ys = points.flatMap((/** @type {Float32Array} */ p) => [...p].filter((_, i) => i % 2 === 1)).concat(walls.map((/** @type {any} */ w) => w.point[1]));
  const around = picture ? [[0, 0], picture] : [[Math.min(...xs), Math.min(...ys)], [Math.max(...xs), Math.max(...ys)]];
  camera.show(window || around);
  if (!window && !picture) camera.scale *= 0.85;
  const to = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  if (picture) {
    to.fillStyle = ofPage("--line");
    const [a, b] = camera.screen(0, 0);
    to.globalAlpha = 0.4;
    to.fillRect(a, b, picture[0] * camera.scale, picture[1] * camera.scale);
    to.globalAlpha = 1;
  }
  to.strokeStyle = ofPage("--soft");
  for (const { point, normal } of walls) {
    const far = 1e3 / camera.scale;
    to.beginPath();
    to.moveTo(...camera.screen(point[0] - far * normal[1], point[1] + far * normal[0]));
    to.lineTo(...camera.screen(point[0] + far * normal[1], point[1] - far * normal[0]));
    to.stroke();
  }
  points.forEach((/** @type {Float32Array} */ x, /** @type {number} */ k) => {
    to.strokeStyle = ofObject(k);
    to.lineWidth = 2;
    to.beginPath();
    for (let i = 0; i < x.length; i += 2) to.lineTo(...camera.screen(x[i], x[i + 1]));
    if (curves[k].closed) to.closePath();
    to.stroke();
  });
}

/** Endings of files of outlines, of scenes, and of sessions. */
const OUTLINES = /\.(csv|tsv|txt|geojson|roi|zip|svg|xml|json)$/i;

/**
 * Open files: a picture, frames, outlines of the picture that is open, a scene, a session.
 * @param {App} app
 * @param {File[]} files
 */
export async function open(app, files) {
  let sorted = [...files].sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
  const scene = sorted.find((file) => /\.toml$/i.test(file.name));
  if (scene) {
    // a scene takes the files that its text names
    const text = await scene.text();
    const named = sorted.filter((file) => file !== scene && text.includes(file.name));
    sorted = sorted.filter((file) => file !== scene && !named.includes(file));
    const rest = new Uint8Array(await new Blob(named).arrayBuffer());
    const beside = named.map((file) => [file.name, file.size]);
    await app.open({ kind: "scene", name: scene.name.replace(/\.toml$/i, ""), text, files: beside }, rest);
  }
  let frame = false;
  for (const file of sorted) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    try {
      const text = /\.json$/i.test(file.name) ? new TextDecoder().decode(bytes.subarray(0, 200)) : "";
      if (text.includes('"snakes-session"')) {
        await app.engine.call({ session: true }, bytes);
        await app.reload();
      } else if (OUTLINES.test(file.name)) {
        await app.act({ kind: "outline", do: "file", name: file.name, search: true }, true, bytes);
      } else {
        await app.open({ kind: "picture", name: file.name, frame }, bytes, frame);
        frame = true;
      }
    } catch (error) {
      app.say(`${file.name}: ${/** @type {Error} */ (error).message}`);
    }
  }
  if (frame) await app.reload();
}

/** @param {App} app */
export async function save(app) {
  const list = make("div", { className: "scenes" });
  dialog("Save", list);
  const { head } = await app.engine.call({ ask: { kind: "formats" } });
  for (const { name, words } of head.ok) {
    const button = make("button", { "data-format": name }, words);
    button.onclick = async () => {
      try {
        const answer = await app.engine.call({ ask: { kind: "export", format: name } });
        download(answer.head.ok.name, new Blob([answer.rest.slice()]));
        app.saved = true;
        app.say(`Saved ${answer.head.ok.name}.`);
        /** @type {HTMLDialogElement} */ (document.getElementById("dialog")).close();
      } catch (error) {
        app.say(/** @type {Error} */ (error).message);
      }
    };
    list.append(button);
  }
}

/** What keys do. */
export const KEYS = [
  ["Space", "run, or stand still"],
  [". and ,", "one step on, one step back (Shift: ten)"],
  ["R", "start again"],
  ["Ctrl+Z, Ctrl+Shift+Z", "take the last change back, make it again"],
  ["letters on the tools", "choose a tool"],
  ["wheel, + and −", "look more closely, or less; 0: all of it; 1: a pixel for a pixel"],
  ["right or middle button, Shift + drag", "move what is seen"],
  ["arrows on the drawing", "move the pointer (Shift: by ten); Enter presses and lets go"],
  ["Enter, double click", "end a curve of clicks; Escape gives it up; Backspace takes the last click back"],
  ["Delete", "delete the chosen outline or snake"],
  ["V, F, C, N", "velocities, force field or forces, centers, nodes"],
  ["PgUp, PgDn, T", "the frame before, the next; track on"],
  ["Ctrl+O, Ctrl+S, Ctrl+V", "open, save, paste a picture"],
  ["?", "this card"],
];

export function help() {
  const list = make("div", { className: "keys" });
  for (const [key, words] of KEYS) list.append(make("kbd", {}, key), make("span", {}, words));
  const first = make("p", {}, "A scene: take a ball by the mouse and throw it. A picture: choose Click and click inside an object; its outline is found. " +
    "Where it is wrong, take it by Mend and pull it to the edge, or point at the wrong edge with Not this edge. Everything can be taken back.");
  dialog("Keys", first, list);
}

// Keys for everything.

import { help, open, save } from "./menu.js";
import { TOOLS } from "./tools.js";

/** @param {import("./main.js").App} app */
export function keys(app) {
  const canvas = app.canvas;
  addEventListener("keydown", (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    const typing = target.matches("input[type=text], input[type=number], select, textarea");
    const inDialog = !!target.closest("dialog");
    const command = event.ctrlKey || event.metaKey;
    if (command) {
      const key = event.key.toLowerCase();
      if (key === "z" && !typing) (event.shiftKey ? app.redo() : app.undo());
      else if (key === "y" && !typing) app.redo();
      else if (key === "s") save(app);
      else if (key === "o") /** @type {HTMLElement} */ (document.getElementById("open-picture")).click();
      else return;
      event.preventDefault();
      return;
    }
    if (typing || inDialog || event.altKey) return;
    const onCanvas = target === canvas || target === document.body;
    if (onCanvas && event.key.startsWith("Arrow")) {
      const by = event.shiftKey ? 10 : 1;
      const [x, y] = app.cursor || [app.camera.size[0] / 2, app.camera.size[1] / 2];
      const way = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [-4, 0], ArrowRight: [4, 0], ArrowUp: [0, -4], ArrowDown: [0, 4] })[event.key];
      app.cursor = [x + by * way[0], y + by * way[1]];
      app.hand.move(app.cursor);
      app.pointed(app.cursor);
      app.redraw();
      event.preventDefault();
      return;
    }
    if (onCanvas && event.key === "Enter") {
      event.preventDefault();
      if (app.hand.clicks.length > 2 && app.tool === "spline" && !app.cursor) app.hand.finish();
      else if (app.cursor && !app.pressed) {
        app.pressed = true;
        app.hand.down(app.cursor);
      } else if (app.cursor) {
        app.pressed = false;
        app.hand.up(app.cursor);
      }
      app.redraw();
      return;
    }
    // a button does what it is for by Space and Enter
    if (target.matches("button, summary, input") && (event.key === " " || event.key === "Enter")) return;
    if (target.matches("input[type=range]") && (event.key.startsWith("Arrow") || event.key.startsWith("Page"))) return;
    const middle = /** @type {[number, number]} */ ([app.camera.size[0] / 2, app.camera.size[1] / 2]);
    const steps = event.shiftKey ? 10 : 1;
    const actions = /** @type {Record<string, () => void>} */ ({
      " ": () => app.toggle(),
      ".": () => app.act({ kind: "step", steps }),
      ":": () => app.act({ kind: "step", steps: 10 }),
      ",": () => app.act({ kind: "back", steps }),
      ";": () => app.act({ kind: "back", steps: 10 }),
      "?": () => help(),
      "+": () => app.zoom(1.25, app.cursor || middle),
      "=": () => app.zoom(1.25, app.cursor || middle),
      "-": () => app.zoom(0.8, app.cursor || middle),
      0: () => app.showAll(),
      1: () => app.zoom(1 / app.camera.scale, app.cursor || middle),
      R: () => app.act({ kind: "reset" }),
      r: () => app.act({ kind: "reset" }),
      V: () => app.setShow("velocities", !app.show.velocities),
      F: () => app.setShow(app.kind === "scene" ? "forces" : "field", !(app.kind === "scene" ? app.show.forces : app.show.field)),
      C: () => app.setShow("center", !app.show.center),
      N: () => app.setShow("nodes", !app.show.nodes),
      T: () => app.track(),
      t: () => app.track(),
      v: () => app.setShow("velocities", !app.show.velocities),
      PageUp: () => app.go(-1),
      PageDown: () => app.go(1),
      Delete: () => app.deleteChosen(),
      Backspace: () => (app.hand.clicks.length ? app.hand.unclick() : app.deleteChosen()),
      Enter: () => app.hand.finish(),
      Escape: () => {
        app.hand.stop();
        app.pressed = false;
        app.cursor = null;
      },
    });
    const own = actions[event.key];
    if (own) {
      own();
      event.preventDefault();
      return;
    }
    const tool = TOOLS[app.kind].find((one) => one.key === event.key);
    if (tool) {
      app.choosetool(tool.name);
      event.preventDefault();
    }
  });
  addEventListener("paste", (event) => {
    const files = [...(event.clipboardData ? event.clipboardData.files : [])];
    if (files.length) open(app, files);
  });
}

// The page: it holds what is shown, and joins its parts.

import { Camera } from "./camera.js";
import { Hand, TOOLS } from "./tools.js";
import { PicturePanel } from "./picture_panel.js";
import { ScenePanel } from "./scene_panel.js";
import { Socket } from "./socket.js";
import { Tiles } from "./tiles.js";
import { Wasm } from "./wasm.js";
import { draw, remember } from "./draw.js";
import { floats } from "./packet.js";
import { help, open, save, scenes } from "./menu.js";
import { keys } from "./keys.js";
import { make } from "./parts.js";
import { short } from "./plots.js";

/** @typedef {[number, number]} Pair */

/**
 * @template {HTMLElement} T
 * @param {string} id
 * @returns {T}
 */
const element = (id) => /** @type {T} */ (document.getElementById(id));

export class App {
  /** @param {import("./socket.js").Engine} engine */
  constructor(engine) {
    this.engine = engine;
    this.canvas = /** @type {HTMLCanvasElement} */ (element("canvas"));
    this.camera = new Camera();
    this.tiles = new Tiles(engine, () => this.redraw());
    this.hand = new Hand(this);
    this.kind = "empty";
    this.tool = "hand";
    /** @type {any} */
    this.about = null;
    /** @type {any} */
    this.scene = null;
    /** @type {any} */
    this.picture = null;
    /** @type {number | null} */
    this.chosen = null;
    /** @type {any} */
    this.details = null;
    /** @type {{points: ArrayLike<number>, closed: boolean, clicks: Pair[]} | null} */
    this.preview = null;
    /** @type {{at: Float32Array, f: Float32Array, most: number} | null} */
    this.arrows = null;
    /** @type {Map<number, number[]>} */
    this.trails = new Map();
    this.scales = { velocity: { most: 0 }, force: { most: 0 } };
    /** @type {Record<string, boolean>} */
    this.show = { trails: true, center: false, velocities: false, forces: false, nodes: false, numbers: false, field: false, energies: true, strength: true, bands: true, candidates: false };
    /** @type {Map<string, HTMLInputElement>} */
    this.checks = new Map();
    /** @type {ScenePanel | null} */
    this.scenes = null;
    /** @type {PicturePanel | null} */
    this.pictures = null;
    /** @type {Pair | null} */
    this.cursor = null;
    this.pressed = false;
    this.playing = false;
    this.revision = -1;
    this.opened = "";
    this.waiting = false;
    this.saved = true;
    /** @type {any} */
    this.latest = null;
    /** @type {any} */
    this.next = null;
    this.busy = false;
    this.saying = false;
    this.scrubbing = false;
    this.panelOf = "";
    this.seen = "";
    this.working = 0;
    /** The time of the scene that was shown last. */
    this.reached = 0;
    this.pointedAt = 0;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.sayer = undefined;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.asker = undefined;
    engine.onframe = (frame) => this.frame(frame);
    engine.onlost = (words) => {
      const box = element("lost");
      box.hidden = words === null;
      box.textContent = words || "";
      if (words === null && this.latest) this.tellShow();
    };
    this.wire();
    keys(this);
    this.tellShow();
  }

  // what is said to the engine

  /**
   * Carry an action out. Of a gesture that goes on, only the newest is sent while another is under way.
   * @param {any} action
   * @param {boolean} [end]
   * @param {Uint8Array} [rest]
   */
  async act(action, end = true, rest) {
    if (!end) {
      this.next = action;
      if (this.busy) return;
      this.busy = true;
      try {
        while (this.next) {
          const now = this.next;
          this.next = null;
          await this.engine.call({ do: now });
        }
      } catch (error) {
        this.say(/** @type {Error} */ (error).message);
      } finally {
        this.busy = false;
      }
      return;
    }
    // the last part of a gesture comes before what ends it
    const last = this.next;
    this.next = null;
    this.saved = false;
    const done = this.works();
    try {
      if (last) await this.engine.call({ do: last });
      await this.engine.call({ do: action }, rest);
    } catch (error) {
      this.say(/** @type {Error} */ (error).message);
    } finally {
      done();
    }
  }

  /** Something is being done: the user is told where it takes long. What is given back ends it. */
  works() {
    const words = "Working …";
    this.working++;
    const timer = setTimeout(() => {
      document.body.classList.add("works");
      element("status").textContent = words;
    }, 400);
    return () => {
      clearTimeout(timer);
      this.working--;
      if (this.working) return;
      document.body.classList.remove("works");
      const status = element("status");
      if (status.textContent === words) status.textContent = "";
    };
  }

  /**
   * Open something.
   * @param {any} action
   * @param {Uint8Array} [rest]
   * @param {boolean} [more] whether it is one more frame
   */
  async open(action, rest, more = false) {
    const done = this.works();
    try {
      await this.engine.call({ do: action }, rest);
    } catch (error) {
      this.say(/** @type {Error} */ (error).message);
      return;
    } finally {
      done();
    }
    if (more) return;
    // what was said of something else
    this.saying = false;
    this.saved = true;
    await this.reload();
    if (action.kind === "scene") this.act({ kind: "play" });
  }

  /** Something else is open. */
  async reload() {
    const { head } = await this.engine.call({ ask: { kind: "about" } });
    this.about = head.ok;
    this.chosen = null;
    this.details = null;
    this.trails.clear();
    this.scales = { velocity: { most: 0 }, force: { most: 0 } };
    this.opened = "";
    this.revision = -1;
  }

  undo() {
    this.act({ kind: "undo" });
  }

  redo() {
    this.act({ kind: "redo" });
  }

  toggle() {
    this.act({ kind: this.playing ? "pause" : "play" });
  }

  track() {
    if (this.kind === "picture") {
      const births = /** @type {HTMLInputElement} */ (element("births")).checked;
      this.act(this.picture.following ? { kind: "frames", do: "stop" } : { kind: "frames", do: "track", births });
    }
  }

  /** @param {number} by */
  go(by) {
    if (this.kind !== "picture" || this.about.frames < 2) return;
    const frame = Math.min(Math.max(this.picture.frame + by, 0), this.about.frames - 1);
    this.act({ kind: "frames", do: "go", frame });
  }

  deleteChosen() {
    if (this.chosen === null) return;
    this.act(this.kind === "scene" ? { kind: "body", do: "delete", snake: this.chosen } : { kind: "outline", do: "delete", id: this.chosen });
  }

  /** @param {number | null} id */
  choose(id) {
    if (this.chosen === id) return;
    this.chosen = id;
    if (this.scenes) this.scenes.refresh();
    if (this.pictures) this.pictures.frame();
    this.redraw();
  }

  /**
   * @param {string} key
   * @param {boolean} on
   */
  setShow(key, on) {
    this.show[key] = on;
    const box = this.checks.get(key);
    if (box) box.checked = on;
    this.tellShow();
    if (key === "field") this.ask();
    this.redraw();
  }

  tellShow() {
    const { velocities, forces, energies } = this.show;
    this.engine.call({ show: { velocities, forces, energies } }).catch(() => {});
  }

  // what comes from the engine

  /** @param {import("./packet.js").Packet} packet */
  frame(packet) {
    this.latest = packet;
    const head = packet.head;
    this.playing = head.playing;
    this.kind = head.kind;
    if (head.kind === "scene") {
      const snakes = head.frame.snakes.map((/** @type {any} */ one) => ({
        ...one,
        points: floats(packet, one.x, 2),
        velocities: one.v && floats(packet, one.v, 2),
        forces: one.forces && one.forces.map((/** @type {any} */ f) => ({ name: f.name, f: floats(packet, f.f, 2) })),
      }));
      this.scene = { ...head.frame, snakes, hasPicture: !!(this.about && this.about.picture) };
      this.picture = null;
      remember(this);
    } else if (head.kind === "picture") {
      const outlines = head.frame.outlines.map((/** @type {any} */ one) => ({
        ...one,
        points: floats(packet, one.x, 2),
        strengths: one.strength && floats(packet, one.strength),
        errors: one.error && floats(packet, one.error),
      }));
      // a new outline is the chosen one
      const known = this.picture ? this.picture.outlines.map((/** @type {any} */ o) => o.id) : [];
      const fresh = outlines.filter((/** @type {any} */ o) => !known.includes(o.id));
      if (fresh.length) this.chosen = fresh[fresh.length - 1].id;
      this.picture = { ...head.frame, outlines };
      this.scene = null;
    }
    const opened = `${head.kind} ${head.opened} ${head.frame && head.frame.version}`;
    if (head.revision !== this.revision || opened !== this.opened) {
      const changed = opened !== this.opened;
      this.revision = head.revision;
      this.opened = opened;
      this.changed(changed);
    }
    this.bar(head);
    if (this.scenes && this.kind === "scene") this.scenes.frame();
    if (this.pictures && this.kind === "picture") this.pictures.frame();
    this.redraw();
  }

  /**
   * Something other than motion has changed.
   * @param {boolean} opened
   */
  async changed(opened) {
    const { head } = await this.engine.call({ ask: { kind: "about" } });
    this.about = head.ok;
    if (!this.about) return;
    const other = this.panelOf !== `${this.kind} ${this.kind === "scene" ? this.about.name : ""}`;
    if (other) {
      this.panelOf = `${this.kind} ${this.kind === "scene" ? this.about.name : ""}`;
      this.checks.clear();
      this.scenes = this.kind === "scene" ? new ScenePanel(this, element("panel")) : null;
      this.pictures = this.kind === "picture" ? new PicturePanel(this, element("panel")) : null;
      this.toolbar();
    }
    const size = this.kind === "scene" ? this.about.picture : this.about.size;
    this.tiles.open(size, this.opened);
    if (this.kind === "scene") this.tiles.tone([0, 255, 1]);
    const seen = JSON.stringify([this.panelOf, this.about.window, this.about.size]);
    const elsewhere = seen !== this.seen;
    this.seen = seen;
    if (elsewhere) this.showAll();
    if (this.pictures && elsewhere) this.pictures.refresh();
    if (this.scenes) this.scenes.refresh();
    element("title").textContent = this.kind === "scene" ? this.about.title : this.about.name;
    if (this.scene) this.scene.hasPicture = !!this.about.picture;
    if (opened) this.ask();
    // what came before it was known what is open
    if (this.latest) this.bar(this.latest.head);
    if (this.pictures && this.kind === "picture") this.pictures.frame();
    this.redraw();
  }

  /** @param {any} head */
  bar(head) {
    const play = element("play");
    play.textContent = head.playing ? "Stop" : "Run";
    play.classList.toggle("on", head.playing);
    play.setAttribute("aria-pressed", String(head.playing));
    /** @type {HTMLButtonElement} */ (element("undo")).disabled = !head.undo;
    /** @type {HTMLButtonElement} */ (element("redo")).disabled = !head.redo;
    for (const id of ["play", "step", "back", "reset"]) {
      /** @type {HTMLButtonElement} */ (element(id)).disabled = head.kind === "empty" || (head.kind === "picture" && id !== "reset" && id !== "play");
    }
    element("speed-label").hidden = head.kind !== "scene";
    const sequence = head.kind === "picture" && this.about && this.about.frames > 1;
    element("sequence").hidden = !sequence;
    if (sequence) {
      const range = /** @type {HTMLInputElement} */ (element("frame"));
      range.max = String(this.about.frames - 1);
      if (document.activeElement !== range || !this.scrubbing) range.value = String(head.frame.frame);
      element("frame-number").textContent = `${head.frame.frame + 1} of ${this.about.frames}${head.frame.facts.includes(head.frame.frame) ? " (by hand)" : ""}`;
      element("track").textContent = head.frame.following ? "Stop" : "Track on";
    }
    let words = "";
    if (head.replaying) words = `Replaying: step ${head.replaying[0]} of ${head.replaying[1]}`;
    else if (head.kind === "scene") {
      words = `t = ${short(head.frame.t)}, step ${head.frame.step}`;
      if (head.frame.end) words = `${head.frame.end.words}. Step back to go on from before.`;
      else if (head.playing && head.reached < 0.9) words += `; this scene is too heavy for the clock: ${head.reached.toFixed(2)} of the speed`;
    } else if (head.kind === "picture") {
      const sure = head.frame.outlines.filter((/** @type {any} */ o) => o.sure).length;
      const all = head.frame.outlines.length;
      words = all ? `${all} outline${all > 1 ? "s" : ""}${sure < all ? `, ${all - sure} unsure` : ""}` : "";
    }
    if (!this.saying) element("status").textContent = words;
    element("status").classList.toggle("bad", !!(head.frame && head.frame.end));
  }

  /**
   * Tell the user something for a while.
   * @param {string} words
   */
  say(words) {
    element("status").textContent = words;
    this.saying = true;
    clearTimeout(this.sayer);
    this.sayer = setTimeout(() => {
      this.saying = false;
      if (this.latest) this.bar(this.latest.head);
    }, 6000);
  }

  /** Ask for the arrows of what is seen. */
  ask() {
    if (!this.show.field || this.kind === "empty") {
      this.arrows = null;
      return;
    }
    clearTimeout(this.asker);
    this.asker = setTimeout(async () => {
      const [from, to] = this.camera.seen();
      const count = Math.max(4, Math.min(60, Math.round(Math.max(...this.camera.size) / 22)));
      try {
        const answer = await this.engine.call({ ask: { kind: "field", from, to, count } });
        const { at, f, most } = answer.head.ok;
        this.arrows = { at: floats(answer, at, 2), f: floats(answer, f, 2), most };
      } catch (error) {
        this.arrows = null;
        this.say(/** @type {Error} */ (error).message);
      }
      this.redraw();
    }, 80);
  }

  /**
   * The pointer is at a place on the screen.
   * @param {Pair} at
   */
  pointed(at) {
    const [x, y] = this.camera.world(...at);
    const digits = Math.max(0, Math.min(4, Math.ceil(Math.log10(this.camera.scale)) + 1));
    let words = `${x.toFixed(digits)}, ${y.toFixed(digits)}`;
    element("place").textContent = words;
    const now = performance.now();
    if (this.kind === "empty" || now - (this.pointedAt || 0) < 90) return;
    if (!(this.kind === "picture" || (this.scene && this.scene.hasPicture))) return;
    this.pointedAt = now;
    this.engine.call({ ask: { kind: "at", at: [x, y] } }).then(({ head }) => {
      if (!head.ok.inside || head.ok.level === null) return;
      words += `  grey ${short(head.ok.level)}`;
      for (const { name, f } of head.ok.forces) if (f) words += `  ${name} (${short(f[0])}, ${short(f[1])})`;
      if (head.ok.counts === false) words += "  (does not count)";
      element("place").textContent = words;
    }).catch(() => {});
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      draw(this);
    });
  }

  // looking

  showAll() {
    this.camera.size = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!this.about) return;
    this.camera.up = this.kind === "scene" && this.about["y-up"];
    if (this.kind === "scene") this.camera.show(this.about.window);
    else this.camera.show([[-0.5, -0.5], [this.about.size[0] - 0.5, this.about.size[1] - 0.5]]);
    this.ask();
    this.redraw();
  }

  /**
   * @param {number} factor
   * @param {Pair} about
   */
  zoom(factor, about) {
    this.camera.zoom(factor, about);
    this.ask();
    this.redraw();
  }

  toolbar() {
    const bar = element("tools");
    const tools = TOOLS[this.kind];
    bar.replaceChildren(...tools.map(({ name, key, words, hint }) => {
      const button = make("button", { title: hint, "data-tool": name }, words, make("kbd", {}, key.toUpperCase()));
      button.onclick = () => this.choosetool(name);
      return button;
    }));
    if (tools.length) this.choosetool(tools[0].name);
  }

  /** @param {string} name */
  choosetool(name) {
    this.tool = name;
    this.hand.stop();
    for (const button of element("tools").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.dataset.tool === name));
    }
    const tool = TOOLS[this.kind].find((one) => one.name === name);
    element("hint").textContent = tool ? tool.hint : "";
    this.canvas.style.cursor = name === "look" ? "grab" : name === "hand" || name === "mend" ? "pointer" : "crosshair";
  }

  wire() {
    const on = (/** @type {string} */ id, /** @type {() => void} */ what) => {
      element(id).onclick = what;
    };
    on("undo", () => this.undo());
    on("redo", () => this.redo());
    on("play", () => this.toggle());
    on("step", () => this.act({ kind: "step", steps: 1 }));
    on("back", () => this.act({ kind: "back", steps: 1 }));
    on("reset", () => this.act({ kind: "reset" }));
    on("help", () => help());
    on("open-scenes", () => scenes(this));
    on("export", () => save(this));
    on("track", () => this.track());
    const file = /** @type {HTMLInputElement} */ (element("file"));
    on("open-picture", () => file.click());
    file.onchange = () => {
      open(this, [...(file.files || [])]);
      file.value = "";
    };
    const speed = /** @type {HTMLInputElement} */ (element("speed"));
    speed.oninput = () => {
      const factor = 2 ** Number(speed.value);
      speed.setAttribute("aria-valuetext", `${factor} times`);
      this.act({ kind: "speed", factor });
      this.say(`${factor >= 1 ? factor : `1/${1 / factor}`} times the usual speed`);
    };
    const frame = /** @type {HTMLInputElement} */ (element("frame"));
    frame.oninput = () => {
      this.scrubbing = true;
      this.act({ kind: "frames", do: "go", frame: Number(frame.value) }, false);
    };
    frame.onchange = () => {
      this.scrubbing = false;
    };
    // a button that was clicked by a mouse does not keep the keys: Space runs
    addEventListener("click", (event) => {
      const button = event.detail > 0 && /** @type {HTMLElement} */ (event.target).closest("button, summary");
      if (button && !button.closest("dialog")) /** @type {HTMLElement} */ (button).blur();
    });
    this.pointers();
    const stage = element("stage");
    const drop = element("drop");
    addEventListener("dragover", (event) => {
      event.preventDefault();
      drop.hidden = false;
    });
    addEventListener("dragleave", (event) => {
      if (!event.relatedTarget) drop.hidden = true;
    });
    addEventListener("drop", (event) => {
      event.preventDefault();
      drop.hidden = true;
      open(this, [...(event.dataTransfer ? event.dataTransfer.files : [])]);
    });
    new ResizeObserver(() => {
      const had = this.camera.size[0] > 1;
      this.camera.size = [this.canvas.clientWidth, this.canvas.clientHeight];
      if (!had) this.showAll();
      this.redraw();
    }).observe(stage);
    matchMedia("(prefers-color-scheme: dark)").onchange = () => this.redraw();
    addEventListener("beforeunload", (event) => {
      // an engine in the page is gone with it
      if (this.engine instanceof Wasm && !this.saved) event.preventDefault();
    });
  }

  pointers() {
    const { canvas } = this;
    /** @type {Map<number, Pair>} */
    const down = new Map();
    let panning = false;
    const at = (/** @type {MouseEvent} */ event) => {
      const box = canvas.getBoundingClientRect();
      return /** @type {Pair} */ ([event.clientX - box.left, event.clientY - box.top]);
    };
    canvas.onpointerdown = (event) => {
      canvas.focus();
      canvas.setPointerCapture(event.pointerId);
      this.cursor = null;
      down.set(event.pointerId, at(event));
      if (down.size === 2) {
        this.hand.stop();
        panning = true;
        return;
      }
      panning = event.button === 1 || event.button === 2 || event.shiftKey || this.tool === "look";
      if (!panning) this.hand.down(at(event));
    };
    canvas.onpointermove = (event) => {
      const now = at(event);
      const before = down.get(event.pointerId);
      this.pointed(now);
      if (before && down.size === 2) {
        const other = [...down.entries()].find(([id]) => id !== event.pointerId);
        if (other) {
          const [ox, oy] = other[1];
          const grown = Math.hypot(now[0] - ox, now[1] - oy) / Math.max(1, Math.hypot(before[0] - ox, before[1] - oy));
          this.camera.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
          this.zoom(grown, [(now[0] + ox) / 2, (now[1] + oy) / 2]);
        }
      } else if (before && panning) {
        this.camera.pan(now[0] - before[0], now[1] - before[1]);
        this.ask();
        this.redraw();
      } else this.hand.move(now);
      if (before) down.set(event.pointerId, now);
    };
    const end = (/** @type {PointerEvent} */ event) => {
      if (!down.delete(event.pointerId)) return;
      if (!panning) this.hand.up(at(event));
      if (!down.size) panning = false;
    };
    canvas.onpointerup = end;
    canvas.onpointercancel = end;
    canvas.ondblclick = () => {
      if (this.tool === "spline") this.hand.finish();
    };
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), at(event));
    }, { passive: false });
  }
}

/** The engine: in the page where it is there, otherwise that of the program which serves it. */
async function engine() {
  const inside = document.getElementById("wasm");
  if (inside) {
    const text = inside.textContent || "";
    const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
    const { unpack } = await import("./unpack.js");
    return Wasm.of(unpack(packed));
  }
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  return new Socket(`${scheme}://${location.host}/socket${location.search}`);
}

const app = new App(await engine());
/** @type {any} */ (window).snakes = app;
const { head } = await app.engine.call({ ask: { kind: "about" } });
if (head.ok === null) scenes(app);

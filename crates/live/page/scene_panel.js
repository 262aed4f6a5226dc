// The panel of a scene: values, damping atlas, energies, deformation.

import { Atlas, Plot, regimeLegend, short } from "./plots.js";
import { Slider, check, make } from "./parts.js";

/** Moments of the plots over time. */
const MOMENTS = 600;

export class ScenePanel {
  /**
   * @param {import("./main.js").App} app
   * @param {HTMLElement} box
   */
  constructor(app, box) {
    this.app = app;
    this.box = box;
    /** @type {Map<string, Slider>} */
    this.sliders = new Map();
    box.replaceChildren();
    this.note = make("p", { className: "words" });
    this.notes = make("details", {}, make("summary", {}, "About this scene"), this.note);
    this.whole = make("select", { "aria-label": "Snake that the values are of" });
    this.whole.onchange = () => {
      app.chosen = this.whole.value === "" ? null : Number(this.whole.value);
      this.refresh();
    };
    this.values = make("div");
    this.scheme = make("select", { "aria-label": "Scheme" });
    this.scheme.onchange = () => app.act({ kind: "body", do: "stepping", scheme: this.scheme.value });
    this.limit = make("p", { className: "words" });
    box.append(make("h2", {}, "Values"), make("label", {}, "Of ", this.whole), this.values,
      make("label", { className: "row" }, "Scheme ", this.scheme), this.limit);
    this.contact = check(box, "Curves push each other", false, (on) => app.act({ kind: "body", do: "contact", on }));
    const shown = make("div", { className: "row" });
    box.append(make("h2", {}, "Show"), shown);
    for (const [key, words] of Object.entries({ trails: "trails", center: "centers", velocities: "velocities", forces: "forces", nodes: "nodes", numbers: "numbers", field: "field" })) {
      app.checks.set(key, check(shown, words, app.show[key], (on) => app.setShow(key, on)));
    }
    const about = make("details", { open: true }, make("summary", {}, "Damping atlas: mass and damping of this snake"));
    box.append(about);
    this.regime = make("p", { className: "words" });
    this.atlas = new Atlas(about, (mass, damping, end) => this.move(mass, damping, end));
    this.legend = make("p", { className: "words" });
    about.append(this.regime, this.legend);
    this.spring = new Plot(about, "The spring of section 3.4.2 in this regime");
    const energy = make("details", { open: true }, make("summary", {}, "Energies, stacked"));
    box.append(energy);
    this.energy = new Plot(energy, "Energies");
    energy.ontoggle = () => app.setShow("energies", energy.open);
    const shape = make("details", { open: true }, make("summary", {}, "Deformation, area, modes"));
    box.append(shape);
    this.deformation = new Plot(shape, "Deformation and area over time");
    this.spectrum = new Plot(shape, "Size of each mode");
    this.details = { about, energy, shape };
    box.append(this.notes);
    /** @type {{t: number[], energies: number[][], rms: number[], area: number[]}} */
    this.past = { t: [], energies: [], rms: [], area: [] };
    this.asked = 0;
    this.pending = false;
  }

  /** What was opened or changed. */
  async refresh() {
    const { app } = this;
    const about = app.about;
    if (!about || app.kind !== "scene") return;
    this.note.textContent = [about.title, about.report, about.note, ...about.notes].filter(Boolean).join("\n\n");
    try {
      const values = (await app.engine.call({ ask: { kind: "values", snake: app.chosen } })).head.ok;
      this.list(values);
    } catch {
      if (app.chosen !== null) {
        app.chosen = null;
        this.refresh();
      }
      return;
    }
    this.plane();
  }

  /** @param {any} values */
  list(values) {
    const { app } = this;
    const snakes = app.scene ? app.scene.snakes : [];
    if (this.whole.options.length !== snakes.length + 1) {
      this.whole.replaceChildren(make("option", { value: "" }, "all snakes"),
        ...snakes.map((/** @type {any} */ one) => make("option", { value: String(one.id) }, `snake ${one.id}`)));
    }
    this.whole.value = app.chosen === null ? "" : String(app.chosen);
    for (const { key, symbol, unit, value, varies } of values.parameters) {
      const known = this.sliders.get(key);
      if (known) known.show(value);
      else {
        const label = `${symbol} ${key}${varies ? " (mean)" : ""}`;
        this.sliders.set(key, new Slider(this.values, {
          label, unit, value,
          set: (v, end) => app.act({ kind: "body", do: "set", key, value: v, snake: app.chosen }, end),
        }));
      }
    }
    const dt = this.sliders.get("dt");
    if (dt) dt.show(values.dt);
    else {
      this.sliders.set("dt", new Slider(this.values, {
        label: "Δt step", unit: "T", value: values.dt,
        set: (v, end) => v > 0 && app.act({ kind: "body", do: "stepping", dt: v }, end),
      }));
    }
    if (!this.scheme.options.length) {
      for (const { name, summary, order } of values.schemes) {
        this.scheme.append(make("option", { value: name, title: summary }, `${name} (order ${order})`));
      }
    }
    this.scheme.value = values.scheme;
    const limit = values["dt-limit"];
    const beyond = limit !== null && values.dt > limit;
    this.limit.textContent = limit === null
      ? "Stable with any step."
      : `Stable up to Δt = ${short(limit)} (${values["limited-by"]}).${beyond ? " This step is beyond it: it will blow up." : ""}`;
    this.limit.classList.toggle("bad", beyond);
    const slider = this.sliders.get("dt");
    if (slider) slider.field.classList.toggle("bad", beyond);
    this.contact.checked = values.contact;
  }

  async plane() {
    if (!this.details.about.open) return;
    try {
      const data = (await this.app.engine.call({ ask: { kind: "atlas", snake: this.app.chosen } })).head.ok;
      if (this.atlas.dragging) return;
      this.atlas.draw(data);
      this.regime.textContent = `Now: ${data.is}. The slowest mode is critical at γ = ${short(data.critical)}.`;
      this.legend.innerHTML = regimeLegend(data.regimes);
      const { time, places, words, ratio } = data.spring;
      const x = places.map((/** @type {number} */ _, /** @type {number} */ i) => (time * i) / (places.length - 1));
      this.spring.lines([{ name: `${words}, ratio ${short(ratio)}`, x, y: places }], "t");
    } catch (error) {
      this.regime.textContent = /** @type {Error} */ (error).message;
    }
  }

  /**
   * @param {number} mass
   * @param {number} damping
   * @param {boolean} end
   */
  async move(mass, damping, end) {
    const { app } = this;
    const round = (/** @type {number} */ v) => Number(v.toPrecision(3));
    await app.act({ kind: "body", do: "plane", mass: round(mass), damping: round(damping), snake: app.chosen }, end);
  }

  /** Begin the plots over time anew. */
  clear() {
    this.past = { t: [], energies: [], rms: [], area: [] };
  }

  /** A frame has come. */
  frame() {
    const { app, past } = this;
    const scene = app.scene;
    const now = performance.now();
    if (!scene || now - this.asked < 120 || this.pending) return;
    this.asked = now;
    const last = past.t[past.t.length - 1];
    if (last !== undefined && scene.t < last) {
      // one has gone back
      const keep = past.t.filter((t) => t < scene.t).length;
      past.t.length = past.energies.length = past.rms.length = past.area.length = keep;
    }
    if (last === scene.t && past.t.length) return;
    this.pending = true;
    app.engine.call({ ask: { kind: "shape", snake: app.chosen } }).then((answer) => {
      const shape = answer.head.ok;
      past.t.push(scene.t);
      past.energies.push(scene.energies || []);
      past.rms.push(shape.rms);
      past.area.push(shape.area ?? shape.length);
      if (past.t.length > MOMENTS) {
        // every second moment, so that all of the run is seen at constant memory
        for (const list of Object.values(past)) list.splice(0, list.length, .../** @type {any[]} */ (list).filter((_, i) => i % 2 === 0));
      }
      if (this.details.energy.open && past.energies.every((row) => row.length === app.about.energies.length)) {
        this.energy.stacked(app.about.energies, past.t, past.energies, "t");
      }
      if (this.details.shape.open) {
        const area0 = shape["area-at-rest"] ?? shape["length-at-rest"];
        this.deformation.lines([
          { name: "deformation (rms)", x: past.t, y: past.rms },
          { name: shape.area === null ? "length (rms scale)" : "area / at rest", x: past.t, y: past.area.map((a) => a / area0) },
        ], "t");
        this.spectrum.bars(shape.modes, "mode");
      }
    }).catch(() => {}).finally(() => {
      this.pending = false;
    });
  }
}

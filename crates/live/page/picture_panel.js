// The panel of a picture: outlines, what is known of the chosen one, tones.

import { Plot, short } from "./plots.js";
import { check, make } from "./parts.js";
import { ofObject, ofStrength } from "./colors.js";
import { floats } from "./packet.js";

const POINT = "Point at a node: grey along its normal, inside to the left, and the edge it holds to at 0.";

export class PicturePanel {
  /**
   * @param {import("./main.js").App} app
   * @param {HTMLElement} box
   */
  constructor(app, box) {
    this.app = app;
    box.replaceChildren();
    this.rows = make("tbody");
    const head = make("tr", {}, ...["", "Name", "Class", "Area / px²", "± px", ""].map((words) => make("th", {}, words)));
    this.none = make("p", { className: "words" }, "No outline yet. Choose Click and click inside an object, or draw around one; Find all looks for every object.");
    const all = make("button", { textContent: "Find all", title: "Find every object of the picture; outlines that are there stay" });
    all.onclick = () => app.act({ kind: "outline", do: "all" });
    box.append(make("h2", {}, "Outlines"), this.none, make("div", { className: "row" }, all), make("table", {}, make("thead", {}, head), this.rows));
    this.words = make("p", { className: "words" });
    this.more = make("pre", { className: "words", style: "white-space: pre-wrap; font-size: 12px" });
    const known = make("details", { open: true }, make("summary", {}, "The chosen outline: where it ended, and why"), this.words,
      make("details", {}, make("summary", {}, "What was measured and chosen"), this.more));
    box.append(known);
    const buttons = make("div", { className: "row" });
    for (const [words, change, title] of [
      ["Search again", "again", "Find the edge once more about this outline; pinned nodes stay"],
      ["Let all go", "thaw", "Let go of all pinned nodes"],
      ["Delete", "delete", "Take this outline away (Delete)"],
    ]) {
      const button = make("button", { textContent: words, title });
      button.onclick = () => app.chosen !== null && app.act({ kind: "outline", do: change, id: app.chosen });
      buttons.append(button);
    }
    const part = make("button", { textContent: "Common borders", title: "Give outlines that overlap a border in common" });
    part.onclick = () => app.act({ kind: "outline", do: "part" });
    buttons.append(part);
    known.append(buttons);
    this.profile = new Plot(box, "Grey along the normal");
    this.under = make("p", { className: "words" }, POINT);
    box.append(this.under);
    const shown = make("div", { className: "row" });
    box.append(make("h2", {}, "Show"), shown);
    for (const [key, words] of Object.entries({ strength: "edge strength", bands: "error bands", candidates: "what else was found", nodes: "nodes", numbers: "numbers", field: "force field" })) {
      app.checks.set(key, check(shown, words, app.show[key], (on) => app.setShow(key, on)));
    }
    this.key = make("p", { className: "words" });
    this.key.innerHTML = `Edge strength: <span style="display:inline-block;width:120px;height:9px;vertical-align:middle;background:linear-gradient(90deg,${[0, 0.25, 0.5, 0.75, 1].map(ofStrength).join(",")})"></span> none to strong. Band: 95 of 100.`;
    box.append(this.key);
    const tones = make("details", { open: true }, make("summary", {}, "Tones"));
    box.append(tones);
    /** @type {HTMLInputElement[]} */
    this.tones = [];
    for (const [words, min, max, step] of [["Black at", 0, 255, 0.5], ["White at", 0, 255, 0.5], ["Gamma", 0.2, 4, 0.05]]) {
      const range = make("input", { type: "range", min: String(min), max: String(max), step: String(step), "aria-label": String(words) });
      range.oninput = () => {
        const [low, high, gamma] = this.tones.map((t) => Number(t.value));
        app.tiles.tone([low, Math.max(high, low + 0.5), gamma]);
      };
      this.tones.push(range);
      tones.append(make("div", { className: "slider" }, make("label", {}, String(words)), range, make("span")));
    }
    this.events = make("p", { className: "words" });
    box.append(this.events);
    this.profiled = false;
    this.listed = "";
    this.known = "";
    this.asked = 0;
  }

  refresh() {
    const about = this.app.about;
    if (!about) return;
    const [low, high, gamma] = about.tones;
    const span = high - low;
    this.tones.forEach((range, i) => {
      if (i < 2) {
        range.min = String(Math.min(0, low - span));
        range.max = String(Math.max(255, high + span));
        range.step = String(Math.max(span / 500, 1e-6));
      }
      range.value = String([low, high, gamma][i]);
    });
    this.app.tiles.tone([low, high, gamma]);
  }

  frame() {
    const { app } = this;
    const picture = app.picture;
    if (!picture) return;
    const list = JSON.stringify([app.chosen, picture.outlines.map((/** @type {any} */ o) => [o.id, o.label, o.class, o.sure, o.words, Math.round(o.area || 0), o["mean-error"]])]);
    if (list !== this.listed && !(document.activeElement && this.rows.contains(document.activeElement))) {
      this.listed = list;
      this.none.hidden = picture.outlines.length > 0;
      this.rows.replaceChildren(...picture.outlines.slice(0, 400).map((/** @type {any} */ one) => this.row(one)));
    }
    // a row that is typed in stays as it is
    for (const row of this.rows.rows) row.setAttribute("aria-selected", String(Number(row.dataset.outline) === app.chosen));
    const chosen = picture.outlines.find((/** @type {any} */ o) => o.id === app.chosen);
    if (!picture.outlines.length && this.profiled) {
      this.profiled = false;
      this.profile.clear();
      this.under.textContent = POINT;
    }
    this.words.textContent = chosen ? `${chosen.label}: ${chosen.words}.${chosen["mean-error"] === null ? "" : ` Standard error ${chosen["mean-error"].toFixed(2)} px in the mean.`}` : "";
    const known = chosen ? `${chosen.id} ${chosen.words} ${chosen.points.length} ${app.revision}` : "";
    if (known !== this.known) {
      this.known = known;
      this.explain(chosen);
    }
    this.events.textContent = picture.events ? picture.events.join("\n") : "";
  }

  /** @param {any} one */
  row(one) {
    const { app } = this;
    const name = make("input", { type: "text", value: one.label, "aria-label": `Name of outline ${one.id}` });
    const kind = make("input", { type: "text", value: one.class, "aria-label": `Class of outline ${one.id}` });
    const tell = () => app.act({ kind: "outline", do: "name", id: one.id, label: name.value, class: kind.value });
    name.onchange = tell;
    kind.onchange = tell;
    const gone = make("button", { textContent: "×", title: `Delete ${one.label}`, "aria-label": `Delete ${one.label}` });
    gone.onclick = (event) => {
      event.stopPropagation();
      app.act({ kind: "outline", do: "delete", id: one.id });
    };
    const chip = make("span", { className: "chip", style: `background:${one.sure ? ofObject(one.id) : "var(--bad)"}`, title: one.sure ? "sure" : "unsure" });
    const row = make("tr", { "aria-selected": String(one.id === app.chosen), "data-outline": String(one.id) },
      make("td", {}, chip), make("td", {}, name), make("td", {}, kind),
      make("td", {}, one.area === null ? "open" : one.area.toFixed(0)),
      make("td", {}, one["mean-error"] === null ? "–" : short(one["mean-error"])), make("td", {}, gone));
    row.onclick = () => app.choose(one.id);
    return row;
  }

  /** @param {any} one */
  async explain(one) {
    const { app } = this;
    app.details = null;
    this.more.textContent = "";
    if (!one) return;
    try {
      const answer = await app.engine.call({ ask: { kind: "outline", id: one.id } });
      const known = answer.head.ok;
      this.more.textContent = known.explained;
      app.details = {
        start: floats(answer, known.start, 2),
        candidates: known.candidates.map((/** @type {[number, number]} */ at) => floats(answer, at, 2)),
      };
      app.redraw();
    } catch {
      // it was deleted meanwhile
    }
  }

  /**
   * The pointer is at a node.
   * @param {number} id
   * @param {number} node
   */
  async over(id, node) {
    const now = performance.now();
    if (now - this.asked < 60) return;
    this.asked = now;
    try {
      const known = (await this.app.engine.call({ ask: { kind: "profile", id, node } })).head.ok;
      this.profile.lines([{ name: `node ${node}`, x: known.ways, y: known.levels }], "pixels outwards");
      this.profiled = true;
      const error = known.error === null ? "not measured" : `${known.error.toFixed(3)} px`;
      this.under.textContent = `Outline ${id}, node ${node}: edge ${known.strength === null ? "–" : known.strength.toFixed(2)}, standard error ${error}.`;
    } catch {
      // there is no such node any more
    }
  }
}
